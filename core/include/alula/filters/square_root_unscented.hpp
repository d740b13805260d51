#pragma once
// Square-root unscented Kalman filter for flight path reconstruction: the points of the unscented
// filter, but what is carried on is the factor U of P = U'U itself. The prediction triangularizes
// the points' deviations, random walks are rank-one updates, readings are downdates; the covariance
// is squared only to be shown. So deviations may differ by all digits of a number, where a
// covariance bears half of them.
// Source: van der Merwe and Wan 2001, "The square-root unscented Kalman filter for state and
// parameter-estimation", with the weights of unscented.hpp.
#include <alula/filters/unscented.hpp>
#include <alula/math/root_update.hpp>

namespace alula {

template <class T, int R>
class SquareRootUnscented : public Unscented<T, R> {
 public:
  using Unscented<T, R>::x;
  using Unscented<T, R>::P;  // as of the last update, full; written, not read
  using Unscented<T, R>::repairs;

  bool adopt(int n) {
    const int raised = cholesky<R>(P, U_, n);
    repairs += raised > 0 ? raised : 0;
    for (int i = n; i < R; ++i) clear<R>(U_[i]);
    return raised >= 0;
  }

  bool predict(const PathModel<T>& model, const T* u0, const T* u1, T dt) {
    T G[kMotionStates][kInertialInputs];
    path_input_gain(model, x, dt, G);
    draw(model);
    return by_motion<R>(
        model, [&](auto motion) { return predict<decltype(motion)::value>(model, u0, u1, dt, G); });
  }

  int update(const PathModel<T>& model, const T* u, const T* z, T* innovation, T* deviation) {
    const int n = model.states;
    typename Unscented<T, R>::Sensed sensed;
    this->find(model, z, sensed, innovation, deviation);
    int used = 0;
    if (sensed.count > 0) {
      draw(model);
      this->sense(model, u, z, sensed);
      used = sensed.close
                 ? update_carefully(model, sensed, innovation, deviation)
                 : this->take_up(sensed, innovation, deviation, [&](const T* column, T inverse) {
                     alignas(64) T w[R];
                     scale<R>(w, std::sqrt(inverse), column);
                     return root_downdate<R>(U_, w, n);
                   });
    }
    if (used < 0) return used;
    multiply_back<R>(U_, P, n);
    for (int i = 0; i < n; ++i) P[i][i] *= kHeldApart<T>;  // what squaring rounds away
    return used;
  }

 private:
  using Unscented<T, R>::U_;
  using Unscented<T, R>::X_;
  using Unscented<T, R>::D_;
  using Unscented<T, R>::spread_;
  using Unscented<T, R>::kColumns;

  // As Unscented::bound, on the factor: a state's deviations are its column.
  void bound(int i, T most) {
    const T squared = variance(i);
    if (!(squared > most * most)) return;
    const T f = most / std::sqrt(squared);
    for (int k = 0; k <= i; ++k) U_[k][i] *= f;
    ++repairs;
  }
  T variance(int i) const {
    T s = T(0);
    for (int k = 0; k <= i; ++k) s += U_[k][i] * U_[k][i];
    return s;
  }

  void draw(const PathModel<T>& model) {
    const int n = model.states;
    this->each_bound(model, [&](int i, T most) { bound(i, most); });
    const T root = std::sqrt(T(n));
    for (int j = 0; j < n; ++j)
      for (int i = j; i < n; ++i) spread_[i][j] = root * U_[j][i];
  }

  template <int N>
  bool predict(const PathModel<T>& model, const T* u0, const T* u1, T dt,
               const T (*G)[kInertialInputs]) {
    // Columns: differences and sums of opposite points, the mean point, the inputs' noise.
    constexpr int kWide = 2 * R + 8;
    static_assert(kWide >= 2 * R + 1 + kInertialInputs);
    const int n = model.states;
    T A[R][kWide], middle[N], least[R];
    if (!this->template propagate<N>(model, u0, u1, dt, middle)) return false;
    const T half = std::sqrt(T(0.25) / T(n));
    for (int i = 0; i < n; ++i) {
      T* row = A[i];
      clear<kWide>(row);
      if (i < N) {
        for (int k = 0; k < n; ++k) {
          row[k] = D_[i][k];
          row[R + k] = half * (X_[i][k] + X_[i][R + k]);
        }
        row[2 * R] = std::sqrt(T(2)) * middle[i];
        for (int k = 0; k < kInertialInputs && i < kMotionStates; ++k) row[2 * R + 1 + k] = G[i][k];
      } else {
        for (int k = 0; k <= i; ++k) row[k] = U_[k][i];
      }
      T squared = T(0);
      for (int k = 0; k < kWide; ++k) squared += row[k] * row[k];
      // The next points must differ from the mean: no deviation below the state's last digit.
      least[i] = kRootFloor<T> * std::sqrt(squared) +
                 (i < N ? std::numeric_limits<T>::epsilon() * std::abs(x[i]) : T(0));
    }
    const int raised = triangularize<R>(A, n, least, U_);
    if (raised < 0) return false;
    for (int c = N; c < n; ++c) {
      if (model.walk[c] == T(0)) continue;
      T w[R] = {};
      w[c] = std::sqrt(dt) * model.walk[c];
      root_update<R>(U_, w, c, n);
    }
    return true;
  }

  int update_carefully(const PathModel<T>& model, typename Unscented<T, R>::Sensed& sensed,
                       T* innovation, T* deviation) {
    const int n = model.states;
    T X[R][kColumns], least[R];
    for (int i = 0; i < n; ++i) least[i] = kRootFloor<T> * std::sqrt(variance(i));
    const int columns = this->take_up_carefully(model, sensed, X, innovation, deviation);
    if (columns < 0) return -1;
    for (int i = 0; i < n; ++i)
      for (int k = columns; k < kColumns; ++k) X[i][k] = T(0);
    const int raised = triangularize<R>(X, n, least, U_);
    repairs += raised > 0 ? raised : 0;
    return raised < 0 ? -1 : sensed.count;
  }
};

}  // namespace alula
