#pragma once
// W numbers side by side in one vector register (or several): sigma points, parameter sets,
// flights. A comparison gives a mask, for which `select` chooses lane by lane.
#include <cmath>
#include <cstdint>
#include <utility>

namespace alula {

#if defined(__AVX2__)
inline constexpr int kLanes = 4;
#else
inline constexpr int kLanes = 2;
#endif

// ALULA_PLAIN_LANES: for tests of what compilers without vector types get.
#if defined(__GNUC__) && !defined(ALULA_PLAIN_LANES)
#define ALULA_VECTOR_LANES 1
namespace detail {
template <class T>
struct IntegerOf;
template <>
struct IntegerOf<double> {
  using type = std::int64_t;
};
template <>
struct IntegerOf<float> {
  using type = std::int32_t;
};
template <class T, int Bytes>
struct VectorOf {
  using type [[gnu::vector_size(Bytes)]] = T;
};
}  // namespace detail

template <class T, int W>
struct Lanes {
  using Integer = typename detail::IntegerOf<T>::type;
  using Vector = typename detail::VectorOf<T, W * sizeof(T)>::type;
  using Mask = typename detail::VectorOf<Integer, W * sizeof(T)>::type;
  Vector v;

  Lanes() = default;
  Lanes(Vector x) : v(x) {}
  Lanes(T x) : v(x - Vector{}) {}

  T operator[](int i) const { return v[i]; }
  void set(int i, T x) { v[i] = x; }

  static Lanes load(const T* p) {
    Lanes r;
    __builtin_memcpy(&r.v, p, sizeof r.v);
    return r;
  }
  void store(T* p) const { __builtin_memcpy(p, &v, sizeof v); }

  Lanes& operator+=(Lanes b) {
    v += b.v;
    return *this;
  }
  Lanes& operator-=(Lanes b) {
    v -= b.v;
    return *this;
  }
  Lanes& operator*=(Lanes b) {
    v *= b.v;
    return *this;
  }
  friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
  friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
  friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
  friend Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
  friend Lanes operator-(Lanes a) { return -a.v; }

  // Lane i is f(i).
  template <class F>
  static Lanes from(F&& f) {
    return [&f]<int... i>(std::integer_sequence<int, i...>) {
      return Lanes(Vector{f(i)...});
    }(std::make_integer_sequence<int, W>());
  }

  friend Mask operator<(Lanes a, Lanes b) { return a.v < b.v; }
  friend Mask operator>(Lanes a, Lanes b) { return a.v > b.v; }
  friend Mask operator>=(Lanes a, Lanes b) { return a.v >= b.v; }
  friend Mask operator==(Lanes a, Lanes b) { return a.v == b.v; }
  friend Lanes select(Mask m, Lanes a, Lanes b) { return m ? a.v : b.v; }

  Mask bits() const { return (Mask)v; }
  static Lanes from_bits(Mask m) { return (Vector)m; }

  friend Lanes sqrt(Lanes a) {
    Lanes r;
    for (int i = 0; i < W; ++i) r.v[i] = std::sqrt(a.v[i]);
    return r;
  }
  friend T sum(Lanes a) {
    T s = a.v[0];
    for (int i = 1; i < W; ++i) s += a.v[i];
    return s;
  }
};
#else
// Compilers without vector types: the same operations, lane by lane.
template <class T, int W>
struct Lanes {
  using Integer = std::int64_t;
  struct Mask {
    Integer m[W];
    Integer operator[](int i) const { return m[i]; }
    friend Mask operator&(Mask a, const Mask& b) {
      for (int i = 0; i < W; ++i) a.m[i] &= b.m[i];
      return a;
    }
    friend Mask operator|(Mask a, const Mask& b) {
      for (int i = 0; i < W; ++i) a.m[i] |= b.m[i];
      return a;
    }
  };
  T v[W];

  Lanes() = default;
  Lanes(T x) {
    for (auto& y : v) y = x;
  }
  T operator[](int i) const { return v[i]; }
  void set(int i, T x) { v[i] = x; }
  static Lanes load(const T* p) {
    Lanes r;
    for (int i = 0; i < W; ++i) r.v[i] = p[i];
    return r;
  }
  void store(T* p) const {
    for (int i = 0; i < W; ++i) p[i] = v[i];
  }
  Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  Lanes& operator-=(const Lanes& b) { return *this = *this - b; }
  Lanes& operator*=(const Lanes& b) { return *this = *this * b; }
#define ALULA_LANES_OPERATOR(op)                             \
  friend Lanes operator op(const Lanes& a, const Lanes& b) { \
    Lanes r;                                                 \
    for (int i = 0; i < W; ++i) r.v[i] = a.v[i] op b.v[i];   \
    return r;                                                \
  }
  ALULA_LANES_OPERATOR(+)
  ALULA_LANES_OPERATOR(-)
  ALULA_LANES_OPERATOR(*)
  ALULA_LANES_OPERATOR(/)
#undef ALULA_LANES_OPERATOR
#define ALULA_LANES_COMPARISON(op)                            \
  friend Mask operator op(const Lanes& a, const Lanes& b) {   \
    Mask r;                                                   \
    for (int i = 0; i < W; ++i) r.m[i] = -(a.v[i] op b.v[i]); \
    return r;                                                 \
  }
  ALULA_LANES_COMPARISON(<)
  ALULA_LANES_COMPARISON(>)
  ALULA_LANES_COMPARISON(>=)
  ALULA_LANES_COMPARISON(==)
#undef ALULA_LANES_COMPARISON
  friend Lanes select(const Mask& m, const Lanes& a, const Lanes& b) {
    Lanes r;
    for (int i = 0; i < W; ++i) r.v[i] = m.m[i] ? a.v[i] : b.v[i];
    return r;
  }
  template <class F>
  static Lanes from(F&& f) {
    Lanes r;
    for (int i = 0; i < W; ++i) r.v[i] = f(i);
    return r;
  }
  friend Lanes operator-(const Lanes& a) { return Lanes(T(0)) - a; }
  friend Lanes sqrt(const Lanes& a) {
    Lanes r;
    for (int i = 0; i < W; ++i) r.v[i] = std::sqrt(a.v[i]);
    return r;
  }
  friend T sum(const Lanes& a) {
    T s = 0;
    for (T x : a.v) s += x;
    return s;
  }
};
#endif

// The same choices for plain numbers, where a comparison gives a bool: one text serves both. What
// is skipped by `any` and `all` must be what `select` would not have taken.
template <class S>
constexpr S select(bool m, const S& a, const S& b) {
  return m ? a : b;
}
constexpr bool any(bool m) { return m; }
constexpr bool all(bool m) { return m; }
template <class Mask>
  requires requires(const Mask& m) { m[0]; }
inline bool any(const Mask& m) {
  auto r = m[0];
  for (unsigned i = 1; i < sizeof(Mask) / sizeof r; ++i) r |= m[i];
  return r != 0;
}
template <class Mask>
  requires requires(const Mask& m) { m[0]; }
inline bool all(const Mask& m) {
  auto r = m[0];
  for (unsigned i = 1; i < sizeof(Mask) / sizeof r; ++i) r &= m[i];
  return r != 0;
}

}  // namespace alula
