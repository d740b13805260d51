#pragma once
// A rigid body of full inertia tensor: Newton and Euler about the center of gravity.
#include "alula/math/vec3.hpp"

namespace alula {

// inertia: about the center of gravity, body axes, with the signs of a tensor: the off-diagonal
// elements are minus the products of inertia (row 0, column 2 holds -Ixz).
template <class T>
struct MassProperties {
  T mass{1};
  Mat3<T> inertia{};
  Mat3<T> inertia_inverse{};
};

template <class T>
constexpr MassProperties<T> mass_properties(T mass, const Mat3<T>& inertia) {
  return {mass, inertia, inverse(inertia)};
}

// Rate of the body-axes velocity, m/s2: specific force plus gravity in body axes, less w x v.
// Dittrich 2016, section 2.4.3.
template <class S>
constexpr Vec3<S> velocity_rate(const Vec3<S>& specific_force, const Vec3<S>& gravity_body,
                                const Vec3<S>& v, const Vec3<S>& w) {
  return specific_force + gravity_body - cross(w, v);
}

// Angular acceleration, rad/s2, for a moment about the center of gravity: the solution of
// M = J dw/dt + w x J w. Dittrich 2016, Eq. (2.39).
template <class S, class T>
constexpr Vec3<S> angular_acceleration(const MassProperties<T>& body, const Vec3<S>& moment,
                                       const Vec3<S>& w) {
  return body.inertia_inverse * (moment - cross(w, body.inertia * w));
}

}  // namespace alula
