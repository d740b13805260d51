#pragma once
// Electric power train from a speed sensor and the throttle: motor speed, current, battery.
// Pusztai 2018, Eq. (3.41) to (3.43); the motor is `Electric` of propulsion/electric.hpp.
#include <cmath>

#include "alula/navigate/taken.hpp"
#include "alula/propulsion/electric.hpp"

namespace alula {

template <class T>
struct PowerTrainNoise {
  T jerk{T(2000)};  // rad/s2 per root s: how fast the acceleration changes
  T decay{T(0.3)};  // s over which an acceleration dies away
  T sensor{T(5)};   // rad/s, of a reading
  T gate{T(25)};
  T patience{T(0.5)};  // s of refusals after which the filter doubts itself
};

// Speed and acceleration with their covariance; charge taken from the battery.
template <class T>
struct PowerTrain {
  T omega{0}, acceleration{0};  // rad/s, rad/s2
  T P[2][2] = {{T(1e6), T(0)}, {T(0), T(1e8)}};
  T charge{0};         // A s drawn so far
  T motor_current{0};  // A
  T current{0};        // A drawn from the battery
  T voltage{0};        // V of the battery at rest
  T left{1};           // share of the capacity that is left, 0 to 1
  double t = 0, refused_since = -1;
  bool started = false;
  Tally tally{};
};

// On to t at a throttle (duty, 0 to 1); a reading of speed (rad/s), or `none` of it. A missed or a
// double pulse is twice or half the speed, and refused.
template <class T>
Taken step(PowerTrain<T>& f, const Electric<T>& electric, const PowerTrainNoise<T>& noise, double t,
           T throttle, T reading, bool none = false) {
  if (!std::isfinite(t) || !std::isfinite(throttle) || (!none && !std::isfinite(reading)))
    return count(f.tally, Taken::kNotFinite);
  const T dt = f.started ? static_cast<T>(t - f.t) : T(0);
  if (f.started && !(dt > T(0))) return count(f.tally, Taken::kBackwards);
  const T mean_current = f.current;
  if (f.started) {
    // acceleration dies away: exact over dt
    const T k = std::exp(-dt / noise.decay), a = noise.decay * (T(1) - k);
    f.omega += a * f.acceleration;
    f.acceleration *= k;
    const T p01 = f.P[0][1] + a * f.P[1][1];
    f.P[0][0] += a * (f.P[0][1] + p01);
    f.P[0][1] = k * p01;
    f.P[1][1] *= k * k;
    const T q = noise.jerk * noise.jerk * dt;  // as if it came evenly over dt
    f.P[0][0] += q * dt * dt / T(3);
    f.P[0][1] += q * dt / T(2);
    f.P[1][1] += q;
    f.P[1][0] = f.P[0][1];
  }
  f.t = t;
  Taken taken = Taken::kYes;
  if (!none) {
    const T S = f.P[0][0] + noise.sensor * noise.sensor, e = reading - f.omega;
    if (reading < T(0) || !(e * e <= noise.gate * S)) {
      taken = Taken::kGated;
      if (f.refused_since < 0) f.refused_since = t;
      if (t - f.refused_since > static_cast<double>(noise.patience)) {
        f.P[0][0] += e * e;
        f.refused_since = -1;
      }
    } else {
      f.refused_since = -1;
      const T k0 = f.P[0][0] / S, k1 = f.P[0][1] / S;
      f.omega += k0 * e;
      f.acceleration += k1 * e;
      f.P[1][1] -= k1 * f.P[0][1];
      f.P[0][1] -= k0 * f.P[0][1];
      f.P[0][0] -= k0 * f.P[0][0];
      f.P[1][0] = f.P[0][1];
    }
  }
  const ElectricLoads<T> loads = electric_loads(electric, f.omega, throttle, f.charge);
  f.motor_current = loads.motor_current;
  f.current = loads.current;
  if (f.started) f.charge += T(0.5) * dt * (mean_current + f.current);  // Eq. (3.43)
  if (f.charge < T(0)) f.charge = T(0);
  f.left = limited(T(1) - f.charge / electric.capacity, T(0), T(1));
  f.voltage = battery_voltage(electric, f.charge);
  f.started = true;
  return count(f.tally, taken);
}

}  // namespace alula
