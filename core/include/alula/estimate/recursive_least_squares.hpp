#pragma once
// Recursive least squares with forgetting (Dittrich 2016, Eq. (3.66) to (3.70), with errata):
//
//     K = P x/(a + x'P x),    value += K (z - x'value),    P <- (P - K x'P)/a
//
// P is carried as U D U' (Bierman, Factorization Methods for Discrete Sequential Estimation, 1977,
// ch. III and V), so that it stays positive however long the flight, in single precision too.
//
// Plain forgetting divides all of P by a, and P grows without end in every direction that is not
// excited: in quiet flight the estimate ends in noise. Forgetting along the regressor only (Cao and
// Schwartz, Automatica 36, 2000) takes the old information out of just the direction in which new
// comes in; the others keep theirs, and nothing has to be tuned. Besides, no parameter's variance
// is forgotten beyond its bound.
#include <algorithm>
#include <alula/math/bounded.hpp>
#include <cmath>
#include <limits>

namespace alula {

inline constexpr int kMaxResidualWindow = 512;

template <class T>
struct Forgetting {
  T factor = T(1);          // a, 0 < a <= 1
  bool directional = true;  // along the regressor only; otherwise all of P by 1/a
  // Adaptive: while the mean square of the last `window` residuals (Eq. (3.69)) is over twice their
  // usual variance, the factor falls toward `least` in proportion. 0: not adaptive.
  int window = 0;
  T least = T(0.9);
  T variance = T(0);     // usual variance of a residual; 0: learned from those that are usual
  T reset_ratio = T(0);  // the variances start anew where the ratio exceeds this; 0: never
};

template <class T, int Max>
struct RecursiveLeastSquares {
  int n = 0;
  T value[Max] = {};
  T u[Max][Max] = {};  // column j of the unit upper triangle in row j: u[j][i], i < j
  T d[Max] = {};
  T start[Max] = {};  // variances to which a reset returns
  T bound[Max] = {};  // variances that forgetting does not exceed
  Forgetting<T> forgetting;
  // Residuals are e/sqrt(1 + x'P x): white with the noise's own variance where nothing is forgotten
  // (Brown, Durbin and Evans, 1975).
  T squares = T(0);  // forgotten like the data
  T count = T(0);
  T taken = T(0);  // what is left of the n parameters that the first samples determined
  T recent[kMaxResidualWindow] = {};
  int place = 0, filled = 0;
  T recent_sum = T(0);
  T usual = T(0);
};

template <class T>
struct RecursiveStep {
  T innovation = T(0);  // z - x'value before the sample
  T spread = T(1);      // its variance over the noise's, 1 + x'P x
  T factor = T(1);      // the forgetting that was used
  bool forgot = false, reset = false;
};

// n parameters (up to Max) at zero with the given variances, in units of the noise's variance.
template <class T, int Max>
inline void start(RecursiveLeastSquares<T, Max>& f, int n, const T* variances) {
  const Forgetting<T> kept = f.forgetting;
  f = RecursiveLeastSquares<T, Max>{};
  f.forgetting = kept;
  f.n = n;
  f.taken = static_cast<T>(n);
  for (int i = 0; i < n; ++i) f.d[i] = f.start[i] = f.bound[i] = variances[i];
  f.usual = kept.variance;
}

// The variances of the start with the values of now: after a change of the aircraft.
template <class T, int Max>
inline void reset_covariance(RecursiveLeastSquares<T, Max>& f) {
  for (int j = 0; j < f.n; ++j) {
    f.d[j] = f.start[j];
    for (int i = 0; i < j; ++i) f.u[j][i] = T(0);
  }
  f.squares = f.count = T(0);
  f.taken = static_cast<T>(f.n);
  f.place = f.filled = 0;
  f.recent_sum = T(0);
}

// Diagonal of P.
template <class T, int Max>
inline void variances(const RecursiveLeastSquares<T, Max>& f, T* out) {
  for (int i = 0; i < f.n; ++i) out[i] = f.d[i];
  for (int j = 1; j < f.n; ++j)
    for (int i = 0; i < j; ++i) out[i] += f.u[j][i] * f.u[j][i] * f.d[j];
}

// The noise's variance as the residuals show it; NaN before there are more samples than parameters.
template <class T, int Max>
inline T noise_variance(const RecursiveLeastSquares<T, Max>& f) {
  const T freedom = f.count - f.taken;
  return freedom > T(0.5) ? f.squares / freedom : std::numeric_limits<T>::quiet_NaN();
}

namespace detail {

// P += c v v' (Agee and Turner); v is used up.
template <class T, int Max>
inline void add_outer(RecursiveLeastSquares<T, Max>& f, T c, T* v) {
  for (int j = f.n - 1; j >= 0; --j) {
    const T s = v[j], before = f.d[j], after = before + c * s * s;
    if (!(after > T(0))) continue;
    f.d[j] = after;
    const T share = c / after, beta = s * share;
    c = share * before;
    for (int i = 0; i < j; ++i) {
      v[i] -= s * f.u[j][i];
      f.u[j][i] += beta * v[i];
    }
  }
}

// x' P^-1 x; infinite where P has no extent along x.
template <class T, int Max>
inline T information_along(const RecursiveLeastSquares<T, Max>& f, const T* x) {
  T w[Max];
  for (int i = 0; i < f.n; ++i) w[i] = x[i];
  T sum = T(0);
  for (int j = f.n - 1; j >= 0; --j) {
    for (int i = 0; i < j; ++i) w[i] -= f.u[j][i] * w[j];
    if (w[j] != T(0)) sum += w[j] * w[j] / f.d[j];
  }
  return sum;
}

// The factor of this sample, by the ratio of recent to usual variance.
template <class T, int Max>
inline T forgetting_now(const RecursiveLeastSquares<T, Max>& f, T& ratio) {
  const Forgetting<T>& s = f.forgetting;
  ratio = T(1);
  if (s.window <= 0 || f.filled < s.window || !(f.usual > T(0))) return s.factor;
  ratio = f.recent_sum / static_cast<T>(s.window) / f.usual;
  const T low = std::min(s.least, s.factor);
  return low + (s.factor - low) * std::min(T(1), T(2) / ratio);
}

template <class T, int Max>
inline void remember(RecursiveLeastSquares<T, Max>& f, T square, T ratio) {
  const int window = std::min(f.forgetting.window, kMaxResidualWindow);
  if (window <= 0 || f.count <= f.taken) return;
  f.recent[f.place] = square;
  f.place = f.place + 1 == window ? 0 : f.place + 1;
  f.filled = std::min(f.filled + 1, window);
  f.recent_sum = T(0);  // anew each time: a running difference would keep its roundings
  for (int i = 0; i < f.filled; ++i) f.recent_sum += f.recent[i];
  if (f.forgetting.variance > T(0)) return;
  const T mean = f.recent_sum / static_cast<T>(f.filled);
  if (f.filled < window || !(f.usual > T(0)))
    f.usual = mean;
  else if (ratio < T(2))
    f.usual += (mean - f.usual) / (T(10) * static_cast<T>(window));
}

}  // namespace detail

// One sample: measured z, regressors x (n). A sample that is not finite is passed over. gain (n)
// receives K where it is not null.
template <class T, int Max>
inline RecursiveStep<T> update(RecursiveLeastSquares<T, Max>& f, const T* x, T z,
                               T* gain = nullptr) {
  RecursiveStep<T> out;
  const int n = f.n;
  T expected = T(0);
  bool finite = std::isfinite(z);
  for (int i = 0; i < n; ++i) {
    expected += x[i] * f.value[i];
    finite = finite && std::isfinite(x[i]);
  }
  if (gain)
    for (int i = 0; i < n; ++i) gain[i] = T(0);
  if (!finite) {
    out.innovation = std::numeric_limits<T>::quiet_NaN();
    return out;
  }
  out.innovation = z - expected;

  T ratio;
  T a = detail::forgetting_now(f, ratio);
  if (f.forgetting.reset_ratio > T(0) && ratio > f.forgetting.reset_ratio) {
    reset_covariance(f);
    out.reset = true;
    a = T(1);
  }
  if (a < T(1)) {
    T now[Max];
    variances(f, now);
    bool room = true;
    T c = T(0);
    if (f.forgetting.directional) {
      const T along = detail::information_along(f, x);
      c = along > T(0) ? (T(1) - a) / (a * along) : T(0);
      room = c > T(0);
      for (int i = 0; i < n; ++i) room = room && now[i] + c * x[i] * x[i] <= f.bound[i];
    } else {
      for (int i = 0; i < n; ++i) room = room && now[i] <= a * f.bound[i];
    }
    if (room) {
      out.forgot = true;
      out.factor = a;
      if (f.forgetting.directional) {
        T v[Max];
        for (int i = 0; i < n; ++i) v[i] = x[i];
        detail::add_outer(f, c, v);
      } else {
        for (int i = 0; i < n; ++i) f.d[i] /= a;
      }
      f.squares *= a;
      f.count *= a;
      f.taken *= a;
    }
  }

  // Bierman's update for unit noise variance.
  T b[Max];
  T alpha = T(1);
  for (int j = 0; j < n; ++j) {
    T fj = x[j];
    for (int i = 0; i < j; ++i) fj += f.u[j][i] * x[i];
    const T vj = f.d[j] * fj, before = alpha;
    alpha += vj * fj;
    const T shrink = before / alpha, lambda = -fj / before;
    f.d[j] *= shrink;
    for (int i = 0; i < j; ++i) {
      const T old = f.u[j][i];
      f.u[j][i] = old + b[i] * lambda;
      b[i] += old * vj;
    }
    b[j] = vj;
  }
  out.spread = alpha;
  const T step = out.innovation / alpha;
  for (int i = 0; i < n; ++i) {
    f.value[i] += b[i] * step;
    if (gain) gain[i] = b[i] / alpha;
  }
  const T square = out.innovation * step;
  f.squares += square;
  f.count += T(1);
  detail::remember(f, square, ratio);
  return out;
}

}  // namespace alula
