#pragma once
// Iterated extended Kalman filter for flight path reconstruction: the update of one instant is
// repeated about its own result until that no longer moves, which is Gauss-Newton on the
// likelihood of state and readings (Bell and Cathey 1993). The prediction is the extended filter's.
// Source: Dittrich 2016, Eq. (3.27) to (3.31).
#include <alula/filters/extended.hpp>

namespace alula {

template <class T, int R>
class Iterated : public Extended<T, R> {
 public:
  static constexpr int kMostPasses = 20;
  static constexpr T kSettled = sizeof(T) == 8 ? T(1e-4) : T(1e-2);  // standard deviations
  // Updates that still moved after the last pass; those by more than a standard deviation are the
  // extended filter's.
  int unsettled = 0;

  using Extended<T, R>::x;
  using Extended<T, R>::P;
  using Extended<T, R>::repairs;

  // Innovations and their deviations are those of the prediction: they are what can be white.
  int update(const PathModel<T>& model, const T* u, const T* z, T* innovation, T* deviation) {
    const int n = model.states, before = repairs;
    T about[R], step[R], further[kMaxOutputs], spread[kMaxOutputs];
    std::memcpy(before_, P, sizeof P);
    for (int i = 0; i < n; ++i) about[i] = x[i];
    int used = linear_about(model, u, z, about, step, innovation, deviation);
    if (used <= 0) return used;
    T last = T(1e30), moved = T(0);
    for (int pass = 1; pass < kMostPasses; ++pass) {
      // A step that is no shorter than the one before it is halved: no going round in circles.
      moved = distance(about, step, n);
      if (!(moved < T(1e30)) || moved <= kSettled) break;
      const T share = pass > 1 && !(moved < last) ? T(0.5) : T(1);
      for (int i = 0; i < n; ++i) about[i] += share * (x[i] + step[i] - about[i]);
      last = moved;
      std::memcpy(P, before_, sizeof P);
      repairs = before;
      used = linear_about(model, u, z, about, step, further, spread);
      if (used < 0) break;
    }
    if (used >= 0) moved = distance(about, step, n);
    if (used < 0 || !(moved <= kSettled)) {
      ++unsettled;
      if (used < 0 || !(moved <= T(1))) {
        std::memcpy(P, before_, sizeof P);
        repairs = before;
        used = linear_about(model, u, z, x, step, further, spread);
      }
    }
    for (int i = 0; i < n; ++i) x[i] += step[i];
    return used;
  }

 private:
  using Extended<T, R>::H_;
  using Extended<T, R>::before_;

  // The update from x and P with the readings linear about `about`, Eq. (3.28).
  int linear_about(const PathModel<T>& model, const T* u, const T* z, const T* about, T* step,
                   T* innovation, T* deviation) {
    T predicted[kMaxOutputs];
    path_outputs_jacobian<R>(model, about, u, predicted, H_);
    for (int s = 0; s < model.sensors.size(); ++s)
      for (int j = 0; j < model.states; ++j) predicted[s] += H_[s][j] * (x[j] - about[j]);
    return this->take_up(model, z, predicted, step, innovation, deviation);
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
