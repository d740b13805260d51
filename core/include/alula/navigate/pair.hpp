#pragma once
// The two filters of Pusztai 2018, 3.4.3, working together: attitude at every inertial sample,
// position and velocity at every second one (800 and 400 Hz there), measured attitude at the
// magnetometer's rate from the mean specific force since the last one.
#include "alula/navigate/attitude_filter.hpp"
#include "alula/navigate/position_filter.hpp"

namespace alula {

template <class T>
struct PairNoise {
  AttitudeNoise<T> attitude{};
  PositionNoise<T> position{};
  Vec3<T> field{};  // of the Earth, NED, any unit
  int every = 2;    // inertial samples for a step of the position filter
};

template <class T>
struct Pair {
  AttitudeFilter<T> attitude{};
  PositionFilter<T> position{};
  Vec3<T> force{}, rate{};  // sums since the last measured attitude
  Vec3<T> step_force{};     // and since the last step of the position filter
  int samples = 0, step_samples = 0;
  T airspeed{0};  // m/s, the last one read; 0: none, ground velocity stands in
  double airspeed_at = -1;
};

// Rates and specific force, body axes, at t.
template <class T>
Taken predict(Pair<T>& f, const PairNoise<T>& noise, double t, const Vec3<T>& w,
              const Vec3<T>& force) {
  if (!std::isfinite(t) || !finite(w) || !finite(force))
    return count(f.attitude.tally, Taken::kNotFinite);
  const Taken taken = predict(f.attitude, noise.attitude, t, w);
  if (taken != Taken::kYes && taken != Taken::kGap) return taken;
  f.force = f.force + force;
  f.rate = f.rate + f.attitude.rate;
  ++f.samples;
  f.step_force = f.step_force + force;
  if (++f.step_samples < noise.every && taken == Taken::kYes) return taken;
  const Vec3<T> mean = (T(1) / static_cast<T>(f.step_samples)) * f.step_force;
  f.step_force = {};
  f.step_samples = 0;
  predict(f.position, noise.position, t, mean, f.attitude.q);
  return taken;
}

// True airspeed, m/s: in a steady turn in wind it is the velocity through the air that stands
// still in body axes, not the one over ground (3.23 has the latter).
template <class T>
Taken update_airspeed(Pair<T>& f, T V) {
  if (!std::isfinite(V)) return count(f.attitude.tally, Taken::kNotFinite);
  f.airspeed = V > T(0) ? V : T(0);
  f.airspeed_at = f.attitude.t;
  return Taken::kYes;
}

// Magnetic field, body axes: attitude from it and gravity, centripetal part taken off.
template <class T>
Judged<T> update_field(Pair<T>& f, const PairNoise<T>& noise, const Vec3<T>& B_B) {
  if (!finite(B_B)) return {count(f.attitude.tally, Taken::kNotFinite), T(0), {}};
  if (f.samples < 1) return {count(f.attitude.tally, Taken::kUnusable), T(0), {}};
  const T k = T(1) / static_cast<T>(f.samples);
  const Vec3<T> force = k * f.force, rate = k * f.rate;
  f.force = f.rate = {};
  f.samples = 0;
  const bool fresh = f.airspeed > T(0) && f.attitude.t - f.airspeed_at < 1.0;
  const Vec3<T> v =
      fresh ? Vec3<T>{f.airspeed, T(0), T(0)} : earth_to_body(f.attitude.q) * f.position.velocity;
  const Vec3<T> g_B = gravity_seen(force, rate, v);
  return update(f.attitude, noise.attitude,
                measured_attitude(g_B, B_B, noise.field, noise.position.gravity));
}

}  // namespace alula
