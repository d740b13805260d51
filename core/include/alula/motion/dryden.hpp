#pragma once
// Continuous turbulence of Dryden's form: MIL-F-8785C, 1980, sections 3.7.1.2, 3.7.2 and 3.7.3.
#include <array>
#include <cmath>

#include "alula/math/limit.hpp"
#include "alula/math/quaternion.hpp"
#include "alula/math/vec3.hpp"

namespace alula {

template <class T>
struct Dryden {
  T span{1};   // m, of the aircraft
  T W20{0};    // m/s, wind 20 ft above the ground: turbulence below 1000 ft
  T sigma{0};  // m/s, turbulence above 2000 ft
};

// Standard normal numbers for each step, and as many to start with.
inline constexpr int kDrydenNormals = 8;
inline constexpr int kDrydenStates = 8;

// States of the forming filters, without unit: u | v v r | w w q | p.
template <class T>
using DrydenState = std::array<T, kDrydenStates>;

// Velocity and rotation of the air, as the equations of motion take them: toward plus.
template <class T>
struct Turbulence {
  Vec3<T> velocity{};  // m/s
  Vec3<T> rates{};     // rad/s
};

// Lengths (m) and standard deviations (m/s) at a height above ground (m), not below 10 ft. Those of
// v are those of u.
template <class T>
struct DrydenScale {
  T length_u, length_w, sigma_u, sigma_w;
};

inline constexpr double kFoot = 0.3048;

template <class T>
DrydenScale<T> dryden_scale(const Dryden<T>& d, T height) {
  const T h = limited(T(height / T(kFoot)), T(10), T(2000));  // ft
  const T low = h < T(1000) ? h : T(1000);
  const T k = T(0.177) + T(0.000823) * low, sigma = T(0.1) * d.W20;
  const DrydenScale<T> below{T(kFoot) * low / std::pow(k, T(1.2)), T(kFoot) * low,
                             sigma / std::pow(k, T(0.4)), sigma};
  if (!(h > T(1000))) return below;
  const T part = (h - T(1000)) / T(1000), above = T(1750 * kFoot);
  const auto between = [part](T a, T b) { return a + part * (b - a); };
  return {between(below.length_u, above), between(below.length_w, above),
          between(below.sigma_u, d.sigma), between(below.sigma_w, d.sigma)};
}

// The filters for one airspeed, height and step: x <- transition x + drive (normal numbers).
template <class T>
struct DrydenFilter {
  using Matrix = std::array<std::array<T, 3>, 3>;  // lower triangular
  T V{0}, height{0}, dt{0};
  T decay_u{0}, drive_u{0}, decay_p{0}, drive_p{0};
  Matrix transition_v{}, drive_v{}, transition_w{}, drive_w{};
  T sigma_u{0}, sigma_w{0}, sigma_p{0};  // m/s, rad/s
  T rate_q{0}, rate_r{0};                // rad/s for each sigma of velocity
};

namespace detail {

template <class T>
using Square = std::array<std::array<T, 3>, 3>;

// a b', or a b; all 3 x 3.
template <bool Transposed, class T>
constexpr Square<T> product(const Square<T>& a, const Square<T>& b) {
  Square<T> c{};
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned j = 0; j < 3; ++j)
      for (unsigned k = 0; k < 3; ++k) c[i][j] += a[i][k] * (Transposed ? b[j][k] : b[k][j]);
  return c;
}

// Transition and a root of the covariance, over dt, of the three states behind one white noise:
// two of the transverse velocity with break frequency a, one of the rate with break frequency c.
//   x1' = -a x1 + sqrt(2 a) n,  x2' = a (x1 - x2),  velocity/sigma = (sqrt3 x1 + (1 - sqrt3) x2)/
//   sqrt2,  x3' = c (velocity/sigma - x3),  rate = c/V (velocity - sigma x3)
// Exact for any dt: series over a short part of it, then doubled.
template <class T>
void transverse_filter(T a, T c, T dt, Square<T>& transition, Square<T>& drive) {
  const T root2 = std::sqrt(T(2)), root3 = std::sqrt(T(3));
  T part = dt;
  int doublings = 0;
  for (const T most = a > c ? a : c; part * most > T(0.0625) && doublings < 60; ++doublings)
    part *= T(0.5);
  const T s = a * part, z = c * part;
  const Square<T> A{
      {{-s, T(0), T(0)}, {s, -s, T(0)}, {z * root3 / root2, z * (T(1) - root3) / root2, -z}}};
  Square<T> power{{{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}}}, rate{};
  rate[0][0] = T(2) * s;
  transition = power;
  Square<T> Q = rate;
  for (int k = 1; k <= 12; ++k) {
    // A^k / k!; the k-th derivative of the covariance over (k + 1)!
    const Square<T> next = product<false>(A, power), turned = product<false>(A, rate);
    for (unsigned i = 0; i < 3; ++i)
      for (unsigned j = 0; j < 3; ++j) {
        power[i][j] = next[i][j] / T(k);
        rate[i][j] = (turned[i][j] + turned[j][i]) / T(k + 1);
        transition[i][j] += power[i][j];
        Q[i][j] += rate[i][j];
      }
  }
  for (; doublings > 0; --doublings) {
    const Square<T> moved = product<true>(product<false>(transition, Q), transition);
    for (unsigned i = 0; i < 3; ++i)
      for (unsigned j = 0; j < 3; ++j) Q[i][j] += moved[i][j];
    transition = product<false>(transition, transition);
  }
  drive = {};
  for (unsigned j = 0; j < 3; ++j) {
    T pivot = Q[j][j];
    for (unsigned k = 0; k < j; ++k) pivot -= drive[j][k] * drive[j][k];
    if (!(pivot > T(0))) continue;  // rounding only: over a very short step the states are as one
    drive[j][j] = std::sqrt(pivot);
    for (unsigned i = j + 1; i < 3; ++i) {
      T sum = Q[i][j];
      for (unsigned k = 0; k < j; ++k) sum -= drive[i][k] * drive[j][k];
      drive[i][j] = sum / drive[j][j];
    }
  }
}

}  // namespace detail

