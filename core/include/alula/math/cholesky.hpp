#pragma once
// Factors of small covariance matrices in caller's storage. Upper triangle, row by row: the inner
// loops run along contiguous memory and vectorize without changing the order of any sum.
#include <cmath>

namespace alula {

// U'U = A for the upper triangle of A (n x n, row length ld), into the upper triangle of U (may
// be A). A pivot below `floor` times its diagonal is raised to that: rounding has then eaten the
// digits, and the direction is as good as exactly known. Returns how many were raised; -1 where a
// diagonal is not a positive number.
template <class T>
inline int cholesky(const T* A, T* U, int n, int ld, T floor) {
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) U[i * ld + j] = A[i * ld + j];
  int raised = 0;
  T diagonal[64];
  for (int i = 0; i < n; ++i) {
    diagonal[i] = U[i * ld + i];
    if (!(diagonal[i] > T(0)) || !(diagonal[i] < T(1e30) * T(1e8))) return -1;
  }
  for (int k = 0; k < n; ++k) {
    T* row = U + k * ld;
    if (!(row[k] > floor * diagonal[k])) {
      row[k] = floor * diagonal[k];
      ++raised;
      // Positive definiteness bounds the rest of the row by the diagonals.
      for (int j = k + 1; j < n; ++j) row[j] = T(0);
    }
    const T root = std::sqrt(row[k]), inverse = T(1) / root;
    row[k] = root;
    for (int j = k + 1; j < n; ++j) row[j] *= inverse;
    for (int i = k + 1; i < n; ++i) {
      const T f = row[i];
      T* target = U + i * ld;
      for (int j = i; j < n; ++j) target[j] -= f * row[j];
    }
  }
  return raised;
}

// A = U'U, upper triangle; A must not be U.
template <class T>
inline void multiply_back(const T* U, T* A, int n, int ld) {
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) {
      T s = T(0);
      for (int k = 0; k <= i; ++k) s += U[k * ld + i] * U[k * ld + j];
      A[i * ld + j] = s;
    }
}

// Solves U'U x = b in place.
template <class T>
inline void solve(const T* U, T* b, int n, int ld) {
  for (int i = 0; i < n; ++i) {
    b[i] /= U[i * ld + i];
    for (int j = i + 1; j < n; ++j) b[j] -= U[i * ld + j] * b[i];
  }
  for (int i = n - 1; i >= 0; --i) {
    T s = b[i];
    for (int j = i + 1; j < n; ++j) s -= U[i * ld + j] * b[j];
    b[i] = s / U[i * ld + i];
  }
}

}  // namespace alula
