#pragma once
// Exact derivatives of the flight path reconstruction's readings and steps, and the noise that its
// inputs bring. Source: as path_model.hpp.
#include <alula/filters/path_model.hpp>
#include <alula/motion/point_jacobian.hpp>

namespace alula {

// The readings of all sensors with their exact Jacobian H (sensors x states) at state x.
// Directions: u v w phi theta psi, p q r, wind; scale and bias enter linearly.
template <int R, class T>
inline void path_outputs_jacobian(const PathModel<T>& model, const T* x, const T* measured, T* z,
                                  T (*H)[R]) {
  using D = Dual<T, 12>;
  T m[kInertialInputs];
  true_inputs(model, x, measured, m);
  D y[kMotionStatesWithPosition], rates[kInertialInputs], wind[3];
  y[kHeight] = D(x[kHeight]);
  for (int i = 0; i < 6; ++i) y[kU + i] = D::variable(x[kU + i], i);
  for (int i = kMotionStates; i < model.motion; ++i) y[i] = D(x[i]);
  for (int i = 3; i < 6; ++i) rates[i] = D::variable(m[i], 3 + i);
  for (int i = 0; i < 3; ++i) wind[i] = D::variable(unknown(model, x, kWindNorth + i), 9 + i);
  const PathAir<D> air = path_air(model, y, wind, rates);

  T gain[3];
  for (int j = 0; j < 3; ++j) gain[j] = T(1) / (T(1) + unknown(model, x, kScaleP + j));
  for (int s = 0; s < model.sensors.size(); ++s) {
    const PathSensor<T>& sensor = model.sensors[s];
    T* h = H[s];
    clear<R>(h);
    if (const int state = plain_state(sensor); state >= 0) {
      z[s] = x[state];
      h[state] = T(1);
      continue;
    }
    D induced;
    const D quantity = path_quantity(sensor, y, air, induced);
    const T scale = sensor.scale_slot >= 0 ? x[sensor.scale_slot] : sensor.scale;
    const T bias = sensor.bias_slot >= 0 ? x[sensor.bias_slot] : sensor.bias;
    const T change = quantity.value - sensor.reference;
    z[s] = quantity.value + scale * change + induced.value + bias;
    const D total = quantity * (T(1) + scale) + induced;
    T slope[12];
    for (int j = 0; j < 12; ++j) slope[j] = total.slope_of(j);
    for (int j = 0; j < 6; ++j) h[kU + j] = slope[j];
    if (sensor.quantity == Quantity::height) h[kHeight] = T(1) + scale;
    if (sensor.quantity == Quantity::north) h[kNorth] = T(1) + scale;
    if (sensor.quantity == Quantity::east) h[kEast] = T(1) + scale;
    for (int j = 0; j < 3; ++j) {  // m = (measured - bias)/(1 + e): dm/dbias, dm/de
      const T rate = -gain[j] * slope[6 + j];
      if (model.slot[kBiasP + j] >= 0) h[model.slot[kBiasP + j]] = rate;
      if (model.slot[kScaleP + j] >= 0) h[model.slot[kScaleP + j]] = rate * m[3 + j];
      if (model.slot[kWindNorth + j] >= 0) h[model.slot[kWindNorth + j]] = slope[9 + j];
    }
    if (sensor.scale_slot >= 0) h[sensor.scale_slot] = change;
    if (sensor.bias_slot >= 0) h[sensor.bias_slot] = T(1);
  }
}

// The step of the motion states under measured inputs with its Jacobian F (motion x states).
template <int N, int R, class T>
inline void path_step_jacobian(const PathModel<T>& model, T* x, const T* u0, const T* u1, T dt,
                               T (*F)[R]) {
  T m0[kInertialInputs], m1[kInertialInputs], A[N][N], B[N][kInertialInputs];
  true_inputs(model, x, u0, m0);
  true_inputs(model, x, u1, m1);
  point_step_jacobian<N>(x, m0, m1, model.gravity, dt, A, B);
  for (int i = 0; i < N; ++i) {
    clear<R>(F[i]);
    for (int j = 0; j < N; ++j) F[i][j] = A[i][j];
  }
  for (int k = 0; k < kInertialInputs; ++k) {
    const T gain = T(1) / (T(1) + unknown(model, x, kScaleAx + k));
    const int bias = model.slot[kBiasAx + k], scale = model.slot[kScaleAx + k];
    // The two ends carry different readings; taking their mean leaves out (m1 - m0) dt^2 / 12
    // times second derivatives, which sums to next to nothing over a record.
    const T middle = T(0.5) * (m0[k] + m1[k]);
    if (bias >= 0)
      for (int i = 0; i < N; ++i) F[i][bias] = -gain * B[i][k];
    if (scale >= 0)
      for (int i = 0; i < N; ++i) F[i][scale] = -gain * middle * B[i][k];
  }
}

// G (motion x inputs): what one standard deviation of each input does in one step at x. Van den
// Hoek 2017, Eq. (2).
template <class T>
inline void path_input_gain(const PathModel<T>& model, const T* x, T dt, T (*G)[kInertialInputs]) {
  point_input_gain(x, G);
  for (int i = 0; i < kMotionStates; ++i)
    for (int j = 0; j < kInertialInputs; ++j) G[i][j] *= dt * model.input_sigma[j];
}

// Q = G G' (motion x motion, upper) of one step.
template <class T>
inline void path_input_noise(const PathModel<T>& model, const T* x, T dt, T (*Q)[kMotionStates]) {
  T G[kMotionStates][kInertialInputs];
  path_input_gain(model, x, dt, G);
  for (int i = 0; i < kMotionStates; ++i)
    for (int j = i; j < kMotionStates; ++j) {
      T s = T(0);
      for (int k = 0; k < kInertialInputs; ++k) s += G[i][k] * G[j][k];
      Q[i][j] = s;
    }
}

}  // namespace alula