// V: airspeed, m/s, taken as at least 1; height above ground, m; dt: s. About 3 us.
template <class T>
DrydenFilter<T> dryden_filter(const Dryden<T>& d, T V, T height, T dt) {
  const T pi(3.14159265358979324), b = d.span;
  const auto scale = dryden_scale(d, height);
  DrydenFilter<T> f;
  f.V = V;
  f.height = height;
  f.dt = dt;
  const T speed = V > T(1) ? V : T(1);
  const auto first_order = [dt](T rate, T& decay, T& drive) {
    decay = std::exp(-rate * dt);
    drive = std::sqrt(-std::expm1(T(-2) * rate * dt));
  };
  first_order(speed / scale.length_u, f.decay_u, f.drive_u);
  const T c_q = pi * speed / (T(4) * b), c_r = pi * speed / (T(3) * b);
  first_order(c_q, f.decay_p, f.drive_p);
  detail::transverse_filter(speed / scale.length_u, c_r, dt, f.transition_v, f.drive_v);
  detail::transverse_filter(speed / scale.length_w, c_q, dt, f.transition_w, f.drive_w);
  f.sigma_u = scale.sigma_u;
  f.sigma_w = scale.sigma_w;
  // Integral of the specification's spectrum of p: 0.8 (pi L/(4 b))^(1/3) sigma^2/L times pi^2/(8
  // b)
  f.sigma_p = scale.sigma_w * std::sqrt(T(0.1) * pi * pi / (scale.length_w * b) *
                                        std::cbrt(pi * scale.length_w / (T(4) * b)));
  f.rate_q = pi / (T(4) * b);
  f.rate_r = pi / (T(3) * b);
  return f;
}

