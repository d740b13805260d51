#pragma once
// The one integrator: classical Runge-Kutta of fourth order with a fixed step.

namespace alula {

// Advances x from t to t + dt. `derivative(t, x, dx)` writes the rate of x into dx; State is
// anything with size() and operator[], copied on the stack and never grown.
template <class State, class Derivative, class T>
constexpr void rk4_step(Derivative&& derivative, T t, T dt, State& x) {
  using Index = decltype(x.size());
  const Index n = x.size();
  const T half = T(0.5) * dt;
  State k = x, sum = x, trial = x;

  derivative(t, x, k);
  for (Index i = 0; i < n; ++i) {
    sum[i] = k[i];
    trial[i] = x[i] + half * k[i];
  }
  derivative(t + half, trial, k);
  for (Index i = 0; i < n; ++i) {
    sum[i] += k[i] + k[i];
    trial[i] = x[i] + half * k[i];
  }
  derivative(t + half, trial, k);
  for (Index i = 0; i < n; ++i) {
    sum[i] += k[i] + k[i];
    trial[i] = x[i] + dt * k[i];
  }
  derivative(t + dt, trial, k);
  for (Index i = 0; i < n; ++i) x[i] += (dt / T(6)) * (sum[i] + k[i]);
}

}  // namespace alula
