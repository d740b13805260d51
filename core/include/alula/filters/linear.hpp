#pragma once
// Linear Kalman filter with its Rauch-Tung-Striebel smoother, for any constant linear system:
//   x(k+1) = Phi x(k) + Gamma u(k) + Lambda w(k),  w ~ N(0, Q)
//   z(k)   = C x(k) + nu(k),                      nu ~ N(0, R)
// Source: Dittrich 2016, Eq. (3.15) to (3.21), the covariance in Joseph's form; Rauch, Tung,
// Striebel 1965. Sizes are known at run time, storage is fixed, matrices are dense and row by row.
#include <alula/filters/careful_update.hpp>
#include <alula/math/capacity.hpp>
#include <alula/math/cholesky.hpp>
#include <cmath>
#include <limits>

namespace alula {

template <class T>
struct LinearSystem {
  int states = 0, inputs = 0, outputs = 0;
  T transition[kMaxStates][kMaxStates] = {};  // Phi
  T input[kMaxStates][kMaxOutputs] = {};      // Gamma
  T process[kMaxStates][kMaxStates] = {};     // Lambda Q Lambda'
  T output[kMaxOutputs][kMaxStates] = {};     // C
  T noise[kMaxOutputs][kMaxOutputs] = {};     // R, positive definite
};

// U'U = P, also where states are known exactly: their rows of U are zero.
template <int R, class T>
inline bool factor(const T (*P)[R], T (*U)[R], int n) {
  T positive[R][R] = {};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) positive[i][j] = P[i][j];
    if (P[i][i] == T(0)) positive[i][i] = T(1);
  }
  if (cholesky<R>(positive, U, n) < 0) return false;
  for (int i = 0; i < n; ++i)
    if (P[i][i] == T(0)) U[i][i] = T(0);
  return true;
}

template <class T>
class Linear {
 public:
  static constexpr int R = kLongRow;
  T x[R] = {};
  alignas(64) T P[R][R] = {};

