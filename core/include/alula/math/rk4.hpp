#pragma once
// The one integrator: classical Runge-Kutta of fourth order with a fixed step.

namespace alula {

// Advances x from t to t + dt where `k`, the rate at (t, x), is known already; k is used up.
// `derivative(t, x, dx)` writes the rate of x into dx; State is anything with size() and
// operator[], copied on the stack and never grown. The three further stages are one loop, so that
// a long derivative is there once.
template <class State, class Derivative, class T>
constexpr void rk4_step_from(State& k, Derivative&& derivative, T t, T dt, State& x) {
  using Index = decltype(x.size());
  const Index n = x.size();
  const T half = T(0.5) * dt, sixth = dt / T(6);
  State sum = k, trial = x;
  for (Index i = 0; i < n; ++i) trial[i] = x[i] + half * k[i];
  for (int stage = 1; stage < 4; ++stage) {
    derivative(stage == 3 ? t + dt : t + half, trial, k);
    if (stage == 3) break;
    const T next = stage == 1 ? half : dt;
    for (Index i = 0; i < n; ++i) {
      sum[i] += k[i] + k[i];
      trial[i] = x[i] + next * k[i];
    }
  }
  for (Index i = 0; i < n; ++i) x[i] += sixth * (sum[i] + k[i]);
}

// The same from the state alone.
template <class State, class Derivative, class T>
constexpr void rk4_step(Derivative&& derivative, T t, T dt, State& x) {
  State k = x;
  derivative(t, x, k);
  rk4_step_from(k, derivative, t, dt, x);
}

}  // namespace alula
