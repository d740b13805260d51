#pragma once
// Unscented Kalman filter for flight path reconstruction; sigma points lie side by side in lanes.
// Additive noise, points drawn anew after the prediction so that the update sees process noise.
// Source: van den Hoek 2017, Eq. (10) to (21); center weights as Julier and Uhlmann 2004,
// covariances about the predicted means.
#include <alula/filters/path_model.hpp>
#include <alula/math/cholesky.hpp>

namespace alula {

template <class T>
class Unscented {
 public:
  static constexpr int W = kLanes;
  static constexpr int kPoints = 2 * kMaxStates + 8;  // 49, rounded up to whole registers
  static constexpr int ld = kMaxStates;
  using L = Lanes<T, W>;

  T x[kMaxStates] = {};
  T P[kMaxStates][kMaxStates] = {};  // upper triangle
  int repairs = 0;                   // pivots raised since the start

  // Scaled transform with alpha 1, beta 2, kappa 0: no negative weight, spread sqrt(n).
  // False where the covariance or a point is no longer finite.
  bool predict(const PathModel<T>& model, const T* u0, const T* u1, T dt) {
    T Q[kMotionStates][kMotionStates];
    path_input_noise(model, x, dt, Q);
    if (!draw(model)) return false;
    return model.motion == kMotionStates ? predict<kMotionStates>(model, u0, u1, dt, Q)
                                         : predict<kMotionStatesWithPosition>(model, u0, u1, dt, Q);
  }

  // Takes up the readings z that are numbers; NaN means 'no sample'. Writes each one's innovation
  // given those before it, and its standard deviation. Returns how many were used, -1 on failure.
  int update(const PathModel<T>& model, const T* u, const T* z, T* innovation, T* deviation);

  // C = covariance of the state before the last prediction with the one after it (n x n).
  void cross(const PathModel<T>& model, const T (*before)[kMaxStates], T (*C)[kMaxStates]) const {
    const int n = model.states;
    for (int i = 0; i < n; ++i) {
      for (int m = 0; m < model.motion; ++m) {
        T s = T(0);
        for (int j = 0; j <= i && j < model.dynamic; ++j) s += U_[j][i] * D_[m][j];
        C[i][m] = s;
      }
      for (int c = model.motion; c < n; ++c) C[i][c] = i < c ? before[i][c] : before[c][i];
    }
  }

 private:
  alignas(64) T X_[kMaxStates][kPoints];
  alignas(64) T Y_[kMaxOutputs][kPoints];
  T U_[kMaxStates][kMaxStates];             // U'U = P before the last prediction or update
  T D_[kMotionStatesWithPosition][kMaxStates];  // weighted differences of opposite points
  T S_[kMaxOutputs][kMaxOutputs], C_[kMaxOutputs][kMaxStates];

  static int rounded(int points) { return (points + W - 1) / W * W; }

  // Point 0 is the mean, 1 + 2j and 2 + 2j lie along column j of the lower factor; the rest pads.
  bool draw(const PathModel<T>& model) {
    const int n = model.states, padded = rounded(2 * n + 1);
    const T floor = sizeof(T) == 8 ? T(1e-14) : T(1e-6);
    const int raised = cholesky(&P[0][0], &U_[0][0], n, ld, floor);
    if (raised < 0) return false;
    if (raised > 0) {
      repairs += raised;
      multiply_back(&U_[0][0], &P[0][0], n, ld);
    }
    const T spread = std::sqrt(T(n));
    for (int i = 0; i < n; ++i) {
      T* row = X_[i];
      for (int k = 0; k < padded; ++k) row[k] = x[i];
      for (int j = 0; j <= i; ++j) {
        const T d = spread * U_[j][i];
        row[1 + 2 * j] += d;
        row[2 + 2 * j] -= d;
      }
    }
    return true;
  }

  template <int N>
  bool predict(const PathModel<T>& model, const T* u0, const T* u1, T dt,
               const T (*Q)[kMotionStates]);

