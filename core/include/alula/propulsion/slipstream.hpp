#pragma once
// The slipstream behind a propeller: an actuator disk whose wake turns like a rigid body.
#include "alula/math/dual.hpp"
#include "alula/math/vec3.hpp"

namespace alula {

// Axial speeds are those of the air against the propeller, m/s aft; turning speeds are about the
// direction of the thrust, rad/s, positive the way a right-hand propeller turns (clockwise seen
// from behind). A right-hand propeller's wake therefore lowers the angle of attack of the right
// wing: w changes by -Omega_i y in the sense of the aircraft's own roll rate.
template <class S>
struct Slipstream {
  S u1;         // through the disk
  S U_i;        // far behind it
  S Omega_1;    // of the air as it meets the blades
  S Omega_i;    // far behind
  S R_i;        // m, radius far behind
  bool inside;  // false: no slipstream by this model (reverse flow, or the drag stops the air);
                // the free stream is returned
};

// axial_speed: of the hub against the air along the thrust, m/s. thrust: N. torque: N m that the
// shaft must give, positive where the engine drives. sense: +1 right-hand, -1 left-hand.
//
// Pusztai 2018, Eqs. (2.8) to (2.11); the last with the factor R^2 that momentum asks for:
// V' = pi R^2 u1, torque = rho V' Omega_i R_i^2/2 and R_i^2 u_i = R^2 u1.
template <class S, class T>
constexpr Slipstream<S> slipstream(const S& axial_speed, const S& thrust, const S& torque,
                                   const S& density, T radius, T sense) {
  const T pi(3.14159265358979323846);
  const S zero(0);
  const S u0 = axial_speed;
  const S square = u0 * u0 + (T(2) / (pi * radius * radius)) * thrust / density;
  const bool inside = !(value_of(u0) < T(0)) && value_of(square) > T(0);
  if (!inside) return {u0, u0, zero, zero, S(radius), value_of(thrust) == T(0)};
  const S u2 = sqrt(square);
  const S u1 = T(0.5) * (u0 + u2);
  const S Omega =
      (T(2) * sense / (pi * radius * radius * radius * radius)) * torque * u2 / (density * u1 * u1);
  return {u1, u2, T(0.5) * Omega, Omega, radius * sqrt(u1 / u2), true};
}

}  // namespace alula
