#pragma once
// Battery, speed controller and brushless motor on the propeller's shaft.
#include "alula/math/limit.hpp"
#include "alula/propulsion/piston.hpp"

namespace alula {

template <class T>
struct Electric {
  T k_V{1};                       // rad/s per V
  T k_T{1};                       // N m per A; 1/k_V where nothing else is known
  T no_load_current{0};           // A: what friction takes
  T resistance{1};                // ohm: battery, speed controller and motor together
  T full_voltage{0};              // V, battery at rest, charged
  T empty_voltage{0};             // V, battery at rest, empty
  T capacity{1};                  // A s
  T most_current{1e9};            // A, limit of the speed controller
  T most_regenerated_current{0};  // A back through the motor; 0: it never brakes
};

template <class S>
struct ElectricLoads {
  S torque;         // N m at the shaft, friction taken off
  S motor_current;  // A
  S current;        // A drawn from the battery
};

// V of the battery at rest after drawing `charge` A s: Pusztai 2018, Eq. (3.42).
template <class S, class T>
constexpr S battery_voltage(const Electric<T>& e, const S& charge) {
  const S left = limited(T(1) - (T(1) / e.capacity) * charge, T(0), T(1));
  return e.empty_voltage + (e.full_voltage - e.empty_voltage) * left;
}

// omega: rad/s; throttle: duty of the speed controller 0..1, limited; charge: drawn so far, A s.
// Motor: Pusztai 2018, Eq. (2.29) corrected and (3.41), current within the controller's limits. The
// battery gives the motor's current for the throttle's part of the time only: from
// `throttle U I = R I^2 + I omega/k_V`, power is conserved with throttle times I.
template <class S, class T>
constexpr ElectricLoads<S> electric_loads(const Electric<T>& e, const S& omega, const S& throttle,
                                          const S& charge) {
  const S duty = limited(throttle, T(0), T(1));
  const S voltage = duty * battery_voltage(e, charge) - (T(1) / e.k_V) * omega;
  const S current =
      limited((T(1) / e.resistance) * voltage, -e.most_regenerated_current, e.most_current);
  const S friction = e.no_load_current * friction_sense(omega, T(kFrictionSpeed));
  return {e.k_T * (current - friction), current, duty * current};
}

}  // namespace alula
