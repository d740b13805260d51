#pragma once
// A flight for the tests of the path filters: rates and forces that a periodic motion in closed
// form requires, readings with noise, and models with chosen unknowns and sensors.
#include <alula/filters/path_run.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace alula_test {

inline constexpr double kGravity = 9.80665;

// Velocity, attitude and their rates at time t; every part repeats after 60 s.
struct Motion {
  double y[alula::kMotionStates];
  double m[alula::kInertialInputs];
};

inline Motion motion_at(double t) {
  const double w1 = 6.283185307179586 * 10 / 60, w2 = 6.283185307179586 * 24 / 60;
  const double u = 100 + 3 * std::sin(w1 * t), du = 3 * w1 * std::cos(w1 * t);
  const double v = 2 * std::sin(w2 * t), dv = 2 * w2 * std::cos(w2 * t);
  const double w = 6 + 2 * std::cos(w2 * t), dw = -2 * w2 * std::sin(w2 * t);
  const double phi = 0.4 * std::sin(w1 * t), dphi = 0.4 * w1 * std::cos(w1 * t);
  const double theta = 0.06 + 0.05 * std::cos(w2 * t), dtheta = -0.05 * w2 * std::sin(w2 * t);
  const double psi = 0.2 * std::sin(w1 * t), dpsi = 0.2 * w1 * std::cos(w1 * t);
  const double sp = std::sin(phi), cp = std::cos(phi), st = std::sin(theta), ct = std::cos(theta);
  const double p = dphi - dpsi * st, q = dtheta * cp + dpsi * sp * ct,
               r = dpsi * cp * ct - dtheta * sp;
  return {{1000, u, v, w, phi, theta, psi},
          {du - r * v + q * w + kGravity * st, dv - p * w + r * u - kGravity * sp * ct,
           dw - q * u + p * v - kGravity * cp * ct, p, q, r}};
}

// Fourteen states: motion, six inertial biases, upwash; height, attitude, airspeed, two vanes.
// Sources of the form: van den Hoek 2017, Eq. (3) to (6).
template <class T>
alula::PathModel<T> fourteen_states() {
  alula::PathModel<T> model;
  model.states = 14;
  model.dynamic = 13;
  for (int i = 0; i < 6; ++i) {
    model.slot[alula::kBiasAx + i] = 7 + i;
    model.input_sigma[i] = i < 3 ? T(0.02) : T(0.0005);
    model.walk[7 + i] = T(1e-5);
  }
  model.walk[13] = T(1e-5);
  using alula::Quantity;
  const Quantity quantities[] = {Quantity::height,    Quantity::phi,      Quantity::theta,
                                 Quantity::psi,       Quantity::airspeed, Quantity::alpha_linear,
                                 Quantity::beta_flank};
  const double sigma[] = {2, 0.002, 0.002, 0.005, 0.2, 0.002, 0.002};
  for (int s = 0; s < 7; ++s) {
    alula::PathSensor<T> sensor;
    sensor.quantity = quantities[s];
    sensor.variance = static_cast<T>(sigma[s] * sigma[s]);
    if (s >= 5) sensor.position[0] = T(5);
    if (s == 5) sensor.scale_slot = 13;
    model.sensors.push(sensor);
  }
  return model;
}

template <class T>
struct Flight {
  std::vector<T> t, inputs, readings, initial;
  std::vector<int> start;

  alula::PathRecord<T> record() const {
    return {static_cast<int>(t.size()),
            t.data(),
            inputs.data(),
            readings.data(),
            start.data(),
            initial.data()};
  }
};

// `samples` at 100 Hz with input biases, noise and holes as the model's sensors say.
template <class T>
Flight<T> flight(const alula::PathModel<T>& model, int samples, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Flight<T> f;
  const double dt = 0.01, bias[6] = {0.05, -0.03, 0.04, 1e-3, -8e-4, 6e-4};
  double height = 1000;
  for (int k = 0; k < samples; ++k) {
    Motion motion = motion_at(k * dt);
    const double climb =
        motion.y[1] * std::sin(motion.y[5]) -
        (motion.y[2] * std::sin(motion.y[4]) + motion.y[3] * std::cos(motion.y[4])) *
            std::cos(motion.y[5]);
    motion.y[0] = height;
    height += climb * dt;
    f.t.push_back(static_cast<T>(k * dt));
    f.start.push_back(k == 0 ? 0 : -1);
    T truth[alula::kMaxStates] = {}, m[6], wind[3] = {};
    for (int i = 0; i < 7; ++i) truth[i] = static_cast<T>(motion.y[i]);
    for (int i = 0; i < 6; ++i) {
      m[i] = static_cast<T>(motion.m[i]);
      f.inputs.push_back(static_cast<T>(
          motion.m[i] + bias[i] + static_cast<double>(model.input_sigma[i]) * normal(random)));
    }
    const auto air = alula::path_air(model, truth, wind, m);
    for (int s = 0; s < model.sensors.size(); ++s) {
      const double noise = std::sqrt(double(model.sensors[s].variance)) * normal(random);
      const bool hole = s == 0 && k % 10 != 0;  // the barometer at 10 Hz
      f.readings.push_back(
          hole ? std::numeric_limits<T>::quiet_NaN()
               : static_cast<T>(double(alula::path_output(model.sensors[s], truth, air)) + noise));
    }
  }
  const Motion first = motion_at(0);
  const double spread[7] = {10, 2, 2, 2, 0.02, 0.02, 0.02};
  for (int i = 0; i < 7; ++i) f.initial.push_back(static_cast<T>(first.y[i]));
  for (int i = 0; i < 7; ++i) f.initial.push_back(static_cast<T>(spread[i]));
  return f;
}

// Prior of the constants of `fourteen_states`.
template <class Filter>
void set_prior(Filter& filter) {
  for (int i = 7; i < 14; ++i) {
    const double sigma = i < 10 ? 0.1 : i < 13 ? 0.002 : 0.2;
    filter.x[i] = 0;
    filter.P[i][i] = static_cast<std::remove_reference_t<decltype(filter.x[0])>>(sigma * sigma);
  }
}

}  // namespace alula_test