  // Eq. (3.17), (3.18); cross (states x states), where set: covariance of the state before the
  // step with the one after it.
  void predict(const LinearSystem<T>& system, const T* u, T (*cross)[R] = nullptr) {
    const int n = system.states;
    T next[R] = {}, PF[R][R] = {};
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) next[i] += system.transition[i][j] * x[j];
      for (int j = 0; j < system.inputs; ++j) next[i] += system.input[i][j] * u[j];
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) PF[i][j] += P[i][k] * system.transition[j][k];
    }
    for (int i = 0; i < n; ++i) {
      x[i] = next[i];
      for (int j = i; j < n; ++j) {
        T s = system.process[i][j];
        for (int k = 0; k < n; ++k) s += system.transition[i][k] * PF[k][j];
        P[i][j] = P[j][i] = s;
      }
      for (int j = 0; cross && j < n; ++j) cross[i][j] = PF[i][j];
    }
  }

  // Eq. (3.19) to (3.21) with the readings z that are numbers. Writes their innovations and the
  // standard deviations of those, NaN for the others; nis: their normalized square. Returns how
  // many were used, -1 where their covariance is not positive.
  int update(const LinearSystem<T>& system, const T* z, T* innovation, T* deviation, T& nis) {
    const int n = system.states;
    T PC[R][kMaxOutputs], S[kMaxOutputs][kMaxOutputs] = {}, U[kMaxOutputs][kMaxOutputs];
    T K[R][kMaxOutputs] = {}, e[kMaxOutputs] = {};
    int present[kMaxOutputs], ny = 0;
    nis = T(0);
    for (int s = 0; s < system.outputs; ++s) {
      innovation[s] = deviation[s] = std::numeric_limits<T>::quiet_NaN();
      if (std::isfinite(z[s])) present[ny++] = s;
    }
    if (ny == 0) return 0;
    for (int i = 0; i < n; ++i)
      for (int s = 0; s < ny; ++s) {
        PC[i][s] = T(0);
        for (int j = 0; j < n; ++j) PC[i][s] += P[i][j] * system.output[present[s]][j];
        K[i][s] = PC[i][s];
      }
    bool close = false;  // a difference of covariances would cancel more than six digits
    for (int s = 0; s < ny; ++s) {
      const T* row = system.output[present[s]];
      e[s] = z[present[s]];
      for (int j = 0; j < n; ++j) e[s] -= row[j] * x[j];
      for (int r = 0; r < ny; ++r) {
        S[s][r] = system.noise[present[s]][present[r]];
        for (int j = 0; j < n; ++j) S[s][r] += row[j] * PC[j][r];
      }
      innovation[present[s]] = e[s];
      deviation[present[s]] = std::sqrt(S[s][s]);
      close = close || !(system.noise[present[s]][present[s]] > T(1e-6) * S[s][s]);
    }
    if (close) return update_carefully(system, present, ny, e, nis);
    if (cholesky<kMaxOutputs>(S, U, ny) != 0) return -1;
    T weighed[kMaxOutputs];
    for (int s = 0; s < ny; ++s) weighed[s] = e[s];
    solve<kMaxOutputs>(U, weighed, ny);
    for (int s = 0; s < ny; ++s) nis += weighed[s] * e[s];
    for (int i = 0; i < n; ++i) {
      solve<kMaxOutputs>(U, K[i], ny);
      for (int s = 0; s < ny; ++s) x[i] += K[i][s] * e[s];
    }
    joseph(system, present, ny, K);
    return ny;
  }

 private:
  // P = (I - K C) P (I - K C)' + K R K': a sum of squares, where (I - K C) P is a difference.
  void joseph(const LinearSystem<T>& system, const int* present, int ny,
              const T (*K)[kMaxOutputs]) {
    const int n = system.states;
    T A[R][R] = {}, AP[R][R] = {}, KR[R][kMaxOutputs] = {}, U[R][R];
    for (int i = 0; i < n; ++i) {
      A[i][i] = T(1);
      for (int s = 0; s < ny; ++s) {
        for (int j = 0; j < n; ++j) A[i][j] -= K[i][s] * system.output[present[s]][j];
        for (int r = 0; r < ny; ++r) KR[i][r] += K[i][s] * system.noise[present[s]][present[r]];
      }
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) AP[i][j] += A[i][k] * P[k][j];
    }
    for (int i = 0; i < n; ++i)
      for (int j = i; j < n; ++j) {
        T s = T(0);
        for (int k = 0; k < n; ++k) s += AP[i][k] * A[j][k];
        for (int r = 0; r < ny; ++r) s += KR[i][r] * K[j][r];
        P[i][j] = P[j][i] = s;
      }
    if (cholesky<R>(P, U, n) > 0) {  // directions that rounding has eaten are held
      multiply_back<R>(U, P, n);
      for (int i = 0; i < n; ++i) P[i][i] *= kHeldApart<T>;
    }
  }

  // On columns instead of covariances (careful_update.hpp), the readings made independent first.
  int update_carefully(const LinearSystem<T>& system, const int* present, int ny, T* e, T& nis) {
    constexpr int kColumns = R + kMaxOutputs;
    const int n = system.states;
    T X[R][kColumns], Y[kMaxOutputs][kColumns], U[R][R] = {}, root[kMaxOutputs][kMaxOutputs],
                                                noise[kMaxOutputs][kMaxOutputs] = {},
                                                unit[kMaxOutputs], d[kMaxOutputs], step[R];
    for (int s = 0; s < ny; ++s)
      for (int r = 0; r < ny; ++r) noise[s][r] = system.noise[present[s]][present[r]];
    if (cholesky<kMaxOutputs>(noise, root, ny) != 0 || !factor(P, U, n)) return -1;
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) X[i][k] = U[k][i];
    for (int s = 0; s < ny; ++s) {  // forward substitution: root' Y = C X, root' e' = e
      unit[s] = T(1);
      for (int k = 0; k < n; ++k) {
        Y[s][k] = T(0);
        for (int j = 0; j < n; ++j) Y[s][k] += system.output[present[s]][j] * X[j][k];
      }
      for (int r = 0; r < s; ++r) {
        for (int k = 0; k < n; ++k) Y[s][k] -= root[r][s] * Y[r][k];
        e[s] -= root[r][s] * e[r];
      }
      for (int k = 0; k < n; ++k) Y[s][k] /= root[s][s];
      e[s] /= root[s][s];
    }
    if (!careful_update(X, n, Y, ny, n, unit, e, step, d)) return -1;
    covariance_of<R>(X, n, n + ny, P);
    for (int i = 0; i < n; ++i) x[i] += step[i];
    for (int s = 0; s < ny; ++s) nis += (e[s] / d[s]) * (e[s] / d[s]);
    return ny;
  }
};

