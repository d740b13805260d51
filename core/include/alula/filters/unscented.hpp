#pragma once
// Unscented Kalman filter for flight path reconstruction; sigma points lie side by side in lanes.
// Additive noise, points drawn anew after the prediction so that the update sees process noise.
// Source: van den Hoek 2017, Eq. (10) to (21); center weights as Julier and Uhlmann 2004,
// covariances about the predicted means.
#include <alula/filters/careful_update.hpp>
#include <alula/filters/path_jacobians.hpp>
#include <alula/filters/sigma_points.hpp>
#include <alula/math/cholesky.hpp>
#include <limits>

namespace alula {

template <class T, int R>
class Unscented {
 public:
  static constexpr int kRow = R;
  using Predictor = Unscented;  // what the smoother asks
  static constexpr int W = kLanes;
  using L = Lanes<T, W>;

  T x[R] = {};
  alignas(64) T P[R][R] = {};  // upper triangle; the lower one is scratch
  int repairs = 0;             // pivots raised since the start

  // Scaled transform with alpha 1, beta 2, kappa 0: no negative weight, spread sqrt(n).
  // False where the covariance or a point is no longer finite.
  bool predict(const PathModel<T>& model, const T* u0, const T* u1, T dt) {
    T Q[kMotionStates][kMotionStates];
    path_input_noise(model, x, dt, Q);
    if (!factor(model)) return false;
    return by_motion<R>(
        model, [&](auto motion) { return predict<decltype(motion)::value>(model, u0, u1, dt, Q); });
  }

  // P was written from outside. False where it is no covariance.
  bool adopt(int) { return true; }

  // Takes up the readings z that are numbers; NaN means 'no sample'. Writes each one's innovation
  // given those before it, and its standard deviation. Returns how many were used, -1 on failure.
  int update(const PathModel<T>& model, const T* u, const T* z, T* innovation, T* deviation);

  // C = covariance of the state before the last prediction with the one after it (n x n).
  void cross(const PathModel<T>& model, const T (*before)[R], T (*C)[R]) const {
    const int n = model.states;
    for (int i = 0; i < n; ++i) {
      for (int m = 0; m < model.motion; ++m) {
        T s = T(0);
        for (int j = 0; j <= i; ++j) s += U_[j][i] * D_[m][j];
        C[i][m] = s;
      }
      for (int c = model.motion; c < n; ++c) C[i][c] = before[i][c];
    }
  }

 protected:
  // One slot for each point along the columns of the lower factor, first on the plus side, then on
  // the minus side; the slots from n on repeat the mean. X_: motion states, Y_: readings.
  alignas(64) T X_[kMotionStatesWithPosition][2 * R];
  alignas(64) T Y_[kMaxOutputs][2 * R];
  alignas(64) T U_[R][R];                          // U'U = P before the last prediction or update
  alignas(64) T spread_[R][R] = {};                // sqrt(n) times the lower factor, row by row
  alignas(64) T D_[kMotionStatesWithPosition][R];  // weighted differences of opposite points
  alignas(64) T C_[kMaxOutputs][R];
  alignas(64) T DY_[kMaxOutputs][R];  // as D_, of the readings

  // A standard deviation that means 'unknown' is taken as `most`, correlations kept: points
  // farther out leave the range where the equations of motion, stepped, mean anything.
  void bound(int i, int n, T most) {
    if (!(P[i][i] > most * most)) return;
    const T f = most / std::sqrt(P[i][i]);
    for (int j = 0; j < i; ++j) P[j][i] *= f;
    for (int j = i + 1; j < n; ++j) P[i][j] *= f;
    P[i][i] = most * most;
    ++repairs;
  }
  template <class Bound>
  static void each_bound(const PathModel<T>& model, Bound bound) {
    bound(kPhi, T(1));
    bound(kTheta, T(0.4));
    bound(kPsi, T(1));
    for (int k = kBiasP; k <= kScaleR; ++k)
      if (model.slot[k] >= 0) bound(model.slot[k], k <= kBiasR ? T(1) : T(0.2));
  }

  // Factor of P and the points' deviations from the mean.
  bool factor(const PathModel<T>& model) {
    const int n = model.states;
    each_bound(model, [&](int i, T most) { bound(i, n, most); });
    const int raised = cholesky<R>(P, U_, n);
    if (raised < 0) return false;
    if (raised > 0) {
      repairs += raised;
      multiply_back<R>(U_, P, n);
    }
    const T root = std::sqrt(T(n));
    for (int j = 0; j < n; ++j)
      for (int i = j; i < n; ++i) spread_[i][j] = root * U_[j][i];
    return true;
  }

  // The points through the step: x becomes their mean, X_ their deviations from it, `middle` (N)
  // that of the mean point. False where one is no longer finite.
  template <int N>
  bool propagate(const PathModel<T>& model, const T* u0, const T* u1, T dt, T* middle);

