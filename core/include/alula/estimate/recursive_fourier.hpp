#pragma once
// Least squares in the frequency domain, sample by sample (Morelli, Real-Time Parameter Estimation
// in the Frequency Domain, J. Guidance, Control, and Dynamics 23, 2000).
//
// The Fourier transform of every channel at chosen frequencies grows by one term a sample,
//
//     X(w) <- g X(w) + x exp(-j w t),
//
// g = 1 or below, to forget. At any time the regression is one of m complex numbers, however long
// the flight: noise outside the band stays outside, and nothing has to be smoothed.
#include <alula/math/cholesky.hpp>
#include <cmath>
#include <limits>

namespace alula {

inline constexpr int kMaxFrequencies = 64;
inline constexpr int kMaxFourierChannels = 16;  // regressors and, last, the measured

template <class T>
struct RecursiveFourier {
  int frequencies = 0, channels = 0;
  T forgetting = T(1);  // g
  T re[kMaxFrequencies][kMaxFourierChannels] = {};
  T im[kMaxFrequencies][kMaxFourierChannels] = {};
  T cosine[kMaxFrequencies] = {}, sine[kMaxFrequencies] = {};  // of w t
  T turn_cosine[kMaxFrequencies] = {}, turn_sine[kMaxFrequencies] = {};
  T samples = T(0);  // forgotten like the data
};

// Angular frequencies (rad/s, up to kMaxFrequencies) and sampling interval dt (s).
template <class T>
inline void start(RecursiveFourier<T>& f, const T* omega, int frequencies, int channels, T dt,
                  T forgetting = T(1)) {
  f = RecursiveFourier<T>{};
  f.frequencies = frequencies;
  f.channels = channels;
  f.forgetting = forgetting;
  for (int k = 0; k < frequencies; ++k) {
    f.cosine[k] = T(1);
    f.turn_cosine[k] = std::cos(omega[k] * dt);
    f.turn_sine[k] = std::sin(omega[k] * dt);
  }
}

// One sample of all channels. One that is not finite counts as zero: it is missing.
template <class T>
inline void update(RecursiveFourier<T>& f, const T* x) {
  bool finite = true;
  for (int c = 0; c < f.channels; ++c) finite = finite && std::isfinite(x[c]);
  for (int k = 0; k < f.frequencies; ++k) {
    const T co = f.cosine[k], si = f.sine[k];
    for (int c = 0; c < f.channels; ++c) {
      const T v = finite ? x[c] : T(0);
      f.re[k][c] = f.forgetting * f.re[k][c] + v * co;
      f.im[k][c] = f.forgetting * f.im[k][c] - v * si;
    }
    const T next = co * f.turn_cosine[k] - si * f.turn_sine[k];
    const T other = si * f.turn_cosine[k] + co * f.turn_sine[k];
    const T length = T(1.5) - T(0.5) * (next * next + other * other);  // back to the unit circle
    f.cosine[k] = next * length;
    f.sine[k] = other * length;
  }
  f.samples = f.forgetting * f.samples + (finite ? T(1) : T(0));
}

template <class T>
struct FourierEstimate {
  T value[kMaxFourierChannels] = {};
  T variance[kMaxFourierChannels] = {};
  bool determined = false;
};

// Regress the last channel on the others. lines: how many of the frequencies are independent by
// now, band times duration, at most their number; each gives two real equations. NaN variances
// where there are no more equations than parameters; not determined where regressors are dependent.
template <class T>
inline FourierEstimate<T> solve(const RecursiveFourier<T>& f, T lines) {
  constexpr int R = kMaxFourierChannels;
  FourierEstimate<T> out;
  const int n = f.channels - 1;
  T A[R][R] = {}, U[R][R] = {}, h[R] = {}, size[R], power = T(0);
  for (int i = 0; i < n; ++i) {
    T sum = T(0);
    for (int k = 0; k < f.frequencies; ++k)
      sum += f.re[k][i] * f.re[k][i] + f.im[k][i] * f.im[k][i];
    size[i] = sum > T(0) ? std::sqrt(sum) : T(1);
  }
  for (int k = 0; k < f.frequencies; ++k) {
    const T *re = f.re[k], *im = f.im[k];
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) A[i][j] += (re[i] * re[j] + im[i] * im[j]) / (size[i] * size[j]);
      h[i] += (re[i] * re[n] + im[i] * im[n]) / size[i];
    }
    power += re[n] * re[n] + im[n] * im[n];
  }
  for (int i = 0; i < n; ++i) {
    if (!(A[i][i] > T(0))) return out;
    for (int j = 0; j < i; ++j) A[i][j] = A[j][i];
  }
  if (cholesky<R>(A, U, n) != 0) return out;
  T b[R];
  for (int i = 0; i < R; ++i) b[i] = h[i];
  solve<R>(U, b, n);
  for (int i = 0; i < n; ++i) out.value[i] = b[i] / size[i];
  out.determined = true;
  T left = T(0);
  for (int k = 0; k < f.frequencies; ++k) {
    T re = f.re[k][n], im = f.im[k][n];
    for (int i = 0; i < n; ++i) {
      re -= out.value[i] * f.re[k][i];
      im -= out.value[i] * f.im[k][i];
    }
    left += re * re + im * im;
  }
  const T all = static_cast<T>(f.frequencies);
  const T share = lines < all ? lines / all : T(1);
  const T freedom = T(2) * all * share - static_cast<T>(n);
  for (int i = 0; i < n; ++i) {
    T e[R] = {};
    e[i] = T(1);
    solve<R>(U, e, n);
    out.variance[i] = freedom > T(0) ? left / freedom * e[i] / (size[i] * size[i])
                                     : std::numeric_limits<T>::quiet_NaN();
  }
  return out;
}

}  // namespace alula
