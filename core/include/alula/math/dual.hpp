#pragma once
// Forward-mode derivatives: a value with its slopes along N directions, exact to rounding. Duals of
// fewer directions mix with those of more: their directions are the first ones, and along the
// others they do not change.
#include <alula/math/lanes.hpp>
#include <cmath>
#include <type_traits>

namespace alula {

template <class T, int N>
struct Dual {
  // Slopes lie in registers of four where N allows.
  static constexpr int kWidth = N % 4 == 0 ? 4 : 1;
  static constexpr int kBlocks = N / kWidth;
  using Block = std::conditional_t<kWidth == 4, Lanes<T, 4>, T>;

  T value;
  Block slope[kBlocks];

  Dual() = default;
  Dual(T v) : value(v) {
    for (int i = 0; i < kBlocks; ++i) slope[i] = Block(T(0));
  }

  // The same along more directions.
  template <int M>
    requires(M < N)
  Dual(const Dual<T, M>& a) : value(a.value) {
    static_assert(Dual<T, M>::kWidth == kWidth);
    for (int i = 0; i < kBlocks; ++i) slope[i] = i < a.kBlocks ? a.slope[i] : Block(T(0));
  }

  // A variable: slope one along its own direction.
  static Dual variable(T v, int direction) {
    Dual r(v);
    r.set_slope(direction, T(1));
    return r;
  }

  T slope_of(int direction) const {
    if constexpr (kWidth == 1)
      return slope[direction];
    else
      return slope[direction / kWidth][direction % kWidth];
  }
  void set_slope(int direction, T s) {
    if constexpr (kWidth == 1)
      slope[direction] = s;
    else
      slope[direction / kWidth].set(direction % kWidth, s);
  }

  // f(a) by the chain rule: its value and derivative at a.value.
  Dual chain(T f, T df) const {
    Dual r;
    r.value = f;
    const Block factor(df);
    for (int i = 0; i < kBlocks; ++i) r.slope[i] = factor * slope[i];
    return r;
  }

  template <int M>
  Dual& operator+=(const Dual<T, M>& b) {
    value += b.value;
    for (int i = 0; i < b.kBlocks; ++i) slope[i] += b.slope[i];
    return *this;
  }
  template <int M>
  Dual& operator-=(const Dual<T, M>& b) {
    value -= b.value;
    for (int i = 0; i < b.kBlocks; ++i) slope[i] -= b.slope[i];
    return *this;
  }
  Dual& operator+=(T b) {
    value += b;
    return *this;
  }
  Dual& operator-=(T b) {
    value -= b;
    return *this;
  }
  template <class B>
  Dual& operator*=(const B& b) {
    return *this = *this * b;
  }

  friend Dual operator-(const Dual& a) { return a.chain(-a.value, T(-1)); }

  // With plain numbers, which have no slopes.
  friend Dual operator+(Dual a, T b) {
    a.value += b;
    return a;
  }
  friend Dual operator+(T a, Dual b) {
    b.value += a;
    return b;
  }
  friend Dual operator-(Dual a, T b) {
    a.value -= b;
    return a;
  }
  friend Dual operator-(T a, const Dual& b) { return b.chain(a - b.value, T(-1)); }
  friend Dual operator*(const Dual& a, T b) { return a.chain(a.value * b, b); }
  friend Dual operator*(T a, const Dual& b) { return b.chain(a * b.value, a); }
  friend Dual operator/(const Dual& a, T b) { return a * (T(1) / b); }
  friend Dual operator/(T a, const Dual& b) {
    const T inverse = T(1) / b.value;
    return b.chain(a * inverse, -a * inverse * inverse);
  }

  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }

  friend Dual sin(const Dual& a) { return a.chain(std::sin(a.value), std::cos(a.value)); }
  friend Dual cos(const Dual& a) { return a.chain(std::cos(a.value), -std::sin(a.value)); }
  friend void sincos(const Dual& a, Dual& s, Dual& c) {
    const T sine = std::sin(a.value), cosine = std::cos(a.value);
    s = a.chain(sine, cosine);
    c = a.chain(cosine, -sine);
  }
  friend Dual exp(const Dual& a) {
    const T e = std::exp(a.value);
    return a.chain(e, e);
  }
  friend Dual log(const Dual& a) { return a.chain(std::log(a.value), T(1) / a.value); }
  friend Dual sqrt(const Dual& a) {
    const T root = std::sqrt(a.value);
    return a.chain(root, T(0.5) / root);
  }
  friend Dual asin(const Dual& a) {
    return a.chain(std::asin(a.value), T(1) / std::sqrt(T(1) - a.value * a.value));
  }
};

// f(a, b) by the chain rule: its value and both partial derivatives.
template <class T, int N, int M>
inline auto chain(T f, T da, const Dual<T, N>& a, T db, const Dual<T, M>& b) {
  using R = Dual<T, (N > M ? N : M)>;
  static_assert(a.kWidth == R::kWidth && b.kWidth == R::kWidth);
  R r;
  r.value = f;
  const typename R::Block fa(da), fb(db);
  for (int i = 0; i < R::kBlocks; ++i)
    r.slope[i] = i >= a.kBlocks   ? fb * b.slope[i]
                 : i >= b.kBlocks ? fa * a.slope[i]
                                  : fa * a.slope[i] + fb * b.slope[i];
  return r;
}

template <class T, int N, int M>
inline auto operator+(const Dual<T, N>& a, const Dual<T, M>& b) {
  if constexpr (N >= M)
    return Dual<T, N>(a) += b;
  else
    return Dual<T, M>(b) += a;
}
template <class T, int N, int M>
inline auto operator-(const Dual<T, N>& a, const Dual<T, M>& b) {
  return Dual<T, (N > M ? N : M)>(a) -= b;
}
template <class T, int N, int M>
inline auto operator*(const Dual<T, N>& a, const Dual<T, M>& b) {
  return chain(a.value * b.value, b.value, a, a.value, b);
}
template <class T, int N, int M>
inline auto operator/(const Dual<T, N>& a, const Dual<T, M>& b) {
  const T inverse = T(1) / b.value, quotient = a.value * inverse;
  return chain(quotient, inverse, a, -quotient * inverse, b);
}
template <class T, int N>
inline Dual<T, N> atan2(const Dual<T, N>& y, const Dual<T, N>& x) {
  const T k = T(1) / (x.value * x.value + y.value * y.value);
  return chain(std::atan2(y.value, x.value), x.value * k, y, -y.value * k, x);
}

template <class T>
constexpr T value_of(const T& x) {
  return x;
}
template <class T, int N>
constexpr T value_of(const Dual<T, N>& x) {
  return x.value;
}

// Plain numbers answer to the same names as duals and lanes.
using std::atan2;
using std::sqrt;
inline void sincos(double x, double& s, double& c) {
  s = std::sin(x);
  c = std::cos(x);
}
inline void sincos(float x, float& s, float& c) {
  s = std::sin(x);
  c = std::cos(x);
}

}  // namespace alula
