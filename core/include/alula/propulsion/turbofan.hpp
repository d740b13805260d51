#pragma once
// A turbofan (or turbojet) by thrust tables over Mach number and height, with lag.
#include "alula/aero/lookup.hpp"
#include "alula/math/limit.hpp"

namespace alula {

// Power is a fraction: 0 idle, `military_at` military, 1 maximum (afterburner). Without a table of
// maximum thrust military is at 1.
template <class T>
struct Turbofan {
  Lookup<T> idle{}, military{}, maximum{};  // thrust, N, over Mach number and height (m)
  T military_at{1};                         // throttle and power of military thrust, above 0
  T tau{1};                                 // s, lag of power behind throttle
  T consumption{0};                         // kg/s of fuel per N of thrust
  T angular_momentum{0};                    // kg m2/s of the rotors at full power
  T sense{1};                               // +1: along +direction
  T idle_speed{1};  // rotor speed at idle over that at full power; 1: momentum constant
};

template <class S, class T>
constexpr S turbofan_thrust(const Turbofan<T>& e, const S& power, const S& mach, const S& height) {
  const S none(0), low = lookup(e.idle, mach, height, none);
  const S middle = lookup(e.military, mach, height, none);
  const S fraction = limited(power, T(0), T(1));
  if (e.maximum.axes == 0) return low + fraction * (middle - low);
  const auto beyond = value_of(fraction) > e.military_at;
  const S dry = low + ((T(1) / e.military_at) * fraction) * (middle - low);
  if (!any(beyond)) return dry;
  const S high = lookup(e.maximum, mach, height, none);
  const S part = (T(1) / (T(1) - e.military_at)) * (fraction - e.military_at);
  return select(beyond, S(middle + part * (high - middle)), dry);
}

// Rate of power, 1/s, for a throttle 0..1.
template <class S, class T>
constexpr S turbofan_rate(const Turbofan<T>& e, const S& power, const S& throttle) {
  return (T(1) / e.tau) * (limited(throttle, T(0), T(1)) - power);
}

// Angular momentum of the rotors along the direction, kg m2/s.
template <class S, class T>
constexpr S turbofan_momentum(const Turbofan<T>& e, const S& power) {
  return (e.sense * e.angular_momentum) * (e.idle_speed + (T(1) - e.idle_speed) * power);
}

}  // namespace alula
