#pragma once
// A value held between two bounds; the slopes of a dual number end at the bound.
#include <alula/math/dual.hpp>

namespace alula {

template <class S, class T>
constexpr S limited(const S& x, const T& low, const T& high) {
  if (value_of(x) < low) return S(low);
  if (value_of(x) > high) return S(high);
  return x;
}

}  // namespace alula
