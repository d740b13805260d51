#pragma once
// The motion and its sensitivities to any number of parameters: f(x, C, u) is differentiated once
// by dual numbers over states and coefficients; dC/dp is the regressor itself; S' = A S + B C_p.
// Jategaonkar, Flight Vehicle System Identification, 2nd ed. 2015, Sec. 4.12 (sensitivities);
// Klein and Morelli, Aircraft System Identification, 2nd ed. 2016, Eq. (6.30) to (6.33).
#include <cstring>

#include "alula/estimate/flight_equations.hpp"
#include "alula/math/lanes.hpp"

namespace alula {

// What a kernel differentiates along: its states, then its coefficients.
template <Axes axes>
struct Kernel {
  static constexpr int kStates = 4, kForces = 3, kDirections = 8;
  static constexpr int state[4] = {kMotionV, kMotionAlpha, kMotionTheta, kMotionQ};
  static constexpr int coefficient[3] = {0, 2, 4};
};
template <>
struct Kernel<Axes::lateral> {
  static constexpr int kStates = 4, kForces = 3, kDirections = 8;
  static constexpr int state[4] = {kMotionBeta, kMotionP, kMotionR, kMotionPhi};
  static constexpr int coefficient[3] = {1, 3, 5};
};
template <>
struct Kernel<Axes::six> {
  static constexpr int kStates = 8, kForces = 6, kDirections = 16;
  static constexpr int state[8] = {kMotionV, kMotionAlpha, kMotionBeta, kMotionP,
                                   kMotionQ, kMotionR,     kMotionPhi,  kMotionTheta};
  static constexpr int coefficient[6] = {0, 1, 2, 3, 4, 5};
};

// Rows of sensitivities: in blocks of four, as many as the parameters need.
using Four = Lanes<double, 4>;
inline constexpr int kBlocks = kMaxParameters / 4;
using SensitivityRow = Four[kBlocks];

// The motion at one instant and its derivatives by the parameters.
template <Axes axes>
struct Sensitive {
  double x[Kernel<axes>::kStates];
  SensitivityRow S[Kernel<axes>::kStates];
};

// What a run needs beside the maneuver, found once: which slots feed which parameter.
template <Axes axes>
struct VariationalPlan {
  const MeasuredManeuver* m;
  const double* values;  // of all terms
  int blocks;
  bool uses[kVariables];
  int free_count;
  struct Free {
    int force, slot, column;
    double weight;
  } free[kMaxTerms];
  bool is_state[Kernel<axes>::kStates];
  double pull[Kernel<axes>::kStates];
  int pull_output[Kernel<axes>::kStates];  // place among the outputs, -1: none
};

template <Axes axes>
inline int force_of(int coefficient) {
  for (int c = 0; c < Kernel<axes>::kForces; ++c)
    if (Kernel<axes>::coefficient[c] == coefficient) return c;
  return -1;
}

template <Axes axes>
VariationalPlan<axes> variational_plan(const MeasuredManeuver& m, const double* values) {
  VariationalPlan<axes> plan{};
  plan.m = &m;
  plan.values = values;
  plan.blocks = (m.columns + 3) / 4;
  const TermTable& table = *m.table;
  for (int k = 0; k < table.term_count; ++k) {
    const Term& term = table.terms[static_cast<unsigned>(k)];
    if (term.slot < kVariables) plan.uses[term.slot] = true;
    const int force = force_of<axes>(term.coefficient);
    if (m.term_column[k] >= 0 && force >= 0)
      plan.free[plan.free_count++] = {force, term.slot, m.term_column[k], m.term_weight[k]};
  }
  for (int i = 0; i < table.step_count; ++i) {
    const Step& step = table.steps[static_cast<unsigned>(i)];
    for (int slot : {int{step.a}, int{step.b}, int{step.c}})
      if (slot < kVariables) plan.uses[slot] = true;
  }
  for (int i = 0; i < Kernel<axes>::kStates; ++i) {
    const int variable = Kernel<axes>::state[i];
    plan.is_state[i] = m.is_state[variable];
    plan.pull_output[i] = -1;
    for (int o = 0; o < m.outputs; ++o)
      if (m.output[o] == variable && m.pull[variable] > 0.0) plan.pull_output[i] = o;
    plan.pull[i] = plan.pull_output[i] < 0 ? 0.0 : m.pull[variable];
  }
  return plan;
}

// Everything at one instant: rates and specific forces with their slopes, and dC/dp.
template <Axes axes>
struct Instant {
  using D = Dual<double, Kernel<axes>::kDirections>;
  MotionRates<D> y;
  SensitivityRow by_parameter[Kernel<axes>::kForces];  // of the coefficients, at fixed state
};

// u: a row of inputs; x: the kernel's variables, states and others.
template <Axes axes>
inline void evaluate(const VariationalPlan<axes>& plan, const double* x, const double* u,
                     Instant<axes>& out) {
  using K = Kernel<axes>;
  using D = typename Instant<axes>::D;
  using L = std::conditional_t<axes == Axes::lateral, double, D>;
  using M = std::conditional_t<axes == Axes::longitudinal, double, D>;
  const MeasuredManeuver& m = *plan.m;

  D seeded[K::kStates];
  for (int i = 0; i < K::kStates; ++i)
    seeded[i] = plan.is_state[i] ? D::variable(x[i], i) : D(u[kInMotion + K::state[i]]);
  MotionState<L, M> s;
  if constexpr (axes == Axes::longitudinal)
    s = {seeded[0],      seeded[1],   seeded[2],   seeded[3],
         u[kMotionBeta], u[kMotionP], u[kMotionR], u[kMotionPhi]};
  else if constexpr (axes == Axes::lateral)
    s = {u[kMotionV], u[kMotionAlpha], u[kMotionTheta], u[kMotionQ],
         seeded[0],   seeded[1],       seeded[2],       seeded[3]};
  else
    s = {seeded[0], seeded[1], seeded[7], seeded[4], seeded[2], seeded[3], seeded[5], seeded[6]};

  D slots[kMaxSlots];
  slots[kOne] = D(1.0);
  const L half_per_V = 0.5 / s.V;
  if (plan.uses[kV]) slots[kV] = D(s.V);
  if (plan.uses[kAlpha]) slots[kAlpha] = D(s.alpha);
  if (plan.uses[kBeta]) slots[kBeta] = D(s.beta);
  if (plan.uses[kPhat]) slots[kPhat] = D(m.b * (half_per_V * s.p));
  if (plan.uses[kQhat]) slots[kQhat] = D(m.c * (half_per_V * s.q));
  if (plan.uses[kRhat]) slots[kRhat] = D(m.b * (half_per_V * s.r));
  for (int i = 0; i < 5; ++i)
    if (plan.uses[kDe + i]) slots[kDe + i] = D(u[kInControls + i]);
  if (plan.uses[kMach]) slots[kMach] = D(u[kInSlowness] * s.V);

  // Each coefficient has a direction of its own, beside what the states do to it. The drag that
  // uses the lift thereby takes up the lift's direction.
  const TermTable& table = *m.table;
  const auto seed = [](D& c, int which) {
    const int force = force_of<axes>(which);
    if (force >= 0) c.set_slope(K::kStates + force, c.slope_of(K::kStates + force) + 1.0);
  };
  fill_slots(table, slots, m.lookups, [&](const D* filled) {
    D lift = coefficient(table, plan.values, filled, kLift) + u[kInCoefficients + kLift];
    seed(lift, kLift);
    return lift;
  });
  std::array<D, kCoefficients> C = coefficients(table, plan.values, slots);
  for (int c = 0; c < kCoefficients; ++c) {
    C[static_cast<unsigned>(c)].value += u[kInCoefficients + c];
    seed(C[static_cast<unsigned>(c)], c);
  }
  flight_equations<axes, D>(s, C, u, m, out.y);

  for (auto& row : out.by_parameter)
    for (int j = 0; j < plan.blocks; ++j) row[j] = Four(0.0);
  for (int k = 0; k < plan.free_count; ++k) {
    const auto& f = plan.free[k];
    Four& block = out.by_parameter[f.force][f.column / 4];
    block.set(f.column % 4, block[f.column % 4] + f.weight * slots[f.slot].value);
  }
}

// A quantity's derivatives by the parameters: through the states and through the coefficients.
template <Axes axes>
inline void total_slope(const VariationalPlan<axes>& plan, const typename Instant<axes>::D& y,
                        const SensitivityRow* S, const Instant<axes>& at, Four* out) {
  using K = Kernel<axes>;
  for (int j = 0; j < plan.blocks; ++j) {
    Four sum(0.0);
    for (int i = 0; i < K::kStates; ++i) sum += Four(y.slope_of(i)) * S[i][j];
    for (int c = 0; c < K::kForces; ++c)
      sum += Four(y.slope_of(K::kStates + c)) * at.by_parameter[c][j];
    out[j] = sum;
  }
}

// Rates of the states and of their sensitivities. z: measured outputs there, for the pull.
template <Axes axes>
inline void rates_of(const VariationalPlan<axes>& plan, const Sensitive<axes>& at,
                     const Instant<axes>& here, const double* z, Sensitive<axes>& k) {
  using K = Kernel<axes>;
  for (int i = 0; i < K::kStates; ++i) {
    if (!plan.is_state[i]) {
      k.x[i] = 0.0;
      for (int j = 0; j < plan.blocks; ++j) k.S[i][j] = Four(0.0);
      continue;
    }
    const auto& rate = here.y.rate[K::state[i]];
    k.x[i] = rate.value;
    total_slope(plan, rate, at.S, here, k.S[i]);
    const double gain = plan.pull[i];
    if (gain > 0.0 && z[plan.pull_output[i]] == z[plan.pull_output[i]]) {
      k.x[i] += gain * (z[plan.pull_output[i]] - at.x[i]);
      for (int j = 0; j < plan.blocks; ++j) k.S[i][j] = k.S[i][j] - Four(gain) * at.S[i][j];
    }
  }
}

}  // namespace alula
