#pragma once
// A flat Earth that does not turn: NED axes, constant gravity, steady wind.
#include <cmath>

#include "alula/math/quaternion.hpp"

namespace alula {

inline constexpr double kStandardGravity = 9.80665;  // m/s2

template <class S>
constexpr Vec3<S> gravity_in_body(const Mat3<S>& R_BE, const S& gravity) {
  return {gravity * R_BE.row[0].z, gravity * R_BE.row[1].z, gravity * R_BE.row[2].z};
}

// Velocity against the air, body axes: ground velocity less the wind (NED, the way it blows to).
template <class S, class T>
constexpr Vec3<S> air_velocity(const Mat3<S>& R_BE, const Vec3<S>& v_B, const Vec3<T>& wind_E) {
  return v_B - R_BE * wind_E;
}

template <class S>
struct FlowAngles {
  S V, alpha, beta;
};

// Airspeed, angle of attack atan2(w, u) and sideslip asin(v/V) of an air velocity. Sideslip is
// taken by atan2, which rounding cannot drive out of its domain.
template <class S>
FlowAngles<S> flow_angles(const Vec3<S>& v) {
  using std::atan2;
  using std::sqrt;
  const S plane = v.x * v.x + v.z * v.z;
  return {sqrt(plane + v.y * v.y), atan2(v.z, v.x), atan2(v.y, sqrt(plane))};
}

}  // namespace alula
