#pragma once
// The motion at one instant with its derivatives: f(x, C, u) is differentiated by dual numbers over
// states and coefficients, and dC/dp is the regressor itself, so that the sensitivities to any
// number of parameters follow from S' = A S + B C_p (step_slopes.hpp). Jategaonkar, Flight Vehicle
// System Identification, 2nd ed. 2015, Sec. 4.12 (sensitivities); Klein and Morelli, Aircraft
// System Identification, 2nd ed. 2016, Eq. (6.30) to (6.33).
#include "alula/estimate/variational_plan.hpp"

namespace alula {

// Everything at one instant: rates and specific forces with their slopes along the kernel's
// directions, and the regressors.
template <Axes axes>
struct Instant {
  using D = Dual<double, Kernel<axes>::kDirections>;
  MotionRates<D> y;
  double regressor[kMaxTerms];
};

namespace detail {

// The base variables of the table.
template <Axes axes, class A, class L, class M, class P>
inline void base_slots(const VariationalPlan<axes>& plan, const MotionState<L, M, P>& s,
                       const double* u, A* slots) {
  const MeasuredManeuver& m = *plan.m;
  slots[kOne] = A(1.0);
  if (plan.uses[kV]) slots[kV] = A(s.V);
  if (plan.uses[kAlpha]) slots[kAlpha] = A(s.alpha);
  if (plan.uses[kBeta]) slots[kBeta] = A(s.beta);
  if (plan.uses[kPhat] || plan.uses[kQhat] || plan.uses[kRhat]) {
    const L half_per_V = 0.5 / s.V;
    if (plan.uses[kPhat]) slots[kPhat] = A(m.b * (half_per_V * s.p));
    if (plan.uses[kQhat]) slots[kQhat] = A(m.c * (half_per_V * s.q));
    if (plan.uses[kRhat]) slots[kRhat] = A(m.b * (half_per_V * s.r));
  }
  for (int i = 0; i < 5; ++i)
    if (plan.uses[kDe + i]) slots[kDe + i] = A(u[kInControls + i]);
  if (plan.uses[kMach]) slots[kMach] = A(u[kInSlowness] * s.V);
  if (plan.uses[kWash]) slots[kWash] = A(0.0);  // a maneuver does not record it
}

// The directions as rows of slopes: a seed is added whole, since an element put into a register
// would have to go through memory.
template <int N>
struct Directions {
  double row[N][N] = {};
  constexpr Directions() {
    for (int i = 0; i < N; ++i) row[i][i] = 1.0;
  }
};
template <int N>
inline constexpr Directions<N> kDirectionRows{};

template <int N>
inline void seed(Dual<double, N>& x, int direction) {
  using Block = typename Dual<double, N>::Block;
  for (int i = 0; i < Dual<double, N>::kBlocks; ++i)
    x.slope[i] += Block::load(kDirectionRows<N>.row[direction] + 4 * i);
}

// One coefficient with a slope of one along its own direction, beside what the states do to it.
template <Axes axes, class R, class A>
inline R seeded_force(const VariationalPlan<axes>& plan, int force, const A* slots,
                      const double* u) {
  A sum(u[kInCoefficients + Kernel<axes>::coefficient[force]]);
  const auto* end = plan.terms[force] + plan.count[force];
  for (const auto* term = plan.terms[force]; term != end; ++term)
    sum += term->value * slots[term->slot];
  R out(sum);
  seed(out, Kernel<axes>::along_force[force]);
  return out;
}

}  // namespace detail

// u: a row of inputs; x: the kernel's variables, states and others.
template <Axes axes>
inline void evaluate(const VariationalPlan<axes>& plan, const double* x, const double* u,
                     Instant<axes>& out) {
  using K = Kernel<axes>;
  using D = typename Instant<axes>::D;
  using A = Dual<double, K::kAir>;
  using L = std::conditional_t<axes == Axes::lateral, double, A>;
  using M = std::conditional_t<axes == Axes::longitudinal, double, A>;
  using P = std::conditional_t<axes == Axes::lateral, double, D>;
  const MeasuredManeuver& m = *plan.m;

  const auto seeded = [&]<class R>(int i, R zero) {
    zero.value = plan.is_state[i] ? x[i] : u[kInMotion + K::state[i]];
    if (plan.is_state[i]) detail::seed(zero, K::along_state[i]);
    return zero;
  };
  const auto air = [&](int i) { return seeded(i, A(0.0)); };
  MotionState<L, M, P> s;
  if constexpr (axes == Axes::longitudinal)
    s = {air(0),      air(1),      air(2),        u[kMotionBeta],
         u[kMotionP], u[kMotionR], u[kMotionPhi], seeded(3, D(0.0))};
  else if constexpr (axes == Axes::lateral)
    s = {u[kMotionV], u[kMotionAlpha], u[kMotionQ], air(0),
         air(1),      air(2),          air(3),      u[kMotionTheta]};
  else
    s = {air(0), air(1), air(4), air(2), air(3), air(5), air(6), seeded(7, D(0.0))};

  // Each coefficient has a direction of its own. The drag that uses the lift takes up the lift's.
  A slots[kMaxSlots];
  detail::base_slots<axes>(plan, s, u, slots);
  constexpr int lift = force_of<axes>(kLift);
  bool has_lift = false;
  A CL;
  fill_slots(*m.table, slots, m.lookups, [&](const A* filled) {
    if constexpr (lift < 0) return A(u[kInCoefficients + kLift]);
    if (!has_lift) CL = detail::seeded_force<axes, A>(plan, lift < 0 ? 0 : lift, filled, u);
    has_lift = true;
    return CL;
  });
  std::array<D, kCoefficients> C;
  for (unsigned c = 0; c < kCoefficients; ++c) C[c] = D(u[kInCoefficients + c]);
  for (int c = 0; c < K::kForces; ++c)
    C[static_cast<unsigned>(K::coefficient[c])] =
        c == lift && has_lift ? D(CL) : detail::seeded_force<axes, D>(plan, c, slots, u);
  flight_equations<axes>(s, C, u, m, out.y);

  for (int k = 0; k < plan.regressors; ++k) out.regressor[k] = slots[plan.regressor[k]].value;
}

// What is no state does not move; states are pulled to z, the measured outputs.
template <Axes axes>
inline void correct(const VariationalPlan<axes>& plan, const double* x, const double* z,
                    Instant<axes>& here) {
  using K = Kernel<axes>;
  if (!plan.corrected) return;
  for (int i = 0; i < K::kStates; ++i) {
    auto& rate = here.y.rate[K::state[i]];
    if (!plan.is_state[i]) rate = 0.0;
    if (plan.pull[i] == 0.0) continue;
    const double reading = z[plan.pull_output[i]];
    if (reading != reading) continue;
    const int own = K::along_state[i];
    rate.value += plan.pull[i] * (reading - x[i]);
    rate.set_slope(own, rate.slope_of(own) - plan.pull[i]);
  }
}

}  // namespace alula