// Over a record: u (samples, inputs), z (samples, outputs) with NaN for none; x and P of `filter`
// are those before the first reading, u[k] leads from sample k to the next. Writes x (samples,
// states), covariance (samples, states, states), innovation and deviation (samples, outputs), nis
// (samples). Returns the number of samples done.
template <class T>
int run_linear(Linear<T>& filter, const LinearSystem<T>& system, int samples, const T* u,
               const T* z, T* x, T* covariance, T* innovation, T* deviation, T* nis) {
  const int n = system.states, ny = system.outputs;
  for (int k = 0; k < samples; ++k) {
    if (k > 0) filter.predict(system, u + (k - 1) * system.inputs);
    if (filter.update(system, z + k * ny, innovation + k * ny, deviation + k * ny, nis[k]) < 0)
      return k;
    for (int i = 0; i < n; ++i) {
      if (!(filter.P[i][i] >= T(0)) || !(std::abs(filter.x[i]) < T(1e30))) return k;
      x[k * n + i] = filter.x[i];
      for (int j = 0; j < n; ++j) covariance[(k * n + i) * n + j] = filter.P[i][j];
    }
  }
  return samples;
}

// Backward over a finished run_linear, in place. Directions that the process noise does not reach
// and the readings have settled are known exactly; there the smoother adds nothing. Returns the
// first sample reached: 0 where all went well.
template <class T>
int smooth_linear(Linear<T>& filter, const LinearSystem<T>& system, int samples, const T* u, T* x,
                  T* covariance) {
  constexpr int R = Linear<T>::R;
  const int n = system.states;
  T G[R][R], U[R][R], GD[R][R];
  for (int k = samples - 2; k >= 0; --k) {
    T* now = x + k * n;
    const T* later = now + n;
    T* P = covariance + k * n * n;
    const T* P_later = P + n * n;
    for (int i = 0; i < n; ++i) {
      filter.x[i] = now[i];
      for (int j = 0; j < n; ++j) filter.P[i][j] = P[i * n + j];
    }
    filter.predict(system, u + k * system.inputs, G);
    if (!factor(filter.P, U, n)) return k + 1;
    for (int i = 0; i < n; ++i) {
      if (U[i][i] == T(0)) U[i][i] = T(1);  // known exactly: nothing to divide
    }
    for (int i = 0; i < n; ++i) solve<R>(U, G[i], n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        now[i] += G[i][j] * (later[j] - filter.x[j]);
        GD[i][j] = T(0);
        for (int m = 0; m < n; ++m) GD[i][j] += G[i][m] * (P_later[m * n + j] - filter.P[m][j]);
      }
    }
    for (int i = 0; i < n; ++i)
      for (int j = i; j < n; ++j) {
        T s = P[i * n + j];
        for (int m = 0; m < n; ++m) s += GD[i][m] * G[j][m];
        P[i * n + j] = P[j * n + i] = s;
      }
  }
  return 0;
}

}  // namespace alula
