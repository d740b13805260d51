#pragma once
// Means and covariances over the sigma points of one quantity: a row of 2 R slots, the points on
// the plus side and then those on the minus side along the n columns of a factor; the slots from n
// on repeat the mean point.
#include <alula/math/rows.hpp>
#include <cmath>

namespace alula {

// Turns the values of all slots of one row into deviations from their mean, which it returns.
// `middle` is the mean point's value; slots that repeat it add nothing. `difference` gets the
// weighted differences of opposite points.
template <int R, class T>
inline T center_points(T* row, T middle, int n, T* difference) {
  const T wi = T(0.5) / T(n), weight = wi * std::sqrt(T(n));
  using L = Lanes<T, kLanes>;
  L total(T(0));  // of small differences, which keep their digits
  for (int k = 0; k < 2 * R; k += kLanes) total += L::load(row + k) - L(middle);
  const T mean = middle + wi * sum(total);
  for (int k = 0; k < R; k += kLanes) {
    const L plus = L::load(row + k), minus = L::load(row + R + k);
    (L(weight) * (plus - minus)).store(difference + k);
    (plus - L(mean)).store(row + k);
    (minus - L(mean)).store(row + R + k);
  }
  return mean;
}

// out[j] for j in [from, count): covariance of rows `from` and j of deviations. The sums run
// over all slots; those that repeat the mean are more than the mean's weight of 2 by a known
// number. `middle` is the deviation of the mean point.
template <int R, class T>
inline void point_products(const T (*rows)[2 * R], int from, int count, int n, const T* middle,
                           T* out) {
  const T wi = T(0.5) / T(n), mean_weight = T(2) - wi * T(2 * (R - n));
  const int last = count - 1;
  for (int j = from; j < count; j += 4) {
    T s[4];
    dot4<2 * R>(rows[from], rows[j], rows[j + 1 < last ? j + 1 : last],
                rows[j + 2 < last ? j + 2 : last], rows[j + 3 < last ? j + 3 : last], s);
    for (int k = 0; k < 4 && j + k < count; ++k)
      out[j + k] = wi * s[k] + mean_weight * middle[from] * middle[j + k];
  }
}

}  // namespace alula
