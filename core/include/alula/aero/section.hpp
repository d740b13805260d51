#pragma once
// Coefficients of an airfoil section over all angles of attack, and what a plain flap adds.
#include "alula/math/dual.hpp"

namespace alula {

// A view over the whole circle, -pi to pi in even steps, n values each (at least two), the
// caller's: c_l with what the finite wing takes from it, c_d without induced drag, c_m about the
// quarter chord.
template <class T>
struct SectionTable {
  const T *c_l = nullptr, *c_d = nullptr, *c_m = nullptr;
  int n = 0;
};

template <class S>
struct SectionCoefficients {
  S c_l, c_d, c_m;
};

// alpha: rad, any; linear between the values.
template <class S, class T>
constexpr SectionCoefficients<S> section_at(const SectionTable<T>& table, const S& alpha) {
  constexpr double kPi = 3.14159265358979323846;
  const T last = T(table.n - 1);
  const S x = (last / T(2 * kPi)) * (alpha + T(kPi));
  // Beyond the circle (a flap's shift): once around. A number that is none ends at the first cell.
  T turns(0);
  if (value_of(x) > last) turns = T(1);
  if (value_of(x) < T(0)) turns = T(-1);
  const S at = x - turns * last;
  const T place = value_of(at);
  int i = place > T(0) && place < last ? static_cast<int>(place) : 0;
  if (i > table.n - 2) i = table.n - 2;
  const S part = at - T(i);
  const auto between = [&](const T* y) { return S(y[i] + (y[i + 1] - y[i]) * part); };
  return {between(table.c_l), between(table.c_d), between(table.c_m)};
}

// A plain flap: c_l_delta and c_m_delta per rad at small deflections, c_l_alpha of the section.
template <class T>
struct Flap {
  T c_l_delta{0}, c_m_delta{0}, c_l_alpha{1};
};

// The most lift that a plain flap adds (Dubs; Pusztai 2018, 2.2.1).
inline constexpr double kMostFlapLift = 0.8;

template <class S>
struct FlapEffect {
  S lift;   // added to c_l
  S shift;  // added to the angle of attack, rad
};

// Pusztai 2018, Eq. (2.32): the lift curve moves up by `lift`, which is largest, 0.8, at
// delta = 1.6/c_l_delta, and to the left by `shift`, so that attached flow has the slope c_l_delta
// at all deflections. 3.2 is four times 0.8.
template <class S, class T>
constexpr FlapEffect<S> flap_effect(const Flap<T>& flap, const S& delta) {
  const S size = select(value_of(delta) < T(0), S(-delta), delta);
  const S bent = (flap.c_l_delta * flap.c_l_delta / T(4 * kMostFlapLift)) * size * delta;
  return {flap.c_l_delta * delta - bent, (T(1) / flap.c_l_alpha) * bent};
}

// What is left of a flap's own lift and moment where flow comes at `cosine` of the angle of attack:
// all up to 30 deg, none at 90 deg and in flow from behind.
template <class S>
constexpr S flap_fading(const S& cosine) {
  using T = decltype(value_of(cosine));
  const S square = T(4.0 / 3.0) * cosine * cosine;
  const S front = select(value_of(square) < T(1), square, S(T(1)));
  return select(value_of(cosine) > T(0), front, S(T(0)));
}

}  // namespace alula
