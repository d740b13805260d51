#pragma once
// Sine, cosine and arctangent of lanes, branch-free: every lane takes the same way.
#include "alula/math/lanes_format.hpp"
#include "alula/math/lanes_type.hpp"

namespace alula {

// Sine and cosine, |x| < 1e5 (float: 1e3): absolute error below 2e-16 (1.2e-7 for float).
// Polynomials on [-pi/4, pi/4]: minimax coefficients of the Cephes library (Moshier 1989).
template <class T, int W>
inline void sincos(Lanes<T, W> x, Lanes<T, W>& sine, Lanes<T, W>& cosine) {
  using L = Lanes<T, W>;
#if defined(ALULA_VECTOR_LANES)
  using K = detail::LaneFormat<T>;
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

}  // namespace alula
