#pragma once
// Covariance of a fixed number of error states, and the update by M readings at once: they are
// judged together, so that a vector is taken or refused whole.
#include <cmath>

#include "alula/math/cholesky.hpp"
#include "alula/navigate/taken.hpp"

namespace alula {

template <int N>
inline constexpr int kPaddedRow = (N + 3) / 4 * 4;  // whole vector registers

template <class T, int N>
struct ErrorCovariance {
  alignas(32) T P[N][kPaddedRow<N>] = {};
};

// M readings that depend on K of the states: innovation e, its slopes H, covariance R of the noise.
template <class T, int M, int K>
struct Innovation {
  int column[K];
  T H[M][K] = {};
  T e[M] = {};
  T R[M][M] = {};
};

template <class T>
struct Judged {
  Taken taken;
  T nis;           // normalized innovation squared, M degrees of freedom
  T deviation[3];  // of each innovation
};

template <class T, int N>
constexpr void add_variance(ErrorCovariance<T, N>& c, int first, const Vec3<T>& variance) {
  c.P[first][first] += variance.x;
  c.P[first + 1][first + 1] += variance.y;
  c.P[first + 2][first + 2] += variance.z;
}

// An attitude that is known within `tilt` and, about the vertical, `heading` (rad). down: the
// vertical in body axes; first: state of the turn about body x.
template <class T, int N>
constexpr void add_attitude_variance(ErrorCovariance<T, N>& c, int first, const Vec3<T>& down,
                                     T tilt, T heading) {
  const T d[3] = {down.x, down.y, down.z};
  const T t = tilt * tilt, more = heading * heading - t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c.P[first + i][first + j] += more * d[i] * d[j] + (i == j ? t : T(0));
}

// Kalman update; `dx` (N) is the correction of the error states. Nothing is touched unless taken:
// refused where nis exceeds `gate`, or where the innovations' covariance is not positive.
template <class T, int N, int M, int K>
Judged<T> correct(ErrorCovariance<T, N>& c, const Innovation<T, M, K>& z, T gate, T* dx) {
  static_assert(M <= 3);
  constexpr int R = kPaddedRow<N>;
  Judged<T> out{Taken::kUnusable, T(0), {}};
  alignas(32) T W[M][R];
  T S[M][M];
  for (int m = 0; m < M; ++m) {
    for (int j = 0; j < R; ++j) W[m][j] = z.H[m][0] * c.P[z.column[0]][j];
    for (int k = 1; k < K; ++k) {
      const T h = z.H[m][k];
      const T* row = c.P[z.column[k]];
      for (int j = 0; j < R; ++j) W[m][j] += h * row[j];
    }
    for (int l = 0; l <= m; ++l) {
      T s = z.R[m][l];
      for (int k = 0; k < K; ++k) s += z.H[l][k] * W[m][z.column[k]];
      S[m][l] = s;
    }
    out.deviation[m] = std::sqrt(S[m][m]);
  }
  // S = L L'; y = L^-1 e; rows of W become those of L^-1 H P
  T y[M];
  for (int m = 0; m < M; ++m) {
    y[m] = z.e[m];
    for (int l = 0; l < m; ++l) {
      for (int k = 0; k < l; ++k) S[m][l] -= S[m][k] * S[l][k];
      S[m][l] /= S[l][l];
      S[m][m] -= S[m][l] * S[m][l];
      y[m] -= S[m][l] * y[l];
    }
    if (!(S[m][m] > T(0)) || !(S[m][m] < T(1e30))) return out;
    S[m][m] = std::sqrt(S[m][m]);
    y[m] /= S[m][m];
    out.nis += y[m] * y[m];
  }
  if (!(out.nis <= gate)) {
    out.taken = Taken::kGated;
    return out;
  }
  for (int m = 0; m < M; ++m) {
    for (int l = 0; l < m; ++l)
      for (int j = 0; j < R; ++j) W[m][j] -= S[m][l] * W[l][j];
    const T inverse = T(1) / S[m][m];
    for (int j = 0; j < R; ++j) W[m][j] *= inverse;
  }
  for (int j = 0; j < N; ++j) {
    dx[j] = T(0);
    for (int m = 0; m < M; ++m) dx[j] += y[m] * W[m][j];
  }
  for (int i = 0; i < N; ++i) {
    const T before = c.P[i][i];
    for (int m = 0; m < M; ++m) {
      const T w = W[m][i];
      for (int j = 0; j < R; ++j) c.P[i][j] -= w * W[m][j];
    }
    // what rounding leaves of a state that is known exactly now
    if (!(c.P[i][i] > kPivotFloor<T> * before)) c.P[i][i] = kPivotFloor<T> * before;
  }
  out.taken = Taken::kYes;
  return out;
}

}  // namespace alula
