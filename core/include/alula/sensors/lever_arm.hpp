#pragma once
// What a sensor away from the center of gravity feels. r: from the center of gravity to the
// sensor, body axes, m.
#include "alula/math/vec3.hpp"

namespace alula {

// Specific force at r: f + dw/dt x r + w x (w x r).
template <class S, class T>
constexpr Vec3<S> specific_force_at(const Vec3<S>& f, const Vec3<S>& w, const Vec3<S>& w_dot,
                                    const Vec3<T>& r) {
  return f + cross(w_dot, r) + cross(w, cross(w, r));
}

// Velocity at r: v + w x r. Vanes and airspeed sensors measure this one.
template <class S, class T>
constexpr Vec3<S> velocity_at(const Vec3<S>& v, const Vec3<S>& w, const Vec3<T>& r) {
  return v + cross(w, r);
}

}  // namespace alula
