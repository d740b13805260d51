#pragma once
// The zero-order scheme as printed: n + 1 equations (20) with (17), (18) at uneven times before or
// after t, solved for alpha and beta by Levenberg-Marquardt; its error measure, Eq. (25).
#include "alula/airdata/asse.hpp"
#include "alula/math/bounded.hpp"

namespace alula {

inline constexpr int kMaxZeroOrder = 4;  // equations; the first is that of t itself

// What is known at one of the times tau.
template <class T>
struct ZeroOrderSample {
  T lag;           // s, t - tau; negative: after t
  T V, V_dot;      // airspeed, m/s, and its derivative
  Vec3<T> a;       // air_acceleration, m/s2
  Vec3<T> gained;  // integral of it from tau to t, m/s
  Vec3<T> w;       // rates, rad/s
};

template <class T>
struct ZeroOrderSettings {
  T threshold{T(200)};        // existence number below which an angle is not observable, 1/rad
  T equation_error{T(0.05)};  // m/s2: what n over V is uncertain by, besides the zero order
  T longest_step{T(0.2)};     // rad
  T longest_gap{T(0.25)};     // s, over which the last solution is carried
  T least_apart{T(0.02)};     // rad, half the distance of two roots that are told apart
  T farthest{T(0.2)};         // rad from what is carried: the other root
  int iterations = 30;
};

template <class T>
struct ZeroOrderSolution {
  T alpha{}, beta{};
  // Existence number: how far the equations change per rad of one angle, the other one free to
  // follow, over what they are wrong by; zero in trim and where equations are dependent. Its
  // inverse is the error to expect of the angle, rad.
  T existence_alpha{}, existence_beta{};
  T residual{};  // rms of the equations over V, m/s2
  int iterations = 0;
  bool converged = false;
};

namespace zero_order_detail {

template <class T>
struct Equations {
  Bounded<Vec3<T>, kMaxZeroOrder> m;  // Eq. (18) over V
  Bounded<T, kMaxZeroOrder> n;        // Eq. (17) over V
};

template <class T>
inline T cost(const Equations<T>& e, T alpha, T beta) {
  const auto d = flow_basis(alpha, beta).along;
  T sum = T(0);
  for (int i = 0; i < e.m.size(); ++i) {
    const T r = e.n[i] - dot(e.m[i], d);
    sum += r * r;
  }
  return sum;
}

// One damped step by orthogonal rows: the equations of neighboring times differ by little, and the
// product J'J would lose what little that is. Also the lengths of the columns of J that the other
// column does not reach.
template <class T>
struct Step {
  T alpha, beta, free_alpha, free_beta;
};

template <class T>
inline Step<T> step(const Equations<T>& e, T alpha, T beta, T damping) {
  constexpr int rows = kMaxZeroOrder + 2;
  const auto b = flow_basis(alpha, beta);
  T A[rows]{}, B[rows]{}, r[rows]{};
  const int k = e.m.size();
  for (int i = 0; i < k; ++i) {
    A[i] = b.cos_beta * dot(e.m[i], b.by_alpha);
    B[i] = dot(e.m[i], b.by_beta);
    r[i] = e.n[i] - dot(e.m[i], b.along);
  }
  Step<T> out{};
  const auto inner = [](const T* x, const T* y, int count) {
    T s = T(0);
    for (int i = 0; i < count; ++i) s += x[i] * y[i];
    return s;
  };
  const auto free_of = [&](const T* x, const T* y) {  // length of x without its part along y
    const T yy = inner(y, y, k), f = yy > T(0) ? inner(x, y, k) / yy : T(0);
    T s = T(0);
    for (int i = 0; i < k; ++i) s += (x[i] - f * y[i]) * (x[i] - f * y[i]);
    return std::sqrt(s);
  };
  out.free_alpha = free_of(A, B);
  out.free_beta = free_of(B, A);
  A[k] = damping;
  B[k + 1] = damping;
  const int all = k + 2;
  const T aa = inner(A, A, all);
  if (!(aa > T(0))) return out;
  const T f = inner(A, B, all) / aa, g = inner(A, r, all) / aa;
  for (int i = 0; i < all; ++i) {
    B[i] -= f * A[i];
    r[i] -= g * A[i];
  }
  const T bb = inner(B, B, all);
  out.beta = bb > T(0) ? inner(B, r, all) / bb : T(0);
  out.alpha = g - f * out.beta;
  return out;
}

}  // namespace zero_order_detail

// Solves the equations of `count` samples (2 to 4), the first that of t itself (lag and gained
// zero), from alpha and beta. Not converged and existence zero where an input is not finite or the
// airspeed is not above zero.
template <class T>
inline ZeroOrderSolution<T> zero_order(const ZeroOrderSample<T>* samples, int count, T alpha,
                                       T beta, const ZeroOrderSettings<T>& settings = {}) {
  using namespace zero_order_detail;
  ZeroOrderSolution<T> out;
  out.alpha = alpha;
  out.beta = beta;
  if (count < 2 || count > kMaxZeroOrder || !(samples[0].V > T(0))) return out;
  if (!std::isfinite(alpha) || !std::isfinite(beta)) return out;
  Equations<T> e;
  const T V = samples[0].V;
  const Vec3<T> w = samples[0].w;
  T spacing = T(0);
  for (int i = 0; i < count; ++i) {
    const auto& s = samples[i];
    const T n = (s.V * s.V_dot + dot(s.gained, s.a)) / V;
    if (!std::isfinite(n) || !std::isfinite(s.lag) || !is_finite(s.a) || !is_finite(s.w))
      return out;
    e.n.push(n);
    e.m.push(s.a + s.lag * cross(s.a, w));  // (v + lag w x v) . a = v . (a + lag a x w)
    spacing = std::fmax(spacing, std::fabs(s.lag));
  }
  if (!(spacing > T(0))) return out;
  const T tiny = sizeof(T) == 8 ? T(1e-14) : T(1e-6), small = sizeof(T) == 8 ? T(1e-9) : T(1e-5);
  T now = cost(e, alpha, beta), damping = T(0), size = T(0);
  for (const auto& m : e.m) size += dot(m, m);
  size = std::sqrt(size);
  for (; out.iterations < settings.iterations && !out.converged; ++out.iterations) {
    const auto s = step(e, out.alpha, out.beta, damping);
    const T longest = std::fmax(std::fabs(s.alpha), std::fabs(s.beta));
    if (!std::isfinite(longest)) break;
    const T k = longest > settings.longest_step ? settings.longest_step / longest : T(1);
    const T a = out.alpha + k * s.alpha, b = out.beta + k * s.beta;
    const T then = cost(e, a, b);
    if (then <= now) {
      out.alpha = a;
      out.beta = b;
      now = then;
      out.converged = longest < small && damping <= std::fmin(s.free_alpha, s.free_beta);
      damping = damping > tiny * size ? T(0.1) * damping : T(0);
    } else if (longest < small && !(damping > T(0))) {
      out.converged = true;  // rounding of the cost is all that is left
    } else {
      damping = std::fmax(T(10) * damping,
                          std::fmax(T(0.1) * std::fmin(s.free_alpha, s.free_beta), tiny * size));
    }
  }
  const auto last = step(e, out.alpha, out.beta, T(0));
  // What Eq. (15) leaves out of w x v over each lag: its derivative times half the lag's square.
  const Vec3<T> v = V * flow_basis(out.alpha, out.beta).along;
  T left_out = T(0);
  for (int i = 1; i < count; ++i) {
    const auto& s = samples[i];
    if (s.lag == T(0)) continue;
    const Vec3<T> w_dot = (T(1) / s.lag) * (w - s.w);
    const Vec3<T> turning = cross(w_dot, v) + cross(w, samples[0].a - cross(w, v));
    const T error = T(0.5) * s.lag * s.lag * dot(turning, s.a) / V;
    left_out += error * error;
  }
  const T wrong = settings.equation_error + std::sqrt(left_out);
  const T floor = T(10) * tiny * size;  // what is smaller is rounding
  // The line that two equations leave meets the sphere a second time, mirrored along the line. A
  // root too close to be told from it is as wrong as the two differ.
  const Vec3<T> line = cross(e.m[0], e.m[count - 1]);
  const T length = std::sqrt(dot(line, line));
  T other_alpha = T(0), other_beta = T(0);
  if (length > T(0)) {
    const Vec3<T> i = (T(1) / V) * v, d = (T(1) / length) * line;
    const T apart = dot(i, d);
    if (std::fabs(apart) < settings.least_apart) {
      const Vec3<T> other = i - (T(2) * apart) * d;
      other_alpha = std::fabs(std::atan2(other.z, other.x) - std::atan2(i.z, i.x));
      other_beta = std::fabs(std::atan2(other.y, std::hypot(other.x, other.z)) - out.beta);
    }
  }
  if (last.free_alpha > floor) out.existence_alpha = T(1) / (wrong / last.free_alpha + other_alpha);
  if (last.free_beta > floor) out.existence_beta = T(1) / (wrong / last.free_beta + other_beta);
  out.residual = std::sqrt(now / T(count));
  return out;
}

// Scheme with memory. Two equations have two roots, which meet where they become dependent: each
// solution starts from the last valid one carried on by rates and accelerations, so that the right
// root is found again on the other side.
template <class T>
struct ZeroOrderScheme {
  ZeroOrderSettings<T> settings;
  ReportedAngle<T> alpha, beta;  // values: first guess before the first valid ones
  AsseRejected rejected;
  T carried_alpha{0}, carried_beta{0};
  Vec3<T> a, w;  // at the last time
  double t = 0.0;
  bool started = false;
};

// The solution at time t, s; false where the sample was rejected and nothing has changed.
template <class T>
inline bool update(ZeroOrderScheme<T>& scheme, double t, const ZeroOrderSample<T>* samples,
                   int count, ZeroOrderSolution<T>& solution) {
  bool finite = std::isfinite(t);
  for (int i = 0; i < count; ++i)
    finite &= std::isfinite(samples[i].V) && std::isfinite(samples[i].V_dot) &&
              std::isfinite(samples[i].lag) && is_finite(samples[i].a) &&
              is_finite(samples[i].gained) && is_finite(samples[i].w);
  if (!finite) return ++scheme.rejected.not_finite, false;
  if (scheme.started && !(t > scheme.t)) return ++scheme.rejected.backward, false;
  if (count < 1 || !(samples[0].V > T(0))) return ++scheme.rejected.slow, false;
  const auto& here = samples[0];
  const T dt = scheme.started ? static_cast<T>(t - scheme.t) : T(0);
  if (!scheme.started) {
    scheme.carried_alpha = scheme.alpha.value;
    scheme.carried_beta = scheme.beta.value;
  } else if (dt <= scheme.settings.longest_gap) {
    const Vec3<T> a = T(0.5) * (scheme.a + here.a), w = T(0.5) * (scheme.w + here.w);
    const Vec3<T> v = here.V * flow_basis(scheme.carried_alpha, scheme.carried_beta).along;
    const Vec3<T> half = v + (T(0.5) * dt) * (a - cross(w, v));
    const Vec3<T> then = v + dt * (a - cross(w, half));
    scheme.carried_alpha = std::atan2(then.z, then.x);
    scheme.carried_beta = std::atan2(then.y, std::hypot(then.x, then.z));
  } else {
    ++scheme.rejected.gaps;
  }
  scheme.t = t;
  scheme.started = true;
  scheme.a = here.a;
  scheme.w = here.w;
  solution = zero_order(samples, count, scheme.carried_alpha, scheme.carried_beta, scheme.settings);
  const T least = scheme.settings.threshold, far = scheme.settings.farthest;
  const bool near = std::fabs(solution.alpha - scheme.carried_alpha) < far &&
                    std::fabs(solution.beta - scheme.carried_beta) < far;
  const bool good = solution.converged && (near || !scheme.alpha.ever || !scheme.beta.ever);
  report(scheme.alpha, solution.alpha, good && solution.existence_alpha > least, dt);
  report(scheme.beta, solution.beta, good && solution.existence_beta > least, dt);
  if (scheme.alpha.observable) scheme.carried_alpha = solution.alpha;
  if (scheme.beta.observable) scheme.carried_beta = solution.beta;
  return true;
}

// Eq. (25), its integral from tau to t: relative error of replacing the integral of w x v by
// (w x v)(t) lag, along the acceleration at tau. Also the denominator, m2/s3: near its zeros the
// ratio says nothing.
template <class T>
struct ZeroOrderError {
  T ratio, denominator;
};

template <class T>
inline ZeroOrderError<T> zero_order_error(const Vec3<T>& turning, T lag, const Vec3<T>& integral,
                                          const Vec3<T>& a) {
  const T exact = dot(integral, a);
  return {-(lag * dot(turning, a) - exact) / exact, exact};
}

}  // namespace alula
