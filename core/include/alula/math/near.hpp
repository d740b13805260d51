#pragma once
// Sine and cosine near an angle whose own are known: half the work of computing them anew.
#include <alula/math/dual.hpp>
#include <alula/math/lanes.hpp>

namespace alula {

// Sine and cosine of x + d from those of x, for numbers and lanes. Taylor's series as far as
// doubles see at |d| = 1/32; where a lane is farther, all are computed anew.
template <class S>
inline void sincos_near(const S& sine, const S& cosine, const S& x, const S& d, S& s, S& c) {
  const S z = d * d;
  if (any(z > S(1.0 / 1024))) return sincos(x + d, s, c);
  const S turn = d + d * z * (S(-1.0 / 6) + z * (S(1.0 / 120) - z * S(1.0 / 5040)));
  const S rest = z * (S(-0.5) + z * (S(1.0 / 24) - z * S(1.0 / 720)));  // cos d - 1
  s = sine + (sine * rest + cosine * turn);
  c = cosine + (cosine * rest - sine * turn);
}

}  // namespace alula