  // The readings z that are there, at the points.
  struct Sensed {
    int present[kMaxOutputs], count = 0;
    T e[kMaxOutputs];               // innovations, of the mean
    T middle[kMaxOutputs];          // deviation of the mean point
    T S[kMaxOutputs][kMaxOutputs];  // covariance with noise, upper
    bool close = false;             // subtractions would cancel more than six digits
  };

  // Marks the readings that are there; `count` says how many.
  static void find(const PathModel<T>& model, const T* z, Sensed& sensed, T* innovation,
                   T* deviation) {
    for (int s = 0; s < model.sensors.size(); ++s) {
      innovation[s] = deviation[s] = std::numeric_limits<T>::quiet_NaN();
      if (std::isfinite(z[s])) sensed.present[sensed.count++] = s;
    }
  }

  // Y_, DY_, C_ and the rest of `sensed`, whose readings are found and whose points are drawn.
  void sense(const PathModel<T>& model, const T* u, const T* z, Sensed& sensed);

  // Readings one after another: each is freed from what those before it already told. x takes its
  // share of each; subtract(w) has to take w w' from the covariance and says whether it could.
  template <class Subtract>
  int take_up(Sensed& sensed, T* innovation, T* deviation, Subtract subtract) {
    const int ny = sensed.count;
    for (int s = 0; s < ny; ++s) {
      T(&S)[kMaxOutputs][kMaxOutputs] = sensed.S;
      if (!(S[s][s] > T(0))) return -1;
      const T inverse = T(1) / S[s][s];
      for (int t = s + 1; t < ny; ++t) {
        const T f = S[s][t] * inverse;
        for (int r = t; r < ny; ++r) S[t][r] -= f * S[s][r];
        add_scaled<R>(C_[t], -f, C_[s]);
        sensed.e[t] -= f * sensed.e[s];
      }
      add_scaled<R>(x, sensed.e[s] * inverse, C_[s]);
      innovation[sensed.present[s]] = sensed.e[s];
      deviation[sensed.present[s]] = std::sqrt(S[s][s]);
      if (!subtract(C_[s], inverse)) return -1;
    }
    return ny;
  }

  // Columns of deviations, and room for the readings' noise.
  static constexpr int kColumns = 2 * R + 4 + kMaxOutputs;

  // As take_up, on columns instead of covariances (careful_update.hpp); leaves the deviations of
  // the state after the update in X. Returns how many columns they have, -1 on failure.
  int take_up_carefully(const PathModel<T>& model, Sensed& sensed, T (*X)[kColumns], T* innovation,
                        T* deviation);

 private:
  // The state of the W points from slot b on; sign: which side of the mean.
  void points(int b, T sign, int count, L* state) const {
    for (int i = 0; i < count; ++i) state[i] = L(x[i]) + L(sign) * L::load(&spread_[i][b]);
  }

