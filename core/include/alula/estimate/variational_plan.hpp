#pragma once
// What output error differentiates along, and which terms of a model feed which coefficient and
// which parameter: found once for a run.
#include "alula/estimate/flight_equations.hpp"
#include "alula/math/lanes.hpp"

namespace alula {

// The states of a kernel, the coefficients that it has parameters for, and the direction of each.
// The first kAir directions are all that the aerodynamic formulas know: attitude is no variable of
// theirs, and the lift is the one coefficient that another may use.
template <Axes axes>
struct Kernel {
  static constexpr int kStates = 4, kForces = 3, kDirections = 8, kAir = 4;
  static constexpr int state[4] = {kMotionV, kMotionAlpha, kMotionQ, kMotionTheta};
  static constexpr int along_state[4] = {0, 1, 2, 4};
  static constexpr int coefficient[3] = {0, kLift, 4};
  static constexpr int along_force[3] = {5, 3, 6};
};
template <>
struct Kernel<Axes::lateral> {
  static constexpr int kStates = 4, kForces = 3, kDirections = 8, kAir = 4;
  static constexpr int state[4] = {kMotionBeta, kMotionP, kMotionR, kMotionPhi};
  static constexpr int along_state[4] = {0, 1, 2, 3};
  static constexpr int coefficient[3] = {1, 3, 5};
  static constexpr int along_force[3] = {4, 5, 6};
};
template <>
struct Kernel<Axes::six> {
  static constexpr int kStates = 8, kForces = 6, kDirections = 16, kAir = 8;
  static constexpr int state[8] = {kMotionV, kMotionAlpha, kMotionBeta, kMotionP,
                                   kMotionQ, kMotionR,     kMotionPhi,  kMotionTheta};
  static constexpr int along_state[8] = {0, 1, 2, 3, 4, 5, 7, 8};
  static constexpr int coefficient[6] = {0, 1, kLift, 3, 4, 5};
  static constexpr int along_force[6] = {9, 10, 6, 11, 12, 13};
};

template <Axes axes>
struct VariationalPlan {
  const MeasuredManeuver* m;
  bool uses[kVariables];
  int count[Kernel<axes>::kForces];
  struct Summand {
    int slot;
    double value;
  } terms[Kernel<axes>::kForces][kMaxTerms];
  int regressors, regressor[kMaxTerms];  // slots whose terms are parameters
  int effects;                           // of parameters on coefficients
  struct Effect {
    int force, regressor, column;
    double weight;
  } effect[kMaxTerms];
  bool corrected;  // some states are none here, or are pulled
  bool is_state[Kernel<axes>::kStates];
  double pull[Kernel<axes>::kStates];
  int pull_output[Kernel<axes>::kStates];  // place among the outputs, -1: none
};

template <Axes axes>
constexpr int force_of(int coefficient) {
  for (int c = 0; c < Kernel<axes>::kForces; ++c)
    if (Kernel<axes>::coefficient[c] == coefficient) return c;
  return -1;
}

// values: one for each term of the table.
template <Axes axes>
VariationalPlan<axes> variational_plan(const MeasuredManeuver& m, const double* values) {
  VariationalPlan<axes> plan{};
  plan.m = &m;
  const TermTable& table = *m.table;
  for (int k = 0; k < table.term_count; ++k) {
    const Term& term = table.terms[static_cast<unsigned>(k)];
    if (term.slot < kVariables) plan.uses[term.slot] = true;
    const int force = force_of<axes>(term.coefficient);
    if (force < 0) continue;
    plan.terms[force][plan.count[force]++] = {term.slot, values[k]};
    if (m.term_column[k] < 0) continue;
    int regressor = 0;
    while (regressor < plan.regressors && plan.regressor[regressor] != term.slot) ++regressor;
    if (regressor == plan.regressors) plan.regressor[plan.regressors++] = term.slot;
    plan.effect[plan.effects++] = {force, regressor, m.term_column[k], m.term_weight[k]};
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
    plan.corrected = plan.corrected || !plan.is_state[i] || plan.pull[i] > 0.0;
  }
  return plan;
}

}  // namespace alula
