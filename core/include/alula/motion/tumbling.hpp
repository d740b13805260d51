#pragma once
// A body that turns free of any moment: energy and angular momentum must stay as they were.
#include "alula/math/bounded.hpp"
#include "alula/math/quaternion.hpp"
#include "alula/math/rk4.hpp"
#include "alula/motion/rigid_body.hpp"

namespace alula {

template <class T>
struct TumblingDrift {
  T energy;     // largest relative change of the rotational energy
  T magnitude;  // of the length of the angular momentum
  T direction;  // of the angular momentum in inertial axes, against its length
};

template <class T>
TumblingDrift<T> tumble(const Mat3<T>& inertia, const Vec3<T>& rates, T dt, long steps) {
  const MassProperties<T> body = mass_properties(T(1), inertia);
  using State = Bounded<T, 7>;
  State x{{T(1), T(0), T(0), T(0), rates.x, rates.y, rates.z}, 7};
  const Vec3<T> none{T(0), T(0), T(0)};
  const auto momentum = [&] { return inertia * Vec3<T>{x[4], x[5], x[6]}; };
  const Vec3<T> H0 = momentum();
  const T length = std::sqrt(dot(H0, H0)), E0 = dot(H0, rates);
  TumblingDrift<T> worst{T(0), T(0), T(0)};
  for (long i = 0; i < steps; ++i) {
    rk4_step(
        [&](T, const State& at, State& rate) {
          const Vec3<T> w{at[4], at[5], at[6]};
          const Quaternion<T> turn =
              attitude_rate(Quaternion<T>{at[0], at[1], at[2], at[3]}, w, T(1));
          const Vec3<T> dw = angular_acceleration(body, none, w);
          rate = State{{turn.w, turn.x, turn.y, turn.z, dw.x, dw.y, dw.z}, 7};
        },
        T(0), dt, x);
    const Vec3<T> H = momentum();
    const Vec3<T> off =
        transposed_times(earth_to_body(Quaternion<T>{x[0], x[1], x[2], x[3]}), H) - H0;
    const T e = std::abs(dot(H, Vec3<T>{x[4], x[5], x[6]}) / E0 - T(1));
    const T m = std::abs(std::sqrt(dot(H, H)) / length - T(1));
    const T d = std::sqrt(dot(off, off)) / length;
    if (e > worst.energy) worst.energy = e;
    if (m > worst.magnitude) worst.magnitude = m;
    if (d > worst.direction) worst.direction = d;
  }
  return worst;
}

}  // namespace alula