// Brings the filter up to date where V or height have changed by more than half a percent (or dt
// at all); the spectra then stay within that of the true ones, at little cost for each step.
template <class T>
void dryden_refresh(const Dryden<T>& d, T V, T height, T dt, DrydenFilter<T>& f) {
  const T part(0.005);
  const bool same = std::abs(V - f.V) <= part * std::abs(f.V) &&
                    std::abs(height - f.height) <= part * std::abs(f.height) && dt == f.dt;
  if (!same) f = dryden_filter(d, V, height, dt);
}

namespace detail {

template <class T>
void step_three(const Square<T>& transition, const Square<T>& drive, const T* normal, T* x) {
  T next[3];
  for (unsigned i = 0; i < 3; ++i) {
    next[i] = T(0);
    for (unsigned j = 0; j <= i; ++j) next[i] += transition[i][j] * x[j] + drive[i][j] * normal[j];
  }
  for (unsigned i = 0; i < 3; ++i) x[i] = next[i];
}

}  // namespace detail

// Advances the state by the filter's step with kDrydenNormals standard normal numbers.
template <class T>
void dryden_step(const DrydenFilter<T>& f, const T* normals, DrydenState<T>& x) {
  x[0] = f.decay_u * x[0] + f.drive_u * normals[0];
  detail::step_three(f.transition_v, f.drive_v, normals + 1, &x[1]);
  detail::step_three(f.transition_w, f.drive_w, normals + 4, &x[4]);
  x[7] = f.decay_p * x[7] + f.drive_p * normals[7];
}

// A state as after a long time: one step so long that nothing is left of what was before.
template <class T>
DrydenState<T> dryden_start(const Dryden<T>& d, T V, T height, const T* normals) {
  const auto scale = dryden_scale(d, height);
  const T longest = scale.length_u > scale.length_w ? scale.length_u : scale.length_w;
  const T through = (longest > d.span ? longest : d.span) / (V > T(1) ? V : T(1));
  DrydenState<T> x{};
  dryden_step(dryden_filter(d, V, height, T(60) * through), normals, x);
  return x;
}

// What the states mean. The aircraft flies through a field at rest, so d/dx is d/dt over V, and air
// that turns at (p, q, r) has dw/dy = p, dw/dx = -q, dv/dx = r: hence the signs of q and r.
template <class T>
Turbulence<T> turbulence(const DrydenFilter<T>& f, const DrydenState<T>& x) {
  const T k = std::sqrt(T(0.5)), root3 = std::sqrt(T(3));
  const T v = k * (root3 * x[1] + (T(1) - root3) * x[2]);
  const T w = k * (root3 * x[4] + (T(1) - root3) * x[5]);
  return {
      {f.sigma_u * x[0], f.sigma_u * v, f.sigma_w * w},
      {f.sigma_p * x[7], -f.sigma_w * f.rate_q * (w - x[6]), f.sigma_u * f.rate_r * (v - x[3])}};
}

// In body axes. The specification gives it in body axes above 2000 ft; below 1000 ft x lies along
// the horizontal air velocity and z down; between, what both give is mixed linearly. v_air: body
// axes, m/s; height above ground, m. Without horizontal airspeed body axes are kept.
template <class T>
Turbulence<T> turbulence_in_body(const Turbulence<T>& gust, const Mat3<T>& R_BE,
                                 const Vec3<T>& v_air, T height) {
  const T body = limited(T(height / T(1000 * kFoot) - T(1)), T(0), T(1));
  if (body == T(1)) return gust;
  const Vec3<T> v = transposed_times(R_BE, v_air);
  const T along = std::sqrt(v.x * v.x + v.y * v.y);
  if (!(along > T(0))) return gust;
  const T c = v.x / along, s = v.y / along;
  const auto turned = [&](const Vec3<T>& g) {
    const Vec3<T> low = R_BE * Vec3<T>{c * g.x - s * g.y, s * g.x + c * g.y, g.z};
    return body * g + (T(1) - body) * low;
  };
  return {turned(gust.velocity), turned(gust.rates)};
}

}  // namespace alula
