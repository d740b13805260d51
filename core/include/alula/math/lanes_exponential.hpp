#pragma once
// Exponential and logarithm of lanes, branch-free.
#include <limits>

#include "alula/math/lanes_format.hpp"
#include "alula/math/lanes_type.hpp"

namespace alula {

// e^x: relative error below 3e-16 (2e-7 for float). Beyond plus or minus 708 (float: 87) the value
// there. Rational approximation on [-ln(2)/2, ln(2)/2] by the coefficients of the Cephes library.
template <class T, int W>
inline Lanes<T, W> exp(Lanes<T, W> x) {
  using L = Lanes<T, W>;
  using K = detail::LaneFormat<T>;
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
  using K = detail::LaneFormat<T>;
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

}  // namespace alula
