#pragma once
// Forward-mode derivatives: a value with its slopes along N directions, exact to rounding.
#include <cmath>

namespace alula {

template <class T, int N>
struct Dual {
  T value{};
  T slope[N]{};

  constexpr Dual() = default;
  constexpr Dual(T v) : value(v) {}

  // A variable: slope one along its own direction.
  static constexpr Dual variable(T v, int direction) {
    Dual r(v);
    r.slope[direction] = T(1);
    return r;
  }

  constexpr Dual& operator+=(const Dual& b) {
    value += b.value;
    for (int i = 0; i < N; ++i) slope[i] += b.slope[i];
    return *this;
  }
  constexpr Dual& operator-=(const Dual& b) {
    value -= b.value;
    for (int i = 0; i < N; ++i) slope[i] -= b.slope[i];
    return *this;
  }
  constexpr Dual& operator*=(const Dual& b) { return *this = *this * b; }

  friend constexpr Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend constexpr Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend constexpr Dual operator-(const Dual& a) { return a.chain(-a.value, T(-1)); }
  friend constexpr Dual operator*(const Dual& a, const Dual& b) {
    Dual r;
    r.value = a.value * b.value;
    for (int i = 0; i < N; ++i) r.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
    return r;
  }
  friend constexpr Dual operator/(const Dual& a, const Dual& b) {
    Dual r;
    const T inverse = T(1) / b.value;
    r.value = a.value * inverse;
    for (int i = 0; i < N; ++i) r.slope[i] = (a.slope[i] - r.value * b.slope[i]) * inverse;
    return r;
  }

  // With plain numbers, which have no slopes.
  friend constexpr Dual operator+(Dual a, T b) { a.value += b; return a; }
  friend constexpr Dual operator+(T a, Dual b) { b.value += a; return b; }
  friend constexpr Dual operator-(Dual a, T b) { a.value -= b; return a; }
  friend constexpr Dual operator-(T a, const Dual& b) { return b.chain(a - b.value, T(-1)); }
  friend constexpr Dual operator*(const Dual& a, T b) { return a.chain(a.value * b, b); }
  friend constexpr Dual operator*(T a, const Dual& b) { return b.chain(a * b.value, a); }
  friend constexpr Dual operator/(const Dual& a, T b) { return a * (T(1) / b); }
  friend constexpr Dual operator/(T a, const Dual& b) {
    const T inverse = T(1) / b.value;
    return b.chain(a * inverse, -a * inverse * inverse);
  }

  friend constexpr bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend constexpr bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }

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
  friend Dual atan2(const Dual& y, const Dual& x) {
    Dual r;
    r.value = std::atan2(y.value, x.value);
    const T k = T(1) / (x.value * x.value + y.value * y.value);
    for (int i = 0; i < N; ++i) r.slope[i] = (x.value * y.slope[i] - y.value * x.slope[i]) * k;
    return r;
  }

  // f(a) by the chain rule: its value and derivative at a.value.
  constexpr Dual chain(T f, T df) const {
    Dual r;
    r.value = f;
    for (int i = 0; i < N; ++i) r.slope[i] = df * slope[i];
    return r;
  }
};

template <class T>
constexpr T value_of(const T& x) { return x; }
template <class T, int N>
constexpr T value_of(const Dual<T, N>& x) { return x.value; }

// Plain numbers answer to the same name as duals and lanes.
inline void sincos(double x, double& s, double& c) { s = std::sin(x); c = std::cos(x); }
inline void sincos(float x, float& s, float& c) { s = std::sin(x); c = std::cos(x); }

}  // namespace alula
