#pragma once
// A filter over a whole record, and the Rauch-Tung-Striebel smoother back over it.
// Storage is the caller's; nothing is allocated. Rauch, Tung, Striebel 1965.
#include <alula/filters/path_jacobians.hpp>
#include <alula/math/cholesky.hpp>

namespace alula {

// One or more maneuvers, end to end. Where `start[k]` is not negative a maneuver begins: the
// motion states are set anew from row start[k] of `initial`, the constants carry on.
template <class T>
struct PathRecord {
  int samples = 0;
  const T* t = nullptr;         // (samples) s
  const T* inputs = nullptr;    // (samples, 6) specific force, rates
  const T* readings = nullptr;  // (samples, sensors), NaN where there is none
  const int* start = nullptr;   // (samples) row of `initial`, or -1
  const T* initial = nullptr;   // (maneuvers, 2 * motion) values, then standard deviations
};

// Per sample: state, packed upper covariance, innovations, their standard deviations, and the
// normalized innovation squared; any pointer may be null.
template <class T>
struct PathHistory {
  T* x = nullptr;
  T* covariance = nullptr;  // n (n + 1)/2 a sample
  T* innovation = nullptr;
  T* deviation = nullptr;
  T* nis = nullptr;
};

// False where no covariance can be made of it.
template <class Filter, class T>
inline bool restart(Filter& filter, const PathModel<T>& model, const T* initial) {
  const int n = model.states, motion = model.motion;
  for (int i = 0; i < motion; ++i) {
    filter.x[i] = initial[i];
    for (int j = 0; j < n; ++j) filter.P[i][j] = filter.P[j][i] = T(0);
    filter.P[i][i] = initial[motion + i] * initial[motion + i];
  }
  return filter.adopt(n);
}

template <int R, class T>
inline void pack(const T (*P)[R], int n, T* packed) {
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) *packed++ = P[i][j];
}

template <int R, class T>
inline void unpack(const T* packed, int n, T (*P)[R]) {
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) P[i][j] = P[j][i] = *packed++;
}

// Forward over the record. filter.x and filter.P hold the constants' prior. Returns the number of
// samples done: fewer than the record's where the filter lost its covariance.
template <class Filter, class T>
int run_filter(Filter& filter, const PathModel<T>& model, const PathRecord<T>& record,
               const PathHistory<T>& history) {
  const int n = model.states, ny = model.sensors.size();
  T innovation[kMaxOutputs], deviation[kMaxOutputs];
  for (int k = 0; k < record.samples; ++k) {
    const T* u = record.inputs + k * kInertialInputs;
    if (record.start[k] >= 0) {
      if (!restart(filter, model, record.initial + record.start[k] * 2 * model.motion)) return k;
    } else if (!filter.predict(model, u - kInertialInputs, u, record.t[k] - record.t[k - 1])) {
      return k;
    }
    if (filter.update(model, u, record.readings + k * ny, innovation, deviation) < 0) return k;
    if (history.x)
      for (int i = 0; i < n; ++i) history.x[k * n + i] = filter.x[i];
    if (history.covariance)
      pack<Filter::kRow>(filter.P, n, history.covariance + k * (n * (n + 1) / 2));
    T nis = T(0);
    for (int s = 0; s < ny; ++s) {
      if (history.innovation) history.innovation[k * ny + s] = innovation[s];
      if (history.deviation) history.deviation[k * ny + s] = deviation[s];
      if (std::isfinite(deviation[s]))
        nis += (innovation[s] / deviation[s]) * (innovation[s] / deviation[s]);
    }
    if (history.nis) history.nis[k] = nis;
  }
  return record.samples;
}

// One step back. before, x_predicted, P_predicted (upper): covariance before a step, state and
// covariance after it; x_later, later: after it given the whole record; C: covariance of the state
// before with the one after, becomes the gain. x and packed covariance become those given all.
template <int R, class T>
bool smooth_step(int n, const T (*before)[R], const T* x_predicted, const T (*P_predicted)[R],
                 const T* x_later, const T (*later)[R], T (*C)[R], T* x, T* packed) {
  T U[R][R], change[R][R] = {}, GD[R][R];
  if (cholesky<R>(P_predicted, U, n) < 0) return false;
  for (int i = 0; i < n; ++i) {
    solve<R>(U, C[i], n);
    for (int j = i; j < n; ++j) change[i][j] = change[j][i] = later[i][j] - P_predicted[i][j];
  }
  for (int i = 0; i < n; ++i) {
    T s = T(0);
    for (int j = 0; j < n; ++j) s += C[i][j] * (x_later[j] - x_predicted[j]);
    x[i] += s;
    clear<R>(GD[i]);
    for (int m = 0; m < n; ++m) add_scaled<R>(GD[i], C[i][m], change[m]);
  }
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) {
      T s = before[i][j];
      for (int m = 0; m < n; ++m) s += GD[i][m] * C[j][m];
      *packed++ = s;
    }
  return true;
}

