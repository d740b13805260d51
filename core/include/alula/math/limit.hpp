#pragma once
// A value held between two bounds; the slopes of a dual number end at the bound.
#include <alula/math/dual.hpp>

namespace alula {

template <class S, class T>
constexpr S limited(const S& x, const T& low, const T& high) {
  return select(value_of(x) < low, S(low), select(value_of(x) > high, S(high), x));
}

}  // namespace alula
