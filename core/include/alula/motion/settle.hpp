#pragma once
// The values that the states behind the first thirteen come to when the motion stays as it is.
#include "alula/motion/aircraft.hpp"

namespace alula {

// Speed (rad/s) of a propeller at which drive and air are in balance, the highest one; zero where
// it stands.
template <class T>
T steady_speed(const Engine<T>& engine, const T& throttle, const Loads<T>& load, const T& height,
               const Vec3<T>& w, const T& charge) {
  const auto gains = [&](T omega) {
    return engine_loads(engine, omega, throttle, T(0), load.air, load.mach, height, load.v_air, w,
                        charge)
               .state_rate > T(0);
  };
  T high(8192), low(4096);
  while (!gains(low)) {
    high = low;
    low *= T(0.5);
    if (low < T(1e-3)) return T(0);
  }
  for (int i = 0; i < 60; ++i) {
    const T middle = T(0.5) * (low + high);
    (gains(middle) ? low : high) = middle;
  }
  return T(0.5) * (low + high);
}

// Sets rotor speeds, power, separation points and actuators of x; charge and fuel stay.
template <class T>
void settle(const AircraftModel<T>& a, const FlightInput<T>& u, FlightState<T>& x) {
  const StateLayout& layout = a.layout;
  x.length = layout.size;
  for (int i = 0; i < kControls; ++i) {
    if (layout.actuator[i] < 0) continue;
    const auto& actuator = a.actuators[static_cast<unsigned>(i)];
    x[layout.actuator[i]] = limited(u[static_cast<unsigned>(i)], actuator.low, actuator.high);
  }
  const Place<T> at = place(x, a.earth, a.gravity);
  const Loads<T> load = loads(x, u, a, a.wind, at);
  if (a.stalls) {
    const int halves = separation_states(a.stall);
    for (int i = 0; i < halves; ++i) {
      const Wing wing = halves == 1 ? Wing::whole : i == 0 ? Wing::left : Wing::right;
      const T alpha =
          halves == 1 ? load.flow.alpha : local_alpha(a.stall, load.v_air, load.w_air, wing);
      x[layout.stall[i]] = attached_part(a.stall, alpha, wing);
    }
  }
  const T throttle = limited(control(x, u, a, kControls - 1), T(0), T(1));
  const T charge = layout.charge < 0 ? T(0) : x[layout.charge];
  for (int i = 0; i < a.engines.size(); ++i) {
    if (layout.engine[i] < 0) continue;
    const Engine<T>& engine = a.engines[i];
    x[layout.engine[i]] =
        has_propeller(engine.kind)
            ? steady_speed(engine, throttle, load, at.height, {x[10], x[11], x[12]}, charge)
            : throttle;
  }
}

}  // namespace alula
