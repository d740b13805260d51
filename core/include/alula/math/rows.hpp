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

namespace detail {
template <class L, class T>
inline L weighted_at(int k, T f, const T* x) {
  return L(f) * L::load(x + k);
}
template <class L, class T, class... Rest>
inline L weighted_at(int k, T f, const T* x, const Rest&... rest) {
  return L(f) * L::load(x + k) + weighted_at<L>(k, rest...);
}
}  // namespace detail

// y = f x + f2 x2 + ..., each factor before its row.
template <int R, class T, class... Rest>
inline void combine(T* y, T f, const T* x, const Rest&... rest) {
  using L = Lanes<T, kLanes>;
  for (int k = 0; k < R; k += kLanes) detail::weighted_at<L>(k, f, x, rest...).store(y + k);
}

// y += f[0] rows[0] + f[1] rows[1] + ... over `count` rows, summed in registers in that order. The
// factors are `stride` apart; columns before First are left as they are.
template <int R, int First = 0, int C, class T>
inline void add_rows(T* y, const T* f, const T (*rows)[C], int count, int stride = 1) {
  using L = Lanes<T, kLanes>;
  constexpr int begin = First / kLanes * kLanes;
  static_assert(R % kLanes == 0 && R <= C);
  [&]<int... b>(std::integer_sequence<int, b...>) {
    L sum[] = {L::load(y + begin + b * kLanes)...};
    for (int i = 0; i < count; ++i) {
      const L factor(f[i * stride]);
      ((sum[b] += factor * L::load(&rows[i][begin + b * kLanes])), ...);
    }
    (sum[b].store(y + begin + b * kLanes), ...);
  }(std::make_integer_sequence<int, (R - begin) / kLanes>());
}

// The same where nothing before `first` counts.
template <int R, class T>
inline void add_rows_from(int first, T* y, const T* f, const T (*rows)[R], int count,
                          int stride = 1) {
  if (first < R / 2)
    add_rows<R>(y, f, rows, count, stride);
  else
    add_rows<R, R / 2>(y, f, rows, count, stride);
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
