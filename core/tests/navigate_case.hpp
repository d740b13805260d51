#pragma once
// Exact motions for the navigation filters: what a steady turn with bank, a fall or a spin reads.
#include <cmath>

#include "alula/navigate/joint_updates.hpp"
#include "alula/navigate/pair.hpp"

namespace navigate_case {

using alula::Mat3;
using alula::Quaternion;
using alula::Vec3;

inline constexpr double kG = 9.80665, kPi = 3.14159265358979323846;

template <class T>
struct Instant {
  Quaternion<T> q;
  Vec3<T> velocity, position;  // NED
  Vec3<T> rate, force;         // body
};

// A coordinated turn in still air, level, V m/s with turn rate w rad/s; w = 0: straight on.
template <class T>
Instant<T> turn(double t, double V, double w) {
  const double phi = std::atan(w * V / kG), psi = w * t;
  Instant<T> out;
  const auto q = alula::quaternion_from_euler(phi, 0.0, psi);
  out.q = {T(q.w), T(q.x), T(q.y), T(q.z)};
  out.velocity = {T(V * std::cos(psi)), T(V * std::sin(psi)), T(0)};
  if (w != 0.0)
    out.position = {T(V / w * std::sin(psi)), T(V / w * (1.0 - std::cos(psi))), T(-100)};
  else
    out.position = {T(V * t), T(0), T(-100)};
  out.rate = {T(0), T(w * std::sin(phi)), T(w * std::cos(phi))};
  out.force = {T(0), T(0), T(-kG / std::cos(phi))};
  return out;
}

template <class T>
const Vec3<T> kField{T(21), T(1.6), T(43.8)};

template <class A, class B>
double angle_between(const Quaternion<A>& a, const Quaternion<B>& b) {
  const Quaternion<double> x{double(a.w), double(a.x), double(a.y), double(a.z)},
      y{double(b.w), double(b.x), double(b.y), double(b.z)};
  const auto turn = alula::turn_of_quaternion(conjugate(normalized(x)) * normalized(y));
  return std::sqrt(dot(turn, turn));
}

}  // namespace navigate_case
