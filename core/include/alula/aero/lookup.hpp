#pragma once
// Values over a grid of one to three variables, data with the caller.
#include <array>
#include <cstdint>

#include "alula/math/dual.hpp"

namespace alula {

enum class Interpolation : std::uint8_t { linear, cubic };
enum class Outside : std::uint8_t {
  hold,  // the edge's value
  line,  // the straight line through the edge with its slope
};

// A view: breakpoints of each axis increase, at least two; values row by row, the last axis
// fastest. No axes: zero everywhere. shared: a number, 0 to 15, for axes of several tables with the
// same breakpoints at the same variable; -1: none.
template <class T>
struct Lookup {
  const T* values = nullptr;
  std::array<const T*, 3> axis{};
  std::array<int, 3> size{1, 1, 1};
  int axes = 0;
  Interpolation interpolation = Interpolation::linear;
  Outside outside = Outside::hold;
  std::array<std::int8_t, 3> shared{-1, -1, -1};
};

namespace detail {

// Up to four neighbors on one axis and what each counts.
template <class S>
struct Neighbors {
  int first = 0, count = 1;
  S weight[4];
};

// The cell of x: between breakpoint i and i + 1. Never outside, whatever x is.
template <class T>
constexpr int cell(const T* b, int n, T x) {
  int low = 0, high = n - 1;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (b[middle] <= x)
      low = middle;
    else
      high = middle;
  }
  return low;
}

// Slope at breakpoint j of the parabola through it and its neighbors (at an end: the three last),
// as weights of values m - 1, m, m + 1; returns m.
template <class T>
constexpr int parabola_slope(const T* b, int n, int j, T (&weight)[3]) {
  const int m = j < 1 ? 1 : (j > n - 2 ? n - 2 : j);
  const T u = b[m] - b[m - 1], v = b[m + 1] - b[m], twice = T(2) * (b[j] - b[m]);
  weight[0] = (twice - v) / (u * (u + v));
  weight[1] = (v - u - twice) / (u * v);
  weight[2] = (twice + u) / (v * (u + v));
  return m;
}

template <class S, class T>
constexpr Neighbors<S> neighbors(const T* b, int n, const S& x, bool cubic, bool line) {
  const int i = cell(b, n, value_of(x));
  const bool below = value_of(x)<b[0], above = value_of(x)> b[n - 1];
  const T h = b[i + 1] - b[i];
  Neighbors<S> out;
  if (!cubic || n == 2) {
    out.first = i;
    out.count = 2;
    const bool held = !line && (below || above);
    const S part = held ? S(below ? T(0) : T(1)) : S((T(1) / h) * (x - b[i]));
    out.weight[0] = T(1) - part;
    out.weight[1] = part;
    return out;
  }
  // Cubic with the values and slopes at both ends of the cell; outside, value and slope of the
  // edge.
  S at_left, at_right, slope_left, slope_right;
  if (below || above) {
    at_left = S(below ? T(1) : T(0));
    at_right = S(below ? T(0) : T(1));
    const S beyond = line ? S(x - b[below ? 0 : n - 1]) : S(0);
    slope_left = below ? beyond : S(0);
    slope_right = below ? S(0) : beyond;
  } else {
    const S s = (T(1) / h) * (x - b[i]), r = T(1) - s;
    at_right = s * s * (T(3) - T(2) * s);
    at_left = T(1) - at_right;
    slope_left = h * (s * r * r);
    slope_right = -h * (s * s * r);
  }
  out.first = i > 0 ? i - 1 : 0;
  const int last = i + 2 < n ? i + 2 : n - 1;
  out.count = last - out.first + 1;
  for (int k = 0; k < out.count; ++k) out.weight[k] = S(0);
  out.weight[i - out.first] = at_left;
  out.weight[i + 1 - out.first] = at_right;
  T slope[3]{};
  const int left = parabola_slope(b, n, i, slope) - 1 - out.first;
  for (int k = 0; k < 3; ++k) out.weight[left + k] += slope[k] * slope_left;
  const int right = parabola_slope(b, n, i + 1, slope) - 1 - out.first;
  for (int k = 0; k < 3; ++k) out.weight[right + k] += slope[k] * slope_right;
  return out;
}

}  // namespace detail

// Where a point lies on one axis of a table.
template <class S, class T>
constexpr detail::Neighbors<S> on_axis(const Lookup<T>& table, int k, const S& x) {
  const auto i = static_cast<unsigned>(k);
  return detail::neighbors<S>(table.axis[i], table.size[i], x,
                              table.interpolation == Interpolation::cubic,
                              table.outside == Outside::line);
}

