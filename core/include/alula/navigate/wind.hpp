#pragma once
// Wind from one reading each of ground velocity, airspeed, flow angles and attitude; and airspeed
// from a wind that is known. NED, the way the wind blows to; covariances to first order.
#include <cmath>

#include "alula/motion/flat_earth.hpp"
#include "alula/navigate/rotation.hpp"

namespace alula {

template <class T>
struct AirReading {
  T V, alpha, beta;                    // m/s, rad
  T sigma_V, sigma_alpha, sigma_beta;  // an angle that is not measured: 0 and what it may be
};

template <class T>
struct WindFound {
  Vec3<T> wind;  // m/s
  Mat3<T> covariance;
  bool valid;  // false, and nothing in it, where an input is not a number or there is no airspeed
};

namespace wind_detail {

// M += s^2 a a'
template <class T>
void add_outer(Mat3<T>& m, const Vec3<T>& a, T s) {
  const T k = s * s;
  m.row[0] = m.row[0] + (k * a.x) * a;
  m.row[1] = m.row[1] + (k * a.y) * a;
  m.row[2] = m.row[2] + (k * a.z) * a;
}

}  // namespace wind_detail

// sigma_turn: rad about the body axes; sigma_velocity: m/s, NED.
template <class T>
WindFound<T> wind_from(const Vec3<T>& velocity, const Vec3<T>& sigma_velocity,
                       const Quaternion<T>& q, const Vec3<T>& sigma_turn, const AirReading<T>& air,
                       T least_airspeed = T(3)) {
  WindFound<T> out{{}, {}, false};
  const T sum = air.V + air.alpha + air.beta + norm_squared(q) + air.sigma_V + air.sigma_alpha +
                air.sigma_beta;
  if (!std::isfinite(sum) || !finite(velocity) || !finite(sigma_velocity) || !finite(sigma_turn) ||
      !(air.V > least_airspeed))
    return out;
  const T ca = std::cos(air.alpha), sa = std::sin(air.alpha);
  const T cb = std::cos(air.beta), sb = std::sin(air.beta), V = air.V;
  const Mat3<T> R_BE = earth_to_body(normalized(q));
  const Vec3<T> ahead{ca * cb, sb, sa * cb}, v = V * ahead;
  const auto earth = [&R_BE](const Vec3<T>& a) { return transposed_times(R_BE, a); };
  using wind_detail::add_outer;
  out.wind = velocity - earth(v);
  out.covariance = {{{sigma_velocity.x * sigma_velocity.x, T(0), T(0)},
                     {T(0), sigma_velocity.y * sigma_velocity.y, T(0)},
                     {T(0), T(0), sigma_velocity.z * sigma_velocity.z}}};
  add_outer(out.covariance, earth(ahead), air.sigma_V);
  add_outer(out.covariance, earth({-V * sa * cb, T(0), V * ca * cb}), air.sigma_alpha);
  add_outer(out.covariance, earth({-V * ca * sb, V * cb, -V * sa * sb}), air.sigma_beta);
  // R' (1 + theta x) v: a turn about each body axis
  add_outer(out.covariance, earth(cross(Vec3<T>{T(1), T(0), T(0)}, v)), sigma_turn.x);
  add_outer(out.covariance, earth(cross(Vec3<T>{T(0), T(1), T(0)}, v)), sigma_turn.y);
  add_outer(out.covariance, earth(cross(Vec3<T>{T(0), T(0), T(1)}, v)), sigma_turn.z);
  out.valid = true;
  return out;
}

template <class T>
struct AirFound {
  FlowAngles<T> flow;  // V m/s, alpha and beta rad
  T sigma_V, sigma_alpha, sigma_beta;
  bool valid;  // false where an input is not a number; angles need an airspeed
};

// Airspeed and flow angles without any air-data sensor, where the wind is known.
template <class T>
AirFound<T> air_from_wind(const Vec3<T>& velocity, const Vec3<T>& sigma_velocity,
                          const Quaternion<T>& q, const Vec3<T>& sigma_turn, const Vec3<T>& wind,
                          const Mat3<T>& wind_covariance, T least_airspeed = T(3)) {
  AirFound<T> out{{}, T(0), T(0), T(0), false};
  const auto& w = wind_covariance.row;
  if (!finite(velocity) || !finite(sigma_velocity) || !std::isfinite(norm_squared(q)) ||
      !finite(sigma_turn) || !finite(wind) || !finite(w[0]) || !finite(w[1]) || !finite(w[2]))
    return out;
  const Mat3<T> R_BE = earth_to_body(normalized(q));
  const Vec3<T> v = R_BE * (velocity - wind);
  out.flow = flow_angles(v);
  const T V = out.flow.V, plane = v.x * v.x + v.z * v.z, root = std::sqrt(plane);
  if (!(root > least_airspeed)) return out;
  const T k = T(1) / (V * V * root);
  const Vec3<T> slope[3] = {(T(1) / V) * v,
                            {-v.z / plane, T(0), v.x / plane},
                            {-k * v.x * v.y, k * plane, -k * v.z * v.y}};
  T* sigma[3] = {&out.sigma_V, &out.sigma_alpha, &out.sigma_beta};
  for (int i = 0; i < 3; ++i) {
    const Vec3<T> e = transposed_times(R_BE, slope[i]), turn = cross(slope[i], v);
    const auto squared = [](T a) { return a * a; };
    const T variance = dot(e, wind_covariance * e) + squared(e.x * sigma_velocity.x) +
                       squared(e.y * sigma_velocity.y) + squared(e.z * sigma_velocity.z) +
                       squared(turn.x * sigma_turn.x) + squared(turn.y * sigma_turn.y) +
                       squared(turn.z * sigma_turn.z);
    *sigma[i] = std::sqrt(variance);
  }
  out.valid = true;
  return out;
}

}  // namespace alula
