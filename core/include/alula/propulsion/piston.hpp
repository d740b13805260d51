#pragma once
// A piston engine that turns its propeller through a gear.
#include <cmath>

#include "alula/math/curve.hpp"
#include "alula/math/limit.hpp"

namespace alula {

template <class T>
struct Piston {
  Curve<T> torque{};     // N m at the crankshaft over its speed in rad/s: full throttle, sea level
  T reduction{1};        // crankshaft speed over propeller speed
  T gear_sense{1};       // +1: crankshaft and propeller turn the same way; -1: a pair of spur gears
  T crank_inertia{0};    // kg m2 of all that turns with the crankshaft, about its own axis
  T friction{0};         // N m at the crankshaft, throttle closed and ignition off
  T idle{0};             // opening that the closed throttle leaves, 0..1
  T consumption{0};      // kg/J of shaft power at full throttle (g/kWh divided by 3.6e9)
  T power_loss{0.1325};  // Gagg and Ferrar: 1/7.55; 0: torque proportional to density
};

inline constexpr double kSeaLevelDensity = 1.225;  // kg/m3
inline constexpr double kFrictionSpeed = 5.0;      // rad/s: below about this friction fades to zero

template <class S>
struct PistonLoads {
  S torque;     // N m at the propeller's shaft
  S fuel_flow;  // kg/s
};

// Friction reverses with the sense of rotation; smooth, within 1e-4 of one above 70 times `slow`.
template <class S, class T>
constexpr S friction_sense(const S& omega, T slow) {
  using std::sqrt;
  const S x = (T(1) / slow) * omega;
  return x / sqrt(x * x + S(1));
}

// omega: speed of the propeller, rad/s; throttle 0..1, limited; density kg/m3.
// Brake torque at full throttle falls with density as sigma - (1 - sigma)/7.55 (Gagg and Ferrar,
// SAE Journal 34, 1934: the indicated torque goes with density, friction does not), nowhere below
// zero. The throttle takes its part of brake torque and friction together, so that closed it leaves
// the friction; fuel goes with the same opening (Willans' line).
template <class S, class T>
constexpr PistonLoads<S> piston_loads(const Piston<T>& e, const S& omega, const S& throttle,
                                      const S& density) {
  const S speed = e.reduction * omega;
  const S sigma = T(1.0 / kSeaLevelDensity) * density;
  S full = curve(e.torque, speed) * ((T(1) + e.power_loss) * sigma - e.power_loss);
  full = select(value_of(full) < T(0), S(0), full);
  const S opening = e.idle + (T(1) - e.idle) * limited(throttle, T(0), T(1));
  const S friction = e.friction * friction_sense(speed, T(kFrictionSpeed));
  const S torque = opening * (full + e.friction) - friction;
  const S flow = e.consumption * (opening * full * speed);
  return {e.reduction * torque, select(value_of(flow) < T(0), S(0), flow)};
}

// What resists a change of the propeller's speed, kg m2: Dittrich's J_P with the crankshaft's
// inertia seen through the gear.
template <class T>
constexpr T turning_inertia(const Piston<T>& e, T propeller_inertia) {
  return propeller_inertia + e.reduction * e.reduction * e.crank_inertia;
}

// Angular momentum of propeller and crankshaft over the propeller's speed, kg m2.
template <class T>
constexpr T momentum_inertia(const Piston<T>& e, T propeller_inertia) {
  return propeller_inertia + e.gear_sense * e.reduction * e.crank_inertia;
}

}  // namespace alula
