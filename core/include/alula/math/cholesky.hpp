#pragma once
// Factors of small covariance matrices in caller's storage, rows of fixed length R (rows.hpp).
// Upper triangle, row by row: inner loops run along memory and keep the order of every sum.
#include <alula/math/rows.hpp>
#include <cmath>

namespace alula {

// A direction whose share of its diagonal is below this has been eaten by rounding.
template <class T>
inline constexpr T kPivotFloor = sizeof(T) == 8 ? T(1e-14) : T(1e-6);

// U'U = A by the upper triangle of A (n x n); below the diagonal U is zero. A pivot below
// kPivotFloor times its diagonal is raised to that: the direction is as good as exactly known.
// Returns how many were raised; -1 where a diagonal is not a positive finite number.
template <int R, class T>
inline int cholesky(const T (*A)[R], T (*U)[R], int n) {
  int raised = 0;
  for (int i = 0; i < n; ++i)
    if (!(A[i][i] > T(0)) || !(A[i][i] < T(1e37))) return -1;
  for (int i = 0; i < n; ++i) {
    T* row = U[i];
    T column[R];
    for (int k = 0; k < i; ++k) column[k] = -U[k][i];
    scale<R>(row, T(1), A[i]);
    add_rows_from<R>(i, row, column, U, i);
    for (int j = 0; j < i; ++j) row[j] = T(0);
    T pivot = row[i];
    if (!(pivot > kPivotFloor<T> * A[i][i])) {
      pivot = kPivotFloor<T> * A[i][i];
      clear<R>(row);  // a positive definite matrix leaves no room for the rest of the row
      row[i] = pivot;
      ++raised;
    }
    scale<R>(row, T(1) / std::sqrt(pivot), row);
  }
  return raised;
}

// A = U'U, whole.
template <int R, class T>
inline void multiply_back(const T (*U)[R], T (*A)[R], int n) {
  for (int i = 0; i < n; ++i) clear<R>(A[i]);
  for (int k = 0; k < n; ++k)
    for (int i = k; i < n; ++i) add_scaled<R>(A[i], U[k][i], U[k]);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) A[i][j] = A[j][i];
}

// Solves U'U x = b in place.
template <int R, class T>
inline void solve(const T (*U)[R], T* b, int n) {
  for (int i = 0; i < n; ++i) {
    b[i] /= U[i][i];
    for (int j = i + 1; j < n; ++j) b[j] -= U[i][j] * b[i];
  }
  for (int i = n - 1; i >= 0; --i) {
    T s = b[i];
    for (int j = i + 1; j < n; ++j) s -= U[i][j] * b[j];
    b[i] = s / U[i][i];
  }
}

}  // namespace alula
