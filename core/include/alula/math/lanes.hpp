#pragma once
// W numbers side by side in one vector register (or several): sigma points, parameter sets,
// flights. Sine, cosine, arctangent, exponential and logarithm are branch-free, so every lane takes
// the same way. A comparison gives a mask, for which `select` chooses lane by lane.
#include <cmath>
#include <cstdint>
#include <limits>
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

namespace detail {
// What sine and cosine need to know of a number type: adding and subtracting `magic` rounds to an
// integer that then stands in the low bits; pi/2 in three parts whose products with small
// integers are exact (Cody and Waite 1980).
template <class T>
struct Trig;
template <>
struct Trig<double> {
  static constexpr double magic = 6755399441055744.0;  // 1.5 * 2^52
  static constexpr double half_pi_1 = 1.57079625129699707031;
  static constexpr double half_pi_2 = 7.54978941586159635335e-8;
  static constexpr double half_pi_3 = 5.39030252995776476554e-15;
  static constexpr int sign_shift = 62;      // from bit 1 to the sign bit
  static constexpr int exponent_shift = 52;  // from bit 0 to the exponent
  static constexpr std::int64_t exponent_of_one = 1023;
  static constexpr double largest_exponent = 708.0;  // e to plus or minus this is a normal number
};
template <>
struct Trig<float> {
  static constexpr float magic = 12582912.0f;  // 1.5 * 2^23
  static constexpr float half_pi_1 = 1.5703125f;
  static constexpr float half_pi_2 = 4.837512969970703125e-4f;
  static constexpr float half_pi_3 = 7.54978995489188216e-8f;
  static constexpr int sign_shift = 30;
  static constexpr int exponent_shift = 23;
  static constexpr std::int32_t exponent_of_one = 127;
  static constexpr float largest_exponent = 87.0f;
};
}  // namespace detail

// Sine and cosine, |x| < 1e5 (float: 1e3): absolute error below 2e-16 (1.2e-7 for float).
// Polynomials on [-pi/4, pi/4]: minimax coefficients of the Cephes library (Moshier 1989).
template <class T, int W>
inline void sincos(Lanes<T, W> x, Lanes<T, W>& sine, Lanes<T, W>& cosine) {
  using L = Lanes<T, W>;
#if defined(ALULA_VECTOR_LANES)
  using K = detail::Trig<T>;
  const L shifted = x * L(T(0.63661977236758134308)) + L(K::magic);
  const auto quadrant = shifted.bits();
  const L k = shifted - L(K::magic);
  const L r = ((x - k * L(K::half_pi_1)) - k * L(K::half_pi_2)) - k * L(K::half_pi_3);
  const L z = r * r;
  L s = L(T(1.58962301576546568060e-10));
  s = s * z + L(T(-2.50507477628578072866e-8));
  s = s * z + L(T(2.75573136213857245213e-6));
  s = s * z + L(T(-1.98412698295895385996e-4));
  s = s * z + L(T(8.33333333332211858878e-3));
  s = s * z + L(T(-1.66666666666666307295e-1));
  s = r + r * (z * s);
  L c = L(T(-1.13585365213876817300e-11));
  c = c * z + L(T(2.08757008419747316778e-9));
  c = c * z + L(T(-2.75573141792967388112e-7));
  c = c * z + L(T(2.48015872888517045348e-5));
  c = c * z + L(T(-1.38888888888730564116e-3));
  c = c * z + L(T(4.16666666666665929218e-2));
  c = L(T(1)) - L(T(0.5)) * z + z * z * c;
  const auto odd = (quadrant & 1) != 0;
  const L a = select(odd, c, s), b = select(odd, s, c);
  sine = L::from_bits(a.bits() ^ ((quadrant & 2) << K::sign_shift));
  cosine = L::from_bits(b.bits() ^ (((quadrant + 1) & 2) << K::sign_shift));
#else
  for (int i = 0; i < W; ++i) {
    sine.v[i] = std::sin(x.v[i]);
    cosine.v[i] = std::cos(x.v[i]);
  }
#endif
}

