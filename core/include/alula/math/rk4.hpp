#pragma once
// The one integrator: classical Runge-Kutta of fourth order with a fixed step.

namespace alula {

// Advances x from t to t + dt where `k`, the rate at (t, x), is known already; k is used up.
// `derivative(t, x, dx)` writes the rate of x into dx; State is anything with size() and
// operator[], copied on the stack and never grown.
template <class State, class Derivative, class T>
constexpr void rk4_step_from(State& k, Derivative&& derivative, T t, T dt, State& x) {
  using Index = decltype(x.size());
  const Index n = x.size();
  const T half = T(0.5) * dt;
  State sum = k, trial = x;

  for (Index i = 0; i < n; ++i) trial[i] = x[i] + half * k[i];
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

// The same from the state alone.
template <class State, class Derivative, class T>
constexpr void rk4_step(Derivative&& derivative, T t, T dt, State& x) {
  State k = x;
  derivative(t, x, k);
  rk4_step_from(k, derivative, t, dt, x);
}

}  // namespace alula