// The value where the axes' neighbors are known; those of axes it does not have are not used.
template <class S, class T>
constexpr S lookup(const Lookup<T>& table, const detail::Neighbors<S>& on_a,
                   const detail::Neighbors<S>& on_b, const detail::Neighbors<S>& on_c) {
  if (table.axes == 3 && table.interpolation == Interpolation::linear) {
    // Eight corners without a loop.
    const T* p =
        table.values + (on_a.first * table.size[1] + on_b.first) * table.size[2] + on_c.first;
    const T* q = p + table.size[1] * table.size[2];
    const int row = table.size[2];
    const S &w0 = on_c.weight[0], &w1 = on_c.weight[1];
    const S near =
        on_b.weight[0] * (p[0] * w0 + p[1] * w1) + on_b.weight[1] * (p[row] * w0 + p[row + 1] * w1);
    const S far =
        on_b.weight[0] * (q[0] * w0 + q[1] * w1) + on_b.weight[1] * (q[row] * w0 + q[row + 1] * w1);
    return on_a.weight[0] * near + on_a.weight[1] * far;
  }
  S sum(0);
  for (int i = 0; i < on_a.count; ++i) {
    const T* plane = table.values + (on_a.first + i) * table.size[1] * table.size[2];
    if (table.axes == 1) {
      sum += *plane * on_a.weight[i];
      continue;
    }
    S part(0);
    for (int j = 0; j < on_b.count; ++j) {
      const T* row = plane + (on_b.first + j) * table.size[2];
      if (table.axes == 2) {
        part += *row * on_b.weight[j];
        continue;
      }
      S inner(0);
      for (int k = 0; k < on_c.count; ++k) inner += row[on_c.first + k] * on_c.weight[k];
      part += inner * on_b.weight[j];
    }
    sum += part * on_a.weight[i];
  }
  return sum;
}

// The value at (a, b, c), one argument for each axis; those of axes it does not have are not used.
// Linear: continuous, with kinks at the breakpoints. Cubic: continuous slope, each cell a cubic
// with the slopes of the parabolas through three neighbors; a product of such along the axes.
template <class S, class T>
constexpr S lookup(const Lookup<T>& table, const S& a, const S& b, const S& c) {
  if (table.axes == 0) return S(0);
  const auto on_a = on_axis(table, 0, a);
  detail::Neighbors<S> on_b, on_c;
  if (table.axes > 1) on_b = on_axis(table, 1, b);
  if (table.axes > 2) on_c = on_axis(table, 2, c);
  return lookup(table, on_a, on_b, on_c);
}

// Each lane for itself.
template <class T, int W>
Lanes<T, W> lookup(const Lookup<T>& table, const Lanes<T, W>& a, const Lanes<T, W>& b,
                   const Lanes<T, W>& c) {
  T value[W];
  for (int i = 0; i < W; ++i) value[i] = lookup(table, a[i], b[i], c[i]);
  return Lanes<T, W>::load(value);
}

inline constexpr int kSharedAxes = 16;

// Several tables at one point: those that share an axis and a slot share the search as well.
// `slots`: the point's variables, unchanged while it is in use.
template <class S, class T>
class Lookups {
 public:
  constexpr Lookups() {
    for (Known& known : known_) known.slot = -1;
  }

  constexpr S at(const Lookup<T>& table, const S* slots, int a, int b, int c) {
    if (table.axes == 0) return S(0);
    const auto& on_a = place(table, 0, slots, a);
    const auto& on_b = table.axes > 1 ? place(table, 1, slots, b) : on_a;
    const auto& on_c = table.axes > 2 ? place(table, 2, slots, c) : on_a;
    return lookup(table, on_a, on_b, on_c);
  }

 private:
  struct Known {
    int slot;
    Interpolation interpolation;
    Outside outside;
    detail::Neighbors<S> neighbors;
  };

  constexpr const detail::Neighbors<S>& place(const Lookup<T>& table, int k, const S* slots,
                                              int slot) {
    const int shared = table.shared[static_cast<unsigned>(k)];
    bool alone = shared < 0 || shared >= kSharedAxes;
    for (int j = 0; j < k; ++j)  // a place that this lookup holds already
      alone = alone || table.shared[static_cast<unsigned>(j)] == shared;
    Known& known = known_[alone ? kSharedAxes + k : shared];
    if (alone || known.slot != slot || known.interpolation != table.interpolation ||
        known.outside != table.outside)
      known = {slot, table.interpolation, table.outside, on_axis(table, k, slots[slot])};
    return known.neighbors;
  }

  Known known_[kSharedAxes + 3];  // the last three: axes that are not shared
};

template <class T, int W>
class Lookups<Lanes<T, W>, T> {
 public:
  using L = Lanes<T, W>;
  L at(const Lookup<T>& table, const L* slots, int a, int b, int c) {
    return lookup(table, slots[a], slots[b], slots[c]);
  }
};

}  // namespace alula