  static T dot(const T* a, const T* b, int padded) {
    L s(T(0));
    for (int k = 0; k < padded; k += W) s += L::load(a + k) * L::load(b + k);
    return sum(s);
  }
};

template <class T>
template <int N>
bool Unscented<T>::predict(const PathModel<T>& model, const T* u0, const T* u1, T dt,
                           const T (*Q)[kMotionStates]) {
  const int n = model.states, used = 2 * model.dynamic + 1, padded = rounded(used);
  // Points along columns beyond `dynamic` differ only in constants that the rates do not know:
  // they move as the mean does and are not computed.
  for (int b = 0; b < padded; b += W) {
    L state[kMaxStates], m0[kInertialInputs], m1[kInertialInputs];
    for (int i = 0; i < model.dynamic; ++i) state[i] = L::load(&X_[i][b]);
    true_inputs(model, state, u0, m0);
    true_inputs(model, state, u1, m1);
    point_step<N>(state, m0, m1, model.gravity, dt);
    for (int i = 0; i < N; ++i) state[i].store(&X_[i][b]);
  }
  const T wi = T(0.5) / T(n), center = T(2) - wi + T(2 * (n - model.dynamic)) * wi;
  const T weight = wi * std::sqrt(T(n));
  for (int i = 0; i < N; ++i) {
    T* row = X_[i];
    const T middle = row[0];
    // Deviations from the center first: the mean of small numbers keeps its digits.
    L total(T(0));
    for (int k = 0; k < padded; k += W) {
      const L d = L::load(row + k) - L(middle);
      d.store(row + k);
      total += d;
    }
    for (int k = used; k < padded; ++k) {
      // Padding repeats the mean point, so its deviation is the center's: zero.
      row[k] = T(0);
    }
    const T shift = wi * sum(total);
    x[i] = middle + shift;
    for (int k = 0; k < padded; k += W) (L::load(row + k) - L(shift)).store(row + k);
    for (int k = used; k < padded; ++k) row[k] = T(0);
    for (int j = 0; j < model.dynamic; ++j) D_[i][j] = weight * (row[1 + 2 * j] - row[2 + 2 * j]);
    if (!(std::abs(x[i]) < T(1e30))) return false;
  }
  for (int i = 0; i < N; ++i) {
    for (int j = i; j < N; ++j) {
      P[i][j] = wi * dot(X_[i], X_[j], padded) + center * X_[i][0] * X_[j][0];
      if (j < kMotionStates) P[i][j] += Q[i][j];
    }
    T* row = P[i];
    for (int c = N; c < n; ++c) row[c] = T(0);
    for (int j = 0; j < model.dynamic; ++j) {
      const T d = D_[i][j];
      for (int c = j > N ? j : N; c < n; ++c) row[c] += d * U_[j][c];
    }
  }
  for (int c = N; c < n; ++c) P[c][c] += dt * model.walk[c] * model.walk[c];
  return true;
}

template <class T>
int Unscented<T>::update(const PathModel<T>& model, const T* u, const T* z, T* innovation,
                         T* deviation) {
  int present[kMaxOutputs], ny = 0;
  for (int s = 0; s < model.sensors.size(); ++s) {
    innovation[s] = deviation[s] = T(0) / T(0);
    if (std::isfinite(z[s])) present[ny++] = s;
  }
  if (ny == 0) return 0;
  if (!draw(model)) return -1;

  const int n = model.states, used = 2 * n + 1, padded = rounded(used);
  for (int b = 0; b < padded; b += W) {
    L state[kMaxStates], m[kInertialInputs], wind[3];
    for (int i = 0; i < n; ++i) state[i] = L::load(&X_[i][b]);
    true_inputs(model, state, u, m);
    for (int i = 0; i < 3; ++i) wind[i] = unknown(model, state, kWindNorth + i);
    const PathAir<L> air = path_air(model, state, wind, m);
    for (int s = 0; s < ny; ++s)
      path_output(model, model.sensors[present[s]], state, air).store(&Y_[s][b]);
  }

  const T wi = T(0.5) / T(n), center = T(2) - wi, weight = wi * std::sqrt(T(n));
  T e[kMaxOutputs];
  for (int s = 0; s < ny; ++s) {
    T* row = Y_[s];
    const T middle = row[0];
    L total(T(0));
    for (int k = 0; k < padded; k += W) {
      const L d = L::load(row + k) - L(middle);
      d.store(row + k);
      total += d;
    }
    const T shift = wi * sum(total);  // the padding repeats the mean point: zero
    for (int k = 0; k < padded; k += W) (L::load(row + k) - L(shift)).store(row + k);
    for (int k = used; k < padded; ++k) row[k] = T(0);
    e[s] = wrapped(model.sensors[present[s]].quantity, z[present[s]] - (middle + shift));
    T* cross_row = C_[s];
    for (int i = 0; i < n; ++i) cross_row[i] = T(0);
    for (int j = 0; j < n; ++j) {
      const T d = weight * (row[1 + 2 * j] - row[2 + 2 * j]);
      for (int i = j; i < n; ++i) cross_row[i] += d * U_[j][i];
    }
  }
  for (int s = 0; s < ny; ++s)
    for (int t = s; t < ny; ++t)
      S_[s][t] = wi * dot(Y_[s], Y_[t], padded) + center * Y_[s][0] * Y_[t][0] +
                 (s == t ? model.sensors[present[s]].variance : T(0));

  // Readings one after another: each is freed from what those before it already told.
  for (int s = 0; s < ny; ++s) {
    if (!(S_[s][s] > T(0))) return -1;
    const T inverse = T(1) / S_[s][s];
    for (int t = s + 1; t < ny; ++t) {
      const T f = S_[s][t] * inverse;
      for (int r = t; r < ny; ++r) S_[t][r] -= f * S_[s][r];
      for (int i = 0; i < n; ++i) C_[t][i] -= f * C_[s][i];
      e[t] -= f * e[s];
    }
    for (int i = 0; i < n; ++i) {
      const T gain = C_[s][i] * inverse;
      x[i] += gain * e[s];
      for (int j = i; j < n; ++j) P[i][j] -= gain * C_[s][j];
    }
    innovation[present[s]] = e[s];
    deviation[present[s]] = std::sqrt(S_[s][s]);
  }
  return ny;
}

}  // namespace alula
