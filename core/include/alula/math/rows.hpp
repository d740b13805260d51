#pragma once
// Operations on matrix rows of fixed length R, a multiple of kLanes: whole registers, no remainder
// and no branch. What lies beyond a row's used length is zero and stays zero.
#include <alula/math/capacity.hpp>
#include <alula/math/lanes.hpp>

namespace alula {

// y += f x
template <int R, class T>
inline void add_scaled(T* y, T f, const T* x) {
  using L = Lanes<T, kLanes>;
  static_assert(R % kLanes == 0);
  const L factor(f);
  for (int k = 0; k < R; k += kLanes) (L::load(y + k) + factor * L::load(x + k)).store(y + k);
}

// y += f x where nothing before `first` counts: the left half is left out where it can be.
template <int R, class T>
inline void add_scaled_from(int first, T* y, T f, const T* x) {
  constexpr int half = R / 2 / kLanes * kLanes;
  if (first < half)
    add_scaled<R>(y, f, x);
  else
    add_scaled<R - half>(y + half, f, x + half);
}

// y = f x
template <int R, class T>
inline void scale(T* y, T f, const T* x) {
  using L = Lanes<T, kLanes>;
  const L factor(f);
  for (int k = 0; k < R; k += kLanes) (factor * L::load(x + k)).store(y + k);
}

template <int R, class T>
inline void clear(T* y) {
  for (int k = 0; k < R; k += kLanes) Lanes<T, kLanes>(T(0)).store(y + k);
}

// Sums of a b, a b2, a b3, a b4: four at once hide the adders' latency.
template <int R, class T>
inline void dot4(const T* a, const T* b, const T* b2, const T* b3, const T* b4, T* out) {
  using L = Lanes<T, kLanes>;
  L s(T(0)), s2(T(0)), s3(T(0)), s4(T(0));
  for (int k = 0; k < R; k += kLanes) {
    const L x = L::load(a + k);
    s += x * L::load(b + k);
    s2 += x * L::load(b2 + k);
    s3 += x * L::load(b3 + k);
    s4 += x * L::load(b4 + k);
  }
  out[0] = sum(s);
  out[1] = sum(s2);
  out[2] = sum(s3);
  out[3] = sum(s4);
}

}  // namespace alula