// atan2(y, x) for all quadrants: absolute error below 5e-16 (3e-7 for float); atan2(0, 0) = 0.
// Rational approximation on [-0.66, 0.66] by the coefficients of the Cephes library.
template <class T, int W>
inline Lanes<T, W> atan2(Lanes<T, W> y, Lanes<T, W> x) {
  using L = Lanes<T, W>;
#if defined(ALULA_VECTOR_LANES)
  const L zero(T(0)), one(T(1));
  const L ay = select(y < zero, -y, y), ax = select(x < zero, -x, x);
  const auto steep = ay > ax;  // the quotient t stays within [0, 1]
  const L large = select(steep, ay, ax), small = select(steep, ax, ay);
  const auto upper =
      small > L(T(0.4142135623730950488)) * large;  // tan(pi/8); then (t - 1)/(t + 1)
  const L u = select(upper, small - large, small) /
              select(large > zero, select(upper, small + large, large), one);
  const L z = u * u;
  L p = L(T(-8.750608600031904122785e-1));
  p = p * z + L(T(-1.615753718733365076637e1));
  p = p * z + L(T(-7.500855792314704667340e1));
  p = p * z + L(T(-1.228866684490136173410e2));
  p = p * z + L(T(-6.485021904942025371773e1));
  L q = z + L(T(2.485846490142306297962e1));
  q = q * z + L(T(1.650270098316988542046e2));
  q = q * z + L(T(4.328810604912902668951e2));
  q = q * z + L(T(4.853903996359136964868e2));
  q = q * z + L(T(1.945506571482613964425e2));
  L r = select(upper, L(T(0.78539816339744830962)), zero) + (u + u * (z * p / q));
  r = select(steep, L(T(1.57079632679489661923)) - r, r);
  r = select(x < zero, L(T(3.14159265358979323846)) - r, r);
  return select(y < zero, -r, r);
#else
  L r;
  for (int i = 0; i < W; ++i) r.v[i] = std::atan2(y.v[i], x.v[i]);
  return r;
#endif
}

// e^x: relative error below 3e-16 (2e-7 for float). Beyond plus or minus 708 (float: 87) the value
// there. Rational approximation on [-ln(2)/2, ln(2)/2] by the coefficients of the Cephes library.
template <class T, int W>
inline Lanes<T, W> exp(Lanes<T, W> x) {
  using L = Lanes<T, W>;
  using K = detail::Trig<T>;
  const L end(K::largest_exponent);
  x = select(x > end, end, select(x < -end, -end, x));
#if defined(ALULA_VECTOR_LANES)
  const L shifted = x * L(T(1.44269504088896340736)) + L(K::magic);
  const L k = shifted - L(K::magic);
  const L r = (x - k * L(T(6.93145751953125e-1))) - k * L(T(1.42860682030941723212e-6));
  const L z = r * r;
  L p = L(T(1.26177193074810590878e-4));
  p = p * z + L(T(3.02994407707441961300e-2));
  p = r * (p * z + L(T(1)));
  L q = L(T(3.00198505138664455042e-6));
  q = q * z + L(T(2.52448340349684104192e-3));
  q = q * z + L(T(2.27265548208155028766e-1));
  q = q * z + L(T(2));
  const L power = L::from_bits((shifted.bits() + K::exponent_of_one) << K::exponent_shift);
  return (L(T(1)) + L(T(2)) * p / (q - p)) * power;
#else
  return L::from([&x](int i) { return std::exp(x.v[i]); });
#endif
}

// Natural logarithm of normal numbers above zero: error below 2e-16 and 3e-16 of the value (float:
// 1e-7 both); NaN for all others. Rational approximation on [sqrt(1/2), sqrt(2)] by the
// coefficients of the Cephes library.
template <class T, int W>
inline Lanes<T, W> log(Lanes<T, W> x) {
  using L = Lanes<T, W>;
#if defined(ALULA_VECTOR_LANES)
  using K = detail::Trig<T>;
  using Limits = std::numeric_limits<T>;
  const L one(T(1));
  const auto bits = x.bits();
  const auto inside = (x > L(T(0))) & (x < L(Limits::infinity()));
  const auto exponent = (bits >> K::exponent_shift) - K::exponent_of_one;
  L m = L::from_bits(bits - (exponent << K::exponent_shift));
  L e = L::from_bits(exponent + L(K::magic).bits()) - L(K::magic);
  const auto upper = m > L(T(1.41421356237309504880));
  m = select(upper, L(T(0.5)) * m, m) - one;
  e = select(upper, e + one, e);
  const L z = m * m;
  L p = L(T(1.01875663804580931796e-4));
  p = p * m + L(T(4.97494994976747001425e-1));
  p = p * m + L(T(4.70579119878881725854e0));
  p = p * m + L(T(1.44989225341610930846e1));
  p = p * m + L(T(1.79368678507819816313e1));
  p = p * m + L(T(7.70838733755885391666e0));
  L q = m + L(T(1.12873587189167450590e1));
  q = q * m + L(T(4.52279145837532221105e1));
  q = q * m + L(T(8.29875266912776603211e1));
  q = q * m + L(T(7.11544750618563894466e1));
  q = q * m + L(T(2.31251620126765340583e1));
  const L rest = m * (z * p / q) - e * L(T(2.121944400546905827679e-4)) - L(T(0.5)) * z;
  return select(inside, (m + rest) + e * L(T(0.693359375)), L(Limits::quiet_NaN()));
#else
  return L::from([&x](int i) {
    using Limits = std::numeric_limits<T>;
    return x.v[i] > 0 && x.v[i] < Limits::infinity() ? std::log(x.v[i]) : Limits::quiet_NaN();
  });
#endif
}

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
