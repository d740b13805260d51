#pragma once
// What the joint filter knows and how it is told apart: states, noise, start.
#include <cmath>

#include "alula/navigate/covariance.hpp"
#include "alula/navigate/history.hpp"
#include "alula/navigate/rotation.hpp"

namespace alula {

// First of the error states: turn (rad, body axes), velocity, position (NED), biases of gyro and
// accelerometer, wind and gust (NED, the way they blow to), error of the barometric height.
enum JointState : int {
  kTurn = 0,
  kVelocity = 3,
  kPosition = 6,
  kGyroBias = 9,
  kForceBias = 12,
  kWind = 15,
  kGust = 18,
  kHeightBias = 21,
  kJointStates = 22
};

// Whose refusals are remembered.
enum JointSensor : int { kOfPosition, kOfVelocity, kOfField, kOfHeight, kOfAir, kJointSensors };

template <class T>
struct JointNoise {
  T gyro{T(2e-4)};                // rad/s per root Hz
  T gyro_walk{T(1e-5)};           // rad/s per root s
  T accelerometer{T(5e-3)};       // m/s2 per root Hz
  T accelerometer_walk{T(5e-4)};  // m/s2 per root s
  T wind_walk{T(0.02)};           // m/s per root s, of the wind that turbulence goes about
  // Turbulence, north east down: standard deviation m/s and length m. Gauss-Markov along the way
  // through the air: Dryden's u exactly, v and w nearly.
  Vec3<T> gust{T(1), T(1), T(1)}, gust_length{T(300), T(300), T(150)};
  T height_walk{T(0.02)};  // m per root s, of the barometric height's error
  T gravity{T(9.80665)};
  Vec3<T> field{};       // T, NED; all zero: no magnetometer is taken
  Vec3<T> air_sensor{};  // m from the inertial sensor, body axes, to where the air is measured
  Vec3<T> antenna{};     // m from the inertial sensor, body axes
  T least_airspeed{T(3)};
  T longest_step{T(0.1)};          // s; beyond it the sample comes after a hole
  T unknown_rate{T(0.3)};          // rad/s and
  T unknown_acceleration{T(10)};   // m/s2 that the aircraft may have in a hole
  T gate3{T(25)}, gate1{T(19.5)};  // one in 100 000 by chance
  T patience{T(5)};                // s of refusals after which the filter doubts itself
};

template <class T>
struct JointFilter {
  Quaternion<T> q{T(1), T(0), T(0), T(0)};
  Vec3<T> velocity{}, position{};     // NED
  Vec3<T> gyro_bias{}, force_bias{};  // rad/s, m/s2, body axes
  Vec3<T> wind{}, gust{};             // NED
  T height_bias{0};                   // barometric height less the true one, m
  Vec3<T> rate{};                     // rad/s, less bias, at t
  Vec3<T> acceleration{};             // NED, at t
  ErrorCovariance<T, kJointStates> P{};
  History<T> history{};
  double t = 0;  // s; double also where T is float: a float of seconds ends at hours
  double refused_since[kJointSensors] = {-1, -1, -1, -1, -1};
  bool started = false;
  Tally tally{};
};

// Standard deviations at the start; rad about level axes and about the vertical (an unknown
// heading: 1.8). first_wind, m/s NED, should agree with the first velocity, attitude and air data:
// heading and wind across are told apart only by turns, and a filter that starts where they
// contradict each other takes the curvature between for knowledge.
template <class T>
struct JointStart {
  T tilt{T(0.1)}, heading{T(0.3)};
  Vec3<T> first_wind{};
  T velocity{1}, position{5}, gyro_bias{T(0.01)}, force_bias{T(0.1)}, wind{10}, height_bias{5};
};

// The satellites' antenna; the history holds its places, so that a late reading meets the attitude
// that was.
template <class T>
Place3<T> antenna_of(const JointFilter<T>& f, const JointNoise<T>& noise) {
  const Mat3<T> R_BE = earth_to_body(f.q);
  return {f.position + transposed_times(R_BE, noise.antenna),
          f.velocity + transposed_times(R_BE, cross(f.rate, noise.antenna))};
}

template <class T>
Taken start(JointFilter<T>& f, const JointNoise<T>& noise, double t, const Quaternion<T>& q,
            const Vec3<T>& velocity, const Vec3<T>& position, const JointStart<T>& sigma) {
  const T norm = norm_squared(q);
  if (!std::isfinite(t) || !(norm > T(0)) || !std::isfinite(norm) || !finite(velocity) ||
      !finite(position) || !finite(sigma.first_wind))
    return count(f.tally, Taken::kNotFinite);
  const Tally tally = f.tally;
  f = JointFilter<T>{};
  f.tally = tally;
  f.q = normalized(q);
  f.velocity = velocity;
  f.position = position;
  f.wind = sigma.first_wind;
  f.t = t;
  const auto each = [](const Vec3<T>& s) { return Vec3<T>{s.x * s.x, s.y * s.y, s.z * s.z}; };
  const auto all = [&each](T s) { return each({s, s, s}); };
  const Mat3<T> R_BE = earth_to_body(f.q);
  add_attitude_variance(f.P, kTurn, {R_BE.row[0].z, R_BE.row[1].z, R_BE.row[2].z}, sigma.tilt,
                        sigma.heading);
  add_variance(f.P, kVelocity, all(sigma.velocity));
  add_variance(f.P, kPosition, all(sigma.position));
  add_variance(f.P, kGyroBias, all(sigma.gyro_bias));
  add_variance(f.P, kForceBias, all(sigma.force_bias));
  // air that stays rises and sinks little
  const Vec3<T> wind{sigma.wind, sigma.wind, T(0.1) * sigma.wind};
  add_variance(f.P, kWind, each(wind));
  add_variance(f.P, kGust, each(noise.gust));
  f.P.P[kHeightBias][kHeightBias] = sigma.height_bias * sigma.height_bias;
  remember(f.history, t, antenna_of(f, noise));
  f.started = true;
  return count(f.tally, Taken::kYes);
}

// Velocity against the air where it is measured, body axes, m/s.
template <class T>
Vec3<T> air_velocity_at_sensor(const JointFilter<T>& f, const JointNoise<T>& noise) {
  return earth_to_body(f.q) * (f.velocity - f.wind - f.gust) + cross(f.rate, noise.air_sensor);
}

}  // namespace alula
