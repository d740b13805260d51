#pragma once
// A curve through up to 24 points: monotone cubic pieces between them, straight lines outside.
#include <array>
#include <limits>

#include "alula/math/dual.hpp"

namespace alula {

inline constexpr int kMaxKnots = 24;

// Piece i begins at knot[i] and is a cubic in the distance from there: y, slope and two higher
// coefficients. The last one is the line that goes on behind the last knot. Knots that are not used
// are infinite, so that a search never ends there. Empty: zero everywhere.
template <class T>
struct Curve {
  static constexpr int kRoom = 32;
  std::array<T, kRoom> knot = no_knots();
  std::array<std::array<T, 4>, kMaxKnots> piece{};
  int count = 0;
  unsigned search = 1;  // first stride of the search: a power of two, twice it is above count

  static constexpr std::array<T, kRoom> no_knots() {
    std::array<T, kRoom> all{};
    for (T& x : all) x = std::numeric_limits<T>::infinity();
    return all;
  }
  constexpr T first() const { return knot[0]; }
  constexpr T last() const { return knot[static_cast<unsigned>(count > 0 ? count - 1 : 0)]; }
};

// Builds the curve through n points of increasing x; false, and `out` as it was, where there are
// none or too many or x does not increase. Slopes at inner knots are weighted harmonic means of the
// chords' slopes, zero at extremes, so that the curve has no extreme that the points do not have
// (Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5, 1984); at the ends the three-point formula,
// limited likewise. The first derivative is continuous everywhere, at the ends too.
template <class T>
constexpr bool make_curve(const T* x, const T* y, int n, Curve<T>& out) {
  if (n < 1 || n > kMaxKnots) return false;
  for (int i = 0; i + 1 < n; ++i)
    if (!(x[i + 1] > x[i])) return false;
  std::array<T, kMaxKnots> h{}, chord{}, slope{};
  for (unsigned i = 0; i + 1 < static_cast<unsigned>(n); ++i) {
    h[i] = x[i + 1] - x[i];
    chord[i] = (y[i + 1] - y[i]) / h[i];
  }
  const auto at_end = [](T h0, T h1, T d0, T d1) {
    const T s = ((T(2) * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if (!(s * d0 > T(0))) return T(0);
    const bool too_steep = d0 * d1 < T(0) && s * s > T(9) * d0 * d0;
    return too_steep ? T(3) * d0 : s;
  };
  const unsigned end = static_cast<unsigned>(n) - 1;
  if (n == 2) slope[0] = slope[1] = chord[0];
  if (n > 2) {
    for (unsigned i = 1; i < end; ++i) {
      if (!(chord[i - 1] * chord[i] > T(0))) continue;
      const T before = T(2) * h[i] + h[i - 1], after = h[i] + T(2) * h[i - 1];
      slope[i] = (before + after) / (before / chord[i - 1] + after / chord[i]);
    }
    slope[0] = at_end(h[0], h[1], chord[0], chord[1]);
    slope[end] = at_end(h[end - 1], h[end - 2], chord[end - 1], chord[end - 2]);
  }
  out = Curve<T>{};
  out.count = n;
  while (2 * out.search <= static_cast<unsigned>(n)) out.search *= 2;
  for (unsigned i = 0; i <= end; ++i) {
    out.knot[i] = x[i];
    const T k = i < end ? T(1) / h[i] : T(0);
    out.piece[i] = {y[i], slope[i],
                    i < end ? (T(3) * chord[i] - T(2) * slope[i] - slope[i + 1]) * k : T(0),
                    i < end ? (slope[i] + slope[i + 1] - T(2) * chord[i]) * k * k : T(0)};
  }
  return true;
}

template <class S, class T>
constexpr S curve(const Curve<T>& c, const S& x) {
  const T at = value_of(x);
  unsigned i = 0;
  for (unsigned step = c.search; step > 0; step /= 2) i += c.knot[i + step] <= at ? step : 0u;
  if (i >= static_cast<unsigned>(c.count)) i = 0;  // an infinite argument
  const auto& p = c.piece[i];
  if (c.count == 0) return S(0);
  const S d = x - c.knot[i];
  if (at < c.knot[0]) return p[0] + p[1] * d;
  return p[0] + d * (p[1] + d * (p[2] + d * p[3]));
}

// In lanes each knot is compared with all of them, then each lane takes its own piece.
template <class T, int W>
Lanes<T, W> curve(const Curve<T>& c, const Lanes<T, W>& x) {
  using L = Lanes<T, W>;
  const L none(T(0)), one(T(1));
  L passed = none;
  for (unsigned i = 1; i < static_cast<unsigned>(c.count); ++i)
    passed += select(x < L(c.knot[i]), none, one);
  unsigned piece[W];
  for (int w = 0; w < W; ++w) piece[w] = static_cast<unsigned>(passed[w]);
  const auto coefficient = [&](unsigned k) {
    return L::from([&](int w) { return c.piece[piece[w]][k]; });
  };
  const L d = x - L::from([&](int w) { return c.knot[piece[w]]; });
  const L line = coefficient(0) + coefficient(1) * d;
  if (c.count == 0) return L(T(0));
  const L bent = d * d * (coefficient(2) + d * coefficient(3));
  return line + select(x < L(c.knot[0]), L(T(0)), bent);
}

}  // namespace alula
