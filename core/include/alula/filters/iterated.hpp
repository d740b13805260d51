#pragma once
// Iterated extended Kalman filter for flight path reconstruction: the update of one instant is
// repeated about its own result until that no longer moves, which is Gauss-Newton on the
// likelihood of state and readings (Bell and Cathey 1993). The prediction is the extended filter's.
// Source: Dittrich 2016, Eq. (3.27) to (3.31).
#include <alula/filters/extended.hpp>
#include <cstring>

namespace alula {

template <class T, int R>
class Iterated : public Extended<T, R> {
 public:
  static constexpr int kMostPasses = 30;
  static constexpr T kSettled = sizeof(T) == 8 ? T(1e-3) : T(1e-2);  // standard deviations
  int unsettled = 0;  // updates that still moved after the last pass

  using Extended<T, R>::x;
  using Extended<T, R>::P;
  using Extended<T, R>::repairs;

  // Innovations and their deviations are those of the prediction: they are what can be white.
  int update(const PathModel<T>& model, const T* u, const T* z, T* innovation, T* deviation) {
    const int n = model.states;
    T base[R], target[R], about[R], step[R], U[R][R], further[kMaxOutputs], spread[kMaxOutputs];
    std::memcpy(before_, P, sizeof P);
    T misfit, share = T(1);
    repairs_before_ = repairs;
    const int used = linear_about(model, u, z, x, step, innovation, deviation, misfit);
    if (used <= 0) return used;
    T least = misfit;
    for (int i = 0; i < n; ++i) {
      base[i] = x[i];
      target[i] = x[i] + step[i];
    }
    bool factored = false;
    for (int pass = 1; pass < kMostPasses; ++pass) {
      for (int i = 0; i < n; ++i) about[i] = base[i] + share * (target[i] - base[i]);
      const bool done = linear_about(model, u, z, about, step, further, spread, misfit) > 0;
      if (done && distance(about, step, n) <= kSettled) {
        for (int i = 0; i < n; ++i) x[i] += step[i];
        return used;
      }
      // A step that makes state and readings together less likely is halved.
      if (!factored && cholesky<R>(before_, U, n) < 0) return -1;
      factored = true;
      misfit += from_prediction(U, about, n);
      if (done && misfit < least) {
        least = misfit;
        share = T(1);
        for (int i = 0; i < n; ++i) {
          base[i] = about[i];
          target[i] = x[i] + step[i];
        }
      } else {
        share *= T(0.5);
      }
    }
    ++unsettled;
    if (linear_about(model, u, z, base, step, further, spread, misfit) < 0) return -1;
    for (int i = 0; i < n; ++i) x[i] = base[i];
    return used;
  }

 private:
  using Extended<T, R>::H_;
  alignas(64) T before_[R][R];  // P before the update
  int repairs_before_ = 0;

  // The update from x and `before_` with the readings linear about `about`, Eq. (3.28). misfit: of
  // the readings at `about`, in their variances.
  int linear_about(const PathModel<T>& model, const T* u, const T* z, const T* about, T* step,
                   T* innovation, T* deviation, T& misfit) {
    T predicted[kMaxOutputs];
    std::memcpy(P, before_, sizeof P);
    repairs = repairs_before_;
    path_outputs_jacobian<R>(model, about, u, predicted, H_);
    misfit = T(0);
    for (int s = 0; s < model.sensors.size(); ++s) {
      if (!std::isfinite(z[s])) continue;
      const T e = wrapped(model.sensors[s].quantity, z[s] - predicted[s]);
      misfit += e * e / model.sensors[s].variance;
      for (int j = 0; j < model.states; ++j) predicted[s] += H_[s][j] * (x[j] - about[j]);
    }
    return this->take_up(model, z, predicted, step, innovation, deviation);
  }

  // (about - x)' before^-1 (about - x), U the factor of `before_`.
  T from_prediction(const T (*U)[R], const T* about, int n) const {
    T d[R], total = T(0);
    for (int i = 0; i < n; ++i) d[i] = about[i] - x[i];
    for (int i = 0; i < n; ++i) {  // U' y = d
      d[i] /= U[i][i];
      total += d[i] * d[i];
      for (int j = i + 1; j < n; ++j) d[j] -= U[i][j] * d[i];
    }
    return total;
  }

  // How far x + step is from `about`, largest of the states, in standard deviations.
  T distance(const T* about, const T* step, int n) const {
    T most = T(0);
    for (int i = 0; i < n; ++i) {
      const T digit = T(4) * std::numeric_limits<T>::epsilon() * std::abs(x[i]);
      const T d = (std::abs(x[i] + step[i] - about[i]) - digit) / std::sqrt(P[i][i]);
      if (!(d <= most)) most = d;  // also where it is no number
    }
    return most;
  }
};

}  // namespace alula
