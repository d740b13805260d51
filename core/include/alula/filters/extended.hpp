#pragma once
// Extended Kalman filter for flight path reconstruction: exact Jacobian of the RK4 step by the
// variational equations and of the outputs by dual numbers, readings taken up one after another
// with the Jacobian of the prediction (which equals the batch update). Source: Dittrich 2016, Eq.
// (3.22) to (3.26).
#include <alula/filters/careful_update.hpp>
#include <alula/filters/path_jacobians.hpp>
#include <alula/math/cholesky.hpp>
#include <limits>

namespace alula {

template <class T, int R>
class Extended {
 public:
  static constexpr int kRow = R;
  using Predictor = Extended;  // what the smoother asks

  T x[R] = {};
  alignas(64) T P[R][R] = {};  // full, symmetric
  int repairs = 0;

  bool predict(const PathModel<T>& model, const T* u0, const T* u1, T dt) {
    return by_motion<R>(
        model, [&](auto motion) { return predict<decltype(motion)::value>(model, u0, u1, dt); });
  }

  // As in Unscented.
  bool adopt(int) { return true; }
  int update(const PathModel<T>& model, const T* u, const T* z, T* innovation, T* deviation);

  // C = P F' with the F of the last prediction.
  void cross(const PathModel<T>& model, const T (*before)[R], T (*C)[R]) const {
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

 protected:
  T H_[kMaxOutputs][R];

  // The readings z taken up where they are linear about x: predicted + H_ (state - x). P becomes
  // that after the update; `step` is the state's. Returns as `update`.
  int take_up(const PathModel<T>& model, const T* z, const T* predicted, T* step, T* innovation,
              T* deviation);

 private:
  T F_[kMotionStatesWithPosition][R];
  // Some direction has become sharper than the rest by half of all digits: from here on rounding
  // can make P indefinite, and every update looks.
  bool delicate_ = false;

  int take_up_carefully(const PathModel<T>& model, const T* z, const T* predicted, T* step,
                        T* innovation, T* deviation);

  template <int N>
  bool predict(const PathModel<T>& model, const T* u0, const T* u1, T dt) {
    const int n = model.states;
    T Q[kMotionStates][kMotionStates];
    path_input_noise(model, x, dt, Q);
    path_step_jacobian<N, R>(model, x, u0, u1, dt, F_);
    T FP[N][R], transposed[R][kShortRow];
    for (int k = 0; k < model.dynamic; ++k) {
      clear<kShortRow>(transposed[k]);
      for (int j = 0; j < N; ++j) transposed[k][j] = F_[j][k];
    }
    for (int i = 0; i < N; ++i) {
      clear<R>(FP[i]);
      add_rows<R>(FP[i], F_[i], P, model.dynamic);
    }
    for (int i = 0; i < N; ++i) {
      T row[kShortRow] = {};
      if (i < kMotionStates)
        for (int j = i; j < kMotionStates; ++j) row[j] = Q[i][j];
      add_rows<kShortRow>(row, FP[i], transposed, model.dynamic);
      for (int j = i; j < N; ++j) P[i][j] = P[j][i] = row[j];
      for (int c = N; c < n; ++c) P[i][c] = P[c][i] = FP[i][c];
      if (!(std::abs(x[i]) < T(1e30))) return false;
    }
    for (int c = N; c < n; ++c) P[c][c] += dt * model.walk[c] * model.walk[c];
    return true;
  }

  bool repair(int n) {
    T U[R][R];
    const int raised = cholesky<R>(P, U, n);
    if (raised > 0) multiply_back<R>(U, P, n);
    for (int i = 0; i < n; ++i) P[i][i] *= kHeldApart<T>;
    repairs += raised > 0 ? raised : 0;
    return raised >= 0;
  }
};

template <class T, int R>
int Extended<T, R>::update(const PathModel<T>& model, const T* u, const T* z, T* innovation,
                           T* deviation) {
  T predicted[kMaxOutputs], step[R];
  path_outputs_jacobian<R>(model, x, u, predicted, H_);
  const int used = take_up(model, z, predicted, step, innovation, deviation);
  for (int i = 0; i < model.states; ++i) x[i] += step[i];
  return used;
}

template <class T, int R>
int Extended<T, R>::take_up(const PathModel<T>& model, const T* z, const T* predicted, T* step,
                            T* innovation, T* deviation) {
  const int n = model.states;
  // Covariances of state and readings, given the readings before; the gains, negative.
  T PH[kMaxOutputs][R], K[kMaxOutputs][R];
  int used = 0;
  clear<R>(step);
  for (int s = 0; s < model.sensors.size(); ++s) {
    innovation[s] = deviation[s] = std::numeric_limits<T>::quiet_NaN();
    if (!std::isfinite(z[s])) continue;
    const T* h = H_[s];
    int at[R], count = 0;          // where h is not zero
    for (int j = 0; j < n; ++j) {  // no branch: which are, no processor can guess
      at[count] = j;
      count += h[j] != T(0);
    }
    const auto times = [&](const T* row) {
      T sum = T(0);
      for (int k = 0; k < count; ++k) sum += h[at[k]] * row[at[k]];
      return sum;
    };
    T known[kMaxOutputs];
    clear<R>(PH[used]);
    for (int k = 0; k < count; ++k) add_scaled<R>(PH[used], h[at[k]], P[at[k]]);
    for (int t = 0; t < used; ++t) known[t] = times(K[t]);
    add_rows<R>(PH[used], known, PH, used);
    const T variance = model.sensors[s].variance, total = variance + times(PH[used]);
    // Here subtracting from P would cancel more than six digits.
    if (!(variance > T(1e-6) * total))
      return take_up_carefully(model, z, predicted, step, innovation, deviation);
    const T e = wrapped(model.sensors[s].quantity, z[s] - predicted[s]) - times(step);
    scale<R>(K[used], T(-1) / total, PH[used]);
    add_scaled<R>(step, -e, K[used]);
    innovation[s] = e;
    deviation[s] = std::sqrt(total);
    ++used;
  }
  for (int i = 0; i < n; ++i) add_rows<R>(P[i], &K[0][i], PH, used, R);
  bool positive = !delicate_;
  for (int i = 0; i < n; ++i) positive = positive && P[i][i] > T(0);
  return positive || repair(n) ? used : -1;
}

template <class T, int R>
int Extended<T, R>::take_up_carefully(const PathModel<T>& model, const T* z, const T* predicted,
                                      T* step, T* innovation, T* deviation) {
  constexpr int kColumns = R + kMaxOutputs;
  const int n = model.states;
  T X[R][kColumns], Y[kMaxOutputs][kColumns], U[R][R], variance[kMaxOutputs], e[kMaxOutputs],
      d[kMaxOutputs];
  int present[kMaxOutputs], ny = 0;
  delicate_ = true;
  const int raised = cholesky<R>(P, U, n);
  if (raised < 0) return -1;
  repairs += raised;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) X[i][k] = U[k][i];
  for (int s = 0; s < model.sensors.size(); ++s) {
    innovation[s] = deviation[s] = std::numeric_limits<T>::quiet_NaN();
    if (!std::isfinite(z[s])) continue;
    for (int k = 0; k < n; ++k) {
      Y[ny][k] = T(0);
      for (int j = k; j < n; ++j) Y[ny][k] += H_[s][j] * U[k][j];
    }
    variance[ny] = model.sensors[s].variance;
    e[ny] = wrapped(model.sensors[s].quantity, z[s] - predicted[s]);
    present[ny++] = s;
  }
  if (!careful_update(X, n, Y, ny, n, variance, e, step, d)) return -1;
  covariance_of<R>(X, n, n + ny, P);
  for (int s = 0; s < ny; ++s) {
    innovation[present[s]] = e[s];
    deviation[present[s]] = d[s];
  }
  return repair(n) ? ny : -1;
}

}  // namespace alula
