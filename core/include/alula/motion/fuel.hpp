#pragma once
// How burned fuel changes mass, center of gravity and inertia.
#include "alula/math/limit.hpp"
#include "alula/motion/rigid_body.hpp"

namespace alula {

// The fuel aboard when nothing is burned yet. position: its center from the center of gravity of
// the aircraft as loaded, body axes, m; inertia: about its own center. Both shrink in proportion.
template <class T>
struct FuelLoad {
  T mass{0};
  Vec3<T> position{};
  Mat3<T> inertia{};
};

// Inertia of a point mass at r.
template <class S>
constexpr Mat3<S> point_inertia(const S& mass, const Vec3<S>& r) {
  const S xx = r.x * r.x, yy = r.y * r.y, zz = r.z * r.z;
  const S xy = -(mass * (r.x * r.y)), xz = -(mass * (r.x * r.z)), yz = -(mass * (r.y * r.z));
  return {{{mass * (yy + zz), xy, xz}, {xy, mass * (xx + zz), yz}, {xz, yz, mass * (xx + yy)}}};
}

template <class S>
struct BurnedMass {
  MassProperties<S> body;
  Vec3<S> shift;  // of the center of gravity, from where it was with all fuel
};

// Mass properties after burning `used` kg; an empty tank stays empty.
template <class S, class T>
BurnedMass<S> after_burning(const MassProperties<T>& loaded, const FuelLoad<T>& fuel,
                            const S& used) {
  const S burned = limited(used, T(0), fuel.mass);
  const S part = burned * (T(1) / fuel.mass);
  const S mass = S(loaded.mass) - burned;
  const Vec3<S> at = S(1) * fuel.position;
  BurnedMass<S> now;
  now.shift = (-burned / mass) * at;
  // About the old center of gravity the fuel is taken away; then all is moved to the new one.
  const Mat3<S> taken = point_inertia(burned, at), moved = point_inertia(mass, now.shift);
  Mat3<S> inertia;
  for (int i = 0; i < 3; ++i)
    inertia.row[i] =
        loaded.inertia.row[i] - part * fuel.inertia.row[i] - taken.row[i] - moved.row[i];
  now.body = mass_properties(mass, inertia);
  return now;
}

}  // namespace alula
