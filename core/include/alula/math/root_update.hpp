#pragma once
// Square roots of covariances, kept as such: U upper triangular with U'U = P, rows of fixed length
// R. What is below the diagonal and beyond n is zero and stays zero.
// Source: van der Merwe and Wan 2001; Golub and Van Loan 2013, Sec. 5.2.8, 6.5.4.
#include <alula/math/rows.hpp>
#include <cmath>
#include <limits>

namespace alula {

// A standard deviation smaller than this share of what it was has been eaten by rounding.
template <class T>
inline constexpr T kRootFloor = T(8) * std::numeric_limits<T>::epsilon();

// U from rows of deviations: U'U = A A' for A (n rows, Columns, all of them used or zero), by
// modified Gram-Schmidt on the rows, which A is spent on. `least` (n): a direction shorter than
// this is given that length. Returns how many were; -1 where one is no finite number.
template <int R, int Columns, class T>
inline int triangularize(T (*A)[Columns], int n, const T* least, T (*U)[R]) {
  int raised = 0;
  for (int i = 0; i < n; ++i) {
    clear<R>(U[i]);
    T along[4];
    for (int j = i; j < n; j += 4) {
      const auto row = [&](int k) { return A[j + k < n ? j + k : n - 1]; };
      dot4<Columns>(A[i], row(0), row(1), row(2), row(3), along);
      for (int k = 0; k < 4 && j + k < n; ++k) U[i][j + k] = along[k];
    }
    const T squared = U[i][i];
    if (!(squared < T(1e37))) return -1;
    if (!(squared > least[i] * least[i])) {
      clear<R>(U[i]);
      U[i][i] = least[i];
      ++raised;
      continue;
    }
    const T inverse = T(1) / std::sqrt(squared);
    for (int j = i + 1; j < n; ++j) add_scaled<Columns>(A[j], -U[i][j] / squared, A[i]);
    scale<R>(U[i], inverse, U[i]);
  }
  return raised;
}

// U'U + w w', where w (length R, spent) is zero before `first`: Givens rotations.
template <int R, class T>
inline void root_update(T (*U)[R], T* w, int first, int n) {
  for (int k = first; k < n; ++k) {
    if (w[k] == T(0)) continue;
    const T r = std::sqrt(U[k][k] * U[k][k] + w[k] * w[k]);
    const T c = U[k][k] / r, s = w[k] / r;
    for (int j = k; j < n; ++j) {
      const T u = U[k][j];
      U[k][j] = c * u + s * w[j];
      w[j] = c * w[j] - s * u;
    }
  }
}

// U'U - w w' (w of length R, spent): hyperbolic rotations in mixed form, whose error is that of a
// backward stable method (Bojanczyk, Brent, van Dooren, de Hoog 1987). False where nothing positive
// would be left.
template <int R, class T>
inline bool root_downdate(T (*U)[R], T* w, int n) {
  for (int k = 0; k < n; ++k) {
    const T pivot = U[k][k], rest = (pivot - w[k]) * (pivot + w[k]);
    if (!(rest > T(0))) return false;
    const T r = std::sqrt(rest), s = w[k] / pivot, c = r / pivot, inverse = pivot / r;
    add_scaled_from<R>(k, U[k], -s, w);
    scale<R>(U[k], inverse, U[k]);
    scale<R>(w, c, w);
    add_scaled_from<R>(k, w, -s, U[k]);
    U[k][k] = r;
    w[k] = T(0);
  }
  return true;
}

}  // namespace alula