template <class Filter, class T>
int smooth_back(Filter& filter, const PathModel<T>& model, const PathRecord<T>& record,
                const PathHistory<T>& history) {
  const int n = model.states, packed = n * (n + 1) / 2;
  constexpr int R = Filter::kRow;
  T before[R][R], later[R][R], C[R][R];
  for (int k = record.samples - 1; k > 0; --k) {
    T* x = history.x + (k - 1) * n;
    T* p = history.covariance + (k - 1) * packed;
    const T* u = record.inputs + k * kInertialInputs;
    unpack<R>(p, n, before);
    unpack<R>(history.covariance + k * packed, n, later);
    for (int i = 0; i < n; ++i) {
      filter.x[i] = x[i];
      for (int j = 0; j < n; ++j) filter.P[i][j] = before[i][j];
    }
    if (record.start[k] >= 0) {
      // Only the constants connect two maneuvers.
      restart(filter, model, record.initial + record.start[k] * 2 * model.motion);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) C[i][j] = j < model.motion ? T(0) : before[i][j];
    } else {
      if (!filter.predict(model, u - kInertialInputs, u, record.t[k] - record.t[k - 1])) return k;
      filter.cross(model, before, C);
    }
    if (!smooth_step<R>(n, before, filter.x, filter.P, history.x + k * n, later, C, x, p)) return k;
  }
  return 0;
}

// Backward over a finished history: x and covariance become those given the whole record.
// Returns the first sample that was reached: 0 where all went well. Filters that differ in their
// update alone share one smoother.
template <class Filter, class T>
int run_smoother(Filter& filter, const PathModel<T>& model, const PathRecord<T>& record,
                 const PathHistory<T>& history) {
  return smooth_back<typename Filter::Predictor>(filter, model, record, history);
}

// Open loop: the kinematics integrated from state x0 (states) with constants as they are, no
// measurement used. `held` (samples, motion) may give motion states that are taken as measured
// instead of integrated; NaN where a state is free, null where all are. Writes motion (samples,
// motion), readings (samples, sensors) and, where the pointers are set, their exact Jacobians with
// respect to x0: motion_jacobian (samples, motion, states) and readings_jacobian (samples, sensors,
// states). This is the model of the maximum-likelihood form, and its sensitivities. Dittrich 2016,
// Eq. (3.62), variational.
template <class T>
void run_open_loop(const PathModel<T>& model, const T* t, const T* inputs, int samples, const T* x0,
                   const T* held, T* motion, T* readings, T* motion_jacobian,
                   T* readings_jacobian) {
  const int n = model.states, ny = model.sensors.size(), nm = model.motion;
  constexpr int R = kLongRow;
  T x[R], z[kMaxOutputs], F[kMotionStatesWithPosition][R], H[kMaxOutputs][R];
  T J[kMotionStatesWithPosition][R] = {}, next[kMotionStatesWithPosition][R];
  for (int i = 0; i < n; ++i) x[i] = x0[i];
  for (int i = 0; i < nm; ++i) J[i][i] = T(1);
  for (int k = 0; k < samples; ++k) {
    if (k > 0) {
      const T* u = inputs + k * kInertialInputs;
      const T dt = t[k] - t[k - 1];
      if (nm == kMotionStates)
        path_step_jacobian<kMotionStates, R>(model, x, u - kInertialInputs, u, dt, F);
      else
        path_step_jacobian<kMotionStatesWithPosition, R>(model, x, u - kInertialInputs, u, dt, F);
      for (int i = 0; i < nm; ++i) {
        for (int j = 0; j < n; ++j) next[i][j] = j < nm ? T(0) : F[i][j];
        for (int s = 0; s < nm; ++s)
          for (int j = 0; j < n; ++j) next[i][j] += F[i][s] * J[s][j];
      }
      for (int i = 0; i < nm; ++i)
        for (int j = 0; j < n; ++j) J[i][j] = next[i][j];
    }
    for (int i = 0; held && i < nm; ++i)
      if (std::isfinite(held[k * nm + i])) {
        x[i] = held[k * nm + i];
        for (int j = 0; j < n; ++j) J[i][j] = T(0);
      }
    path_outputs_jacobian<R>(model, x, inputs + k * kInertialInputs, z, H);
    for (int i = 0; i < nm; ++i) {
      motion[k * nm + i] = x[i];
      if (motion_jacobian)
        for (int j = 0; j < n; ++j) motion_jacobian[(k * nm + i) * n + j] = J[i][j];
    }
    for (int s = 0; s < ny; ++s) {
      readings[k * ny + s] = z[s];
      if (!readings_jacobian) continue;
      T* row = readings_jacobian + (k * ny + s) * n;
      for (int j = 0; j < n; ++j) row[j] = j < nm ? T(0) : H[s][j];
      for (int i = 0; i < nm; ++i)
        if (H[s][i] != T(0))
          for (int j = 0; j < n; ++j) row[j] += H[s][i] * J[i][j];
    }
  }
}

}  // namespace alula