  template <int N>
  bool predict(const PathModel<T>& model, const T* u0, const T* u1, T dt,
               const T (*Q)[kMotionStates]);
};

template <class T, int R>
template <int N>
bool Unscented<T, R>::propagate(const PathModel<T>& model, const T* u0, const T* u1, T dt,
                                T* middle) {
  const int n = model.states;
  for (int side = 0; side < 2; ++side)
    for (int b = 0; b < n + 1 - side; b += W) {  // the mean point once, on the plus side
      L state[kMaxStates], m0[kInertialInputs], m1[kInertialInputs];
      points(b, side == 0 ? T(1) : T(-1), model.dynamic, state);
      true_inputs(model, state, u0, m0);
      true_inputs(model, state, u1, m1);
      point_step<N>(state, m0, m1, model.gravity, dt);
      for (int i = 0; i < N; ++i) state[i].store(&X_[i][side * R + b]);
    }
  for (int i = 0; i < N; ++i) {
    const T value = X_[i][n];
    for (int b = n; b < R; ++b) X_[i][b] = X_[i][R + b] = value;
    x[i] = center_points<R>(X_[i], value, n, D_[i]);
    middle[i] = value - x[i];
    if (!(std::abs(x[i]) < T(1e30))) return false;
  }
  return true;
}

template <class T, int R>
template <int N>
bool Unscented<T, R>::predict(const PathModel<T>& model, const T* u0, const T* u1, T dt,
                              const T (*Q)[kMotionStates]) {
  const int n = model.states;
  T middle[N];
  if (!propagate<N>(model, u0, u1, dt, middle)) return false;
  for (int i = 0; i < N; ++i) {
    T* row = P[i];
    clear<R>(row);
    add_rows<R, N>(row, D_[i], U_, model.dynamic);
    point_products<R>(X_, i, N, n, middle, row);
    if (i < kMotionStates)
      for (int j = i; j < kMotionStates; ++j) row[j] += Q[i][j];
    // The next points must differ from the mean: no variance below the last digit of the state.
    const T digit = std::numeric_limits<T>::epsilon() * x[i];
    row[i] += digit * digit;
  }
  for (int c = N; c < n; ++c) P[c][c] += dt * model.walk[c] * model.walk[c];
  return true;
}

template <class T, int R>
void Unscented<T, R>::sense(const PathModel<T>& model, const T* u, const T* z, Sensed& sensed) {
  const int n = model.states, ny = sensed.count;
  const int* present = sensed.present;
  int other[kMaxOutputs], others = 0;  // what does not read a state as it is
  for (int s = 0; s < ny; ++s) {
    const int state = plain_state(model.sensors[present[s]]);
    if (state < 0) {
      other[others++] = s;
      continue;
    }
    for (int k = 0; k < R; k += W) {
      const L middle(x[state]), away = L::load(&spread_[state][k]);
      (middle + away).store(&Y_[s][k]);
      (middle - away).store(&Y_[s][R + k]);
    }
  }
  for (int side = 0; others > 0 && side < 2; ++side)
    for (int b = 0; b < n + 1 - side; b += W) {  // the mean point once, on the plus side
      L state[kMaxStates], m[kInertialInputs], wind[3];
      points(b, side == 0 ? T(1) : T(-1), n, state);
      true_inputs(model, state, u, m, 3);
      for (int i = 0; i < 3 && model.wind; ++i) wind[i] = unknown(model, state, kWindNorth + i);
      const PathAir<L> air = path_air(model, state, wind, m);
      for (int i = 0; i < others; ++i)
        path_output(model.sensors[present[other[i]]], state, air)
            .store(&Y_[other[i]][side * R + b]);
    }
  for (int s = 0; s < ny; ++s) {
    const T value = Y_[s][n];
    for (int b = n; b < R; ++b) Y_[s][b] = Y_[s][R + b] = value;
    const T mean = center_points<R>(Y_[s], value, n, DY_[s]);
    sensed.middle[s] = value - mean;
    sensed.e[s] = wrapped(model.sensors[present[s]].quantity, z[present[s]] - mean);
    clear<R>(C_[s]);
    add_rows<R>(C_[s], DY_[s], U_, n);
  }
  for (int s = 0; s < ny; ++s) {
    point_products<R>(Y_, s, ny, n, sensed.middle, sensed.S[s]);
    const T variance = model.sensors[present[s]].variance;
    sensed.close = sensed.close || !(variance > T(1e-6) * sensed.S[s][s]);
    sensed.S[s][s] += variance;
  }
}

template <class T, int R>
int Unscented<T, R>::update(const PathModel<T>& model, const T* u, const T* z, T* innovation,
                            T* deviation) {
  const int n = model.states;
  Sensed sensed;
  find(model, z, sensed, innovation, deviation);
  if (sensed.count == 0) return 0;
  if (!factor(model)) return -1;
  sense(model, u, z, sensed);
  if (sensed.close) {
    T X[R][kColumns];
    const int columns = take_up_carefully(model, sensed, X, innovation, deviation);
    if (columns < 0) return -1;
    covariance_of<R>(X, n, columns, P);
    return sensed.count;
  }
  T K[kMaxOutputs][R];
  int used = 0;
  take_up(sensed, innovation, deviation, [&](const T* w, T inverse) {
    scale<R>(K[used++], -inverse, w);
    return true;
  });
  if (used < sensed.count) return -1;
  for (int i = 0; i < n; ++i) add_rows_from<R>(i, P[i], &K[0][i], C_, used, R);
  return used;
}

template <class T, int R>
int Unscented<T, R>::take_up_carefully(const PathModel<T>& model, Sensed& sensed, T (*X)[kColumns],
                                       T* innovation, T* deviation) {
  // Opposite points, turned by 45 degrees: their differences carry the state, their sums and the
  // mean point only the curvature of the readings.
  const int n = model.states, ny = sensed.count, columns = 2 * n + 1;
  const T half = std::sqrt(T(0.25) / T(n));
  T Y[kMaxOutputs][kColumns], variance[kMaxOutputs], d[kMaxOutputs], step[R];
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < columns; ++k) X[i][k] = k <= i ? U_[k][i] : T(0);
  for (int s = 0; s < ny; ++s) {
    for (int k = 0; k < n; ++k) {
      Y[s][k] = DY_[s][k];
      Y[s][n + k] = half * (Y_[s][k] + Y_[s][R + k]);
    }
    Y[s][2 * n] = std::sqrt(T(2)) * sensed.middle[s];
    variance[s] = model.sensors[sensed.present[s]].variance;
  }
  if (!careful_update(X, n, Y, ny, columns, variance, sensed.e, step, d)) return -1;
  for (int i = 0; i < n; ++i) x[i] += step[i];
  for (int s = 0; s < ny; ++s) {
    innovation[sensed.present[s]] = sensed.e[s];
    deviation[sensed.present[s]] = d[s];
  }
  return columns + ny;
}

}  // namespace alula
