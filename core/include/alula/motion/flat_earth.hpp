#pragma once
// A flat Earth that does not turn: NED axes, constant gravity, steady wind.
#include <cmath>
#include <type_traits>

#include "alula/math/lanes.hpp"
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
// taken by atan2, which rounding cannot drive out of its domain; plain numbers take both angles
// side by side (absolute error below 5e-16, 3e-7 for float).
template <class S>
FlowAngles<S> flow_angles(const Vec3<S>& v) {
  using std::atan2;
  using std::sqrt;
  const S plane = v.x * v.x + v.z * v.z, V = sqrt(plane + v.y * v.y);
  if constexpr (std::is_floating_point_v<S>) {
    Lanes<S, 2> up, along;
    up.set(0, v.z);
    up.set(1, v.y);
    along.set(0, v.x);
    along.set(1, sqrt(plane));
    const Lanes<S, 2> angle = atan2(up, along);
    return {V, angle[0], angle[1]};
  } else {
    return {V, atan2(v.z, v.x), atan2(v.y, sqrt(plane))};
  }
}

}  // namespace alula
