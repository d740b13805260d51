#pragma once
// Measurement update for readings so sharp that subtracting covariances would cancel all digits.
// State and readings are written as combinations of independent unit variables (columns); each
// reading in turn takes its direction out of everything that is left (modified Gram-Schmidt), so
// the covariance stays a sum of squares. Bierman 1977, Sec. IV.3; Golub and Van Loan, Sec. 5.2.8.
#include <alula/math/cholesky.hpp>
#include <cmath>

namespace alula {

// X: n rows of deviations of the state, Y: ny rows of the readings' (the noise is added here),
// each of `columns` used entries; capacity Columns leaves room for ny more. `variance` (ny) of the
// noise, e (ny) innovations, which become those given the readings before. Writes the state's
// `step`, `deviation` (ny) of the innovations, and leaves in X, over columns + ny, the deviations
// after the update. False where a reading's variance is not a positive finite number.
template <int Columns, class T>
inline bool careful_update(T (*X)[Columns], int n, T (*Y)[Columns], int ny, int columns,
                           const T* variance, T* e, T* step, T* deviation) {
  const int m = columns + ny;
  for (int i = 0; i < n; ++i) {
    step[i] = T(0);
    for (int k = columns; k < m; ++k) X[i][k] = T(0);
  }
  for (int s = 0; s < ny; ++s)
    for (int k = columns; k < m; ++k) Y[s][k] = k == columns + s ? std::sqrt(variance[s]) : T(0);
  for (int s = 0; s < ny; ++s) {
    T squared = T(0);
    for (int k = 0; k < m; ++k) squared += Y[s][k] * Y[s][k];
    if (!(squared > T(0)) || !(squared < T(1e30))) return false;
    const T length = std::sqrt(squared);
    for (int k = 0; k < m; ++k) Y[s][k] /= length;
    e[s] /= length;
    const auto take_out = [&](T* row) {
      T along = T(0);
      for (int k = 0; k < m; ++k) along += row[k] * Y[s][k];
      for (int k = 0; k < m; ++k) row[k] -= along * Y[s][k];
      return along;
    };
    for (int t = s + 1; t < ny; ++t) e[t] -= take_out(Y[t]) * e[s];
    for (int i = 0; i < n; ++i) step[i] += take_out(X[i]) * e[s];
    e[s] *= length;
    deviation[s] = length;
  }
  return true;
}

// Standard deviations grow by less than any digit that is ever shown, and no combination of states
// is left that rounding could make negative.
template <class T>
inline constexpr T kHeldApart = T(1) + T(10) * kPivotFloor<T>;

// P = X X', rows of length R, full. P comes with its diagonal before the update: a variance that
// has sunk out of sight of it is held where rounding ends.
template <int R, int Columns, class T>
inline void covariance_of(const T (*X)[Columns], int n, int columns, T (*P)[R]) {
  for (int i = 0; i < n; ++i) {
    const T floor = P[i][i] * kPivotFloor<T> * kPivotFloor<T>;
    for (int j = i; j < n; ++j) {
      T s = T(0);
      for (int k = 0; k < columns; ++k) s += X[i][k] * X[j][k];
      P[i][j] = P[j][i] = s;
    }
    if (!(P[i][i] > floor)) P[i][i] = floor;
    P[i][i] *= kHeldApart<T>;
  }
}

}  // namespace alula
