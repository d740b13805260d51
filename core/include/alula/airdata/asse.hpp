#pragma once
// What the schemes for angle of attack and sideslip without vane or model share (ASSE: Lerro,
// Brandl, Gili, Model-Free Scheme for Angle-of-Attack and Angle-of-Sideslip Estimation, J. Guidance
// 2020).
//
// Body axes x forward, y right, z down. The specific force f is what accelerometers sense, -g at
// rest; the air-relative velocity v obeys v' = a - w x v with a = f + gravity - wind acceleration.
#include <cmath>

#include "alula/math/vec3.hpp"

namespace alula {

// Acceleration against the air mass; all in body axes, m/s2. `wind_rate`: time derivative of the
// wind's Earth components; zero in a steady wind.
template <class T>
constexpr Vec3<T> air_acceleration(const Vec3<T>& f, const Vec3<T>& gravity,
                                   const Vec3<T>& wind_rate) {
  return f + gravity - wind_rate;
}

// Unit vectors at a flow direction: along the velocity, and where it turns with alpha and beta:
// dv = along dV + V cos(beta) by_alpha dalpha + V by_beta dbeta.
template <class T>
struct FlowBasis {
  Vec3<T> along, by_alpha, by_beta;
  T cos_beta;
};

template <class T>
inline FlowBasis<T> flow_basis(T alpha, T beta) {
  const T ca = std::cos(alpha), sa = std::sin(alpha), cb = std::cos(beta), sb = std::sin(beta);
  return {{ca * cb, sb, sa * cb}, {-sa, T(0), ca}, {-ca * sb, cb, -sa * sb}, cb};
}

template <class T>
inline bool is_finite(const Vec3<T>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// An angle as the schemes report it: the last valid value stays, with its age.
template <class T>
struct ReportedAngle {
  T value{0};  // rad
  T age{0};    // s since it was last observable; meaningless before the first time
  bool observable = false;
  bool ever = false;
};

// Takes up what was found after dt seconds; a value that is not observable leaves the last one.
template <class T>
inline void report(ReportedAngle<T>& angle, T value, bool observable, T dt) {
  angle.observable = observable;
  angle.age = observable ? T(0) : angle.age + dt;
  if (!observable) return;
  angle.value = value;
  angle.ever = true;
}

// What was not taken up.
struct AsseRejected {
  long not_finite = 0;
  long backward = 0;  // time that does not go forward, or a measurement older than what is kept
  long slow = 0;      // airspeed not above the least one
  long outlying = 0;  // airspeed farther from the expected one than noise explains
  long gaps = 0;      // interruptions after which a scheme starts over
};

}  // namespace alula
