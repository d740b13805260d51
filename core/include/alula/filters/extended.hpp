#pragma once
// Extended Kalman filter for flight path reconstruction: exact Jacobian of the RK4 step and of the
// outputs by dual numbers, readings taken up one after another with the Jacobian of the prediction
// (which equals the batch update). Source: Dittrich 2016, Eq. (3.22) to (3.26).
#include <alula/filters/path_model.hpp>
#include <alula/math/cholesky.hpp>

namespace alula {

template <class T>
class Extended {
 public:
  static constexpr int ld = kMaxStates;

  T x[kMaxStates] = {};
  T P[kMaxStates][kMaxStates] = {};  // full, symmetric
  int repairs = 0;

  bool predict(const PathModel<T>& model, const T* u0, const T* u1, T dt) {
    return model.motion == kMotionStates
               ? predict<kMotionStates>(model, u0, u1, dt)
               : predict<kMotionStatesWithPosition>(model, u0, u1, dt);
  }

  // As Unscented::update.
  int update(const PathModel<T>& model, const T* u, const T* z, T* innovation, T* deviation);

  // C = P F' with the F of the last prediction.
  void cross(const PathModel<T>& model, const T (*before)[kMaxStates], T (*C)[kMaxStates]) const {
    const int n = model.states;
    for (int i = 0; i < n; ++i) {
      for (int m = 0; m < model.motion; ++m) {
        T s = T(0);
        for (int j = 0; j < n; ++j) s += (i < j ? before[i][j] : before[j][i]) * F_[m][j];
        C[i][m] = s;
      }
      for (int c = model.motion; c < n; ++c) C[i][c] = i < c ? before[i][c] : before[c][i];
    }
  }

 private:
  T F_[kMotionStatesWithPosition][kMaxStates];
  T H_[kMaxOutputs][kMaxStates];

  template <int N>
  bool predict(const PathModel<T>& model, const T* u0, const T* u1, T dt) {
    const int n = model.states;
    T Q[kMotionStates][kMotionStates];
    path_input_noise(model, x, dt, Q);
    path_step_jacobian<N>(model, x, u0, u1, dt, F_);
    T FP[N][kMaxStates];
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < n; ++j) FP[i][j] = T(0);
      for (int s = 0; s < model.dynamic; ++s) {
        const T f = F_[i][s];
        for (int j = 0; j < n; ++j) FP[i][j] += f * P[s][j];
      }
    }
    for (int i = 0; i < N; ++i) {
      for (int j = i; j < N; ++j) {
        T s = j < kMotionStates ? Q[i][j] : T(0);
        for (int k = 0; k < model.dynamic; ++k) s += FP[i][k] * F_[j][k];
        P[i][j] = P[j][i] = s;
      }
      for (int c = N; c < n; ++c) P[i][c] = P[c][i] = FP[i][c];
      if (!(std::abs(x[i]) < T(1e30))) return false;
    }
    for (int c = N; c < n; ++c) P[c][c] += dt * model.walk[c] * model.walk[c];
    return true;
  }

  bool repair(int n) {
    T U[kMaxStates][kMaxStates];
    const T floor = sizeof(T) == 8 ? T(1e-14) : T(1e-6);
    const int raised = cholesky(&P[0][0], &U[0][0], n, ld, floor);
    if (raised < 0) return false;
    if (raised == 0) return true;
    repairs += raised;
    multiply_back(&U[0][0], &P[0][0], n, ld);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < i; ++j) P[i][j] = P[j][i];
    return true;
  }
};

template <class T>
int Extended<T>::update(const PathModel<T>& model, const T* u, const T* z, T* innovation,
                        T* deviation) {
  const int n = model.states;
  T predicted[kMaxOutputs], step[kMaxStates] = {}, PH[kMaxStates], M[kMaxStates][kMaxStates];
  int used = 0;
  bool close = false;
  path_outputs_jacobian(model, x, u, predicted, H_);
  for (int s = 0; s < model.sensors.size(); ++s) {
    innovation[s] = deviation[s] = T(0) / T(0);
    if (!std::isfinite(z[s])) continue;
    const T* h = H_[s];
    const T variance = model.sensors[s].variance;
    for (int i = 0; i < n; ++i) PH[i] = T(0);
    T e = wrapped(model.sensors[s].quantity, z[s] - predicted[s]);
    for (int j = 0; j < n; ++j) {
      if (h[j] == T(0)) continue;
      e -= h[j] * step[j];
      const T f = h[j];
      for (int i = 0; i < n; ++i) PH[i] += f * P[j][i];
    }
    T total = variance;
    for (int j = 0; j < n; ++j) total += h[j] * PH[j];
    if (!(total > T(0)) || !(total < T(1e30))) return -1;
    const T inverse = T(1) / total;
    if (variance > T(1e-6) * total) {
      for (int i = 0; i < n; ++i) {
        const T gain = PH[i] * inverse;
        step[i] += gain * e;
        for (int j = 0; j < n; ++j) P[i][j] -= gain * PH[j];
      }
    } else {
      // The plain form would cancel more than six digits: Joseph's form (I-KH) P (I-KH)' + K R K'.
      close = true;
      for (int i = 0; i < n; ++i) {
        const T gain = PH[i] * inverse;
        step[i] += gain * e;
        for (int j = 0; j < n; ++j) M[i][j] = P[i][j] - gain * PH[j];
      }
      for (int i = 0; i < n; ++i) {
        T mh = T(0);
        for (int j = 0; j < n; ++j) mh += M[i][j] * h[j];
        const T f = (variance * PH[i] * inverse - mh) * inverse;
        for (int j = 0; j < n; ++j) P[i][j] = M[i][j] + f * PH[j];
      }
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j) P[i][j] = P[j][i] = T(0.5) * (P[i][j] + P[j][i]);
    }
    innovation[s] = e;
    deviation[s] = std::sqrt(total);
    ++used;
  }
  for (int i = 0; i < n; ++i) {
    x[i] += step[i];
    close = close || !(P[i][i] > T(0));
  }
  return close && !repair(n) ? -1 : used;
}

}  // namespace alula
