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

// Sensitivities: rows of a number for each parameter, filled up with zeros to whole registers, one
// behind the other (stride: the plan's).
template <int Rows>
using SensitivityRows = double[Rows * kMaxParameters];
static_assert(kMaxParameters % 4 == 0);

// The motion at one instant and its derivatives by the parameters.
template <Axes axes>
struct Sensitive {
  double x[Kernel<axes>::kStates];
  alignas(32) SensitivityRows<Kernel<axes>::kStates> S;
};

// What a run needs beside the maneuver, found once: which slots feed which coefficient and which
// parameter.
template <Axes axes>
struct VariationalPlan {
  const MeasuredManeuver* m;
  const double* values;  // of all terms
  int stride;            // columns, filled up
  bool uses[kVariables];
  int count[Kernel<axes>::kForces];
  struct Summand {
    int slot, column;  // column -1: fixed
    bool again;        // the column has had a summand of this coefficient before
    double value, weight;
  } terms[Kernel<axes>::kForces][kMaxTerms];
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

template <Axes axes>
VariationalPlan<axes> variational_plan(const MeasuredManeuver& m, const double* values) {
  VariationalPlan<axes> plan{};
  plan.m = &m;
  plan.values = values;
  plan.stride = (m.columns + 3) / 4 * 4;
  const TermTable& table = *m.table;
  for (int k = 0; k < table.term_count; ++k) {
    const Term& term = table.terms[static_cast<unsigned>(k)];
    if (term.slot < kVariables) plan.uses[term.slot] = true;
    const int force = force_of<axes>(term.coefficient);
    if (force < 0) continue;
    bool again = false;
    for (int i = 0; i < plan.count[force]; ++i)
      if (plan.terms[force][i].column == m.term_column[k]) again = true;
    plan.terms[force][plan.count[force]++] = {term.slot, m.term_column[k], again, values[k],
                                              m.term_weight[k]};
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

// Everything at one instant: rates and specific forces with their slopes, and dC/dp, of which only
// what parameters act on is written: it begins as zero.
template <Axes axes>
struct Instant {
  using D = Dual<double, Kernel<axes>::kDirections>;
  MotionRates<D> y;
  alignas(32) SensitivityRows<Kernel<axes>::kForces> by_parameter = {};  // at fixed state
};

namespace detail {

// The base variables of the table. x: the kernel's variables, states and others, seeded.
template <Axes axes, class D, class L, class M>
inline void base_slots(const VariationalPlan<axes>& plan, const MotionState<L, M>& s,
                       const double* u, D* slots) {
  const MeasuredManeuver& m = *plan.m;
  slots[kOne] = D(1.0);
  if (plan.uses[kV]) slots[kV] = D(s.V);
  if (plan.uses[kAlpha]) slots[kAlpha] = D(s.alpha);
  if (plan.uses[kBeta]) slots[kBeta] = D(s.beta);
  if (plan.uses[kPhat] || plan.uses[kQhat] || plan.uses[kRhat]) {
    const L half_per_V = 0.5 / s.V;
    if (plan.uses[kPhat]) slots[kPhat] = D(m.b * (half_per_V * s.p));
    if (plan.uses[kQhat]) slots[kQhat] = D(m.c * (half_per_V * s.q));
    if (plan.uses[kRhat]) slots[kRhat] = D(m.b * (half_per_V * s.r));
  }
  for (int i = 0; i < 5; ++i)
    if (plan.uses[kDe + i]) slots[kDe + i] = D(u[kInControls + i]);
  if (plan.uses[kMach]) slots[kMach] = D(u[kInSlowness] * s.V);
  if (plan.uses[kWash]) slots[kWash] = D(0.0);  // a maneuver does not record it
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
template <Axes axes, class D>
inline D seeded_force(const VariationalPlan<axes>& plan, int force, const D* slots,
                      const double* u) {
  D sum(u[kInCoefficients + Kernel<axes>::coefficient[force]]);
  for (int k = 0; k < plan.count[force]; ++k) {
    const auto& term = plan.terms[force][k];
    sum += term.value * slots[term.slot];
  }
  seed(sum, Kernel<axes>::kStates + force);
  return sum;
}

// Slopes as plain numbers.
template <class D>
inline void slopes_of(const D& y, double* out) {
  __builtin_memcpy(out, y.slope, sizeof y.slope);
}

}  // namespace detail

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
  for (int i = 0; i < K::kStates; ++i) {
    seeded[i] = D(plan.is_state[i] ? x[i] : u[kInMotion + K::state[i]]);
    if (plan.is_state[i]) detail::seed(seeded[i], i);
  }
  MotionState<L, M> s;
  if constexpr (axes == Axes::longitudinal)
    s = {seeded[0],      seeded[1],   seeded[2],   seeded[3],
         u[kMotionBeta], u[kMotionP], u[kMotionR], u[kMotionPhi]};
  else if constexpr (axes == Axes::lateral)
    s = {u[kMotionV], u[kMotionAlpha], u[kMotionTheta], u[kMotionQ],
         seeded[0],   seeded[1],       seeded[2],       seeded[3]};
  else
    s = {seeded[0], seeded[1], seeded[7], seeded[4], seeded[2], seeded[3], seeded[5], seeded[6]};

  // Each coefficient has a direction of its own. The drag that uses the lift takes up the lift's.
  D slots[kMaxSlots];
  detail::base_slots<axes, D>(plan, s, u, slots);
  constexpr int lift = force_of<axes>(kLift);
  bool has_lift = false;
  std::array<D, kCoefficients> C;
  fill_slots(*m.table, slots, m.lookups, [&](const D* filled) {
    if constexpr (lift < 0) return D(u[kInCoefficients + kLift]);
    if (!has_lift) C[kLift] = detail::seeded_force(plan, lift < 0 ? 0 : lift, filled, u);
    has_lift = true;
    return C[kLift];
  });
  for (int c = 0; c < kCoefficients; ++c)
    if (force_of<axes>(c) < 0) C[static_cast<unsigned>(c)] = D(u[kInCoefficients + c]);
  for (int c = 0; c < K::kForces; ++c)
    if (!(has_lift && c == lift))
      C[static_cast<unsigned>(K::coefficient[c])] = detail::seeded_force(plan, c, slots, u);
  flight_equations<axes, D>(s, C, u, m, out.y);

  for (int c = 0; c < K::kForces; ++c) {
    double* row = out.by_parameter + c * plan.stride;
    for (int k = 0; k < plan.count[c]; ++k) {
      const auto& term = plan.terms[c][k];
      if (term.column < 0) continue;
      const double slope = term.weight * slots[term.slot].value;
      row[term.column] = term.again ? row[term.column] + slope : slope;
    }
  }
}

// A quantity's derivatives by the parameters: through the states and through the coefficients.
template <Axes axes>
inline void total_slope(const VariationalPlan<axes>& plan, const typename Instant<axes>::D& y,
                        const double* S, const Instant<axes>& at, double* out) {
  using K = Kernel<axes>;
  using V = Lanes<double, kLanes>;
  double slope[K::kDirections];
  detail::slopes_of(y, slope);
  const int stride = plan.stride;
  for (int j = 0; j < stride; j += kLanes) {
    V through_states = V(slope[0]) * V::load(S + j);
    for (int i = 1; i < K::kStates; ++i)
      through_states += V(slope[i]) * V::load(S + i * stride + j);
    V through_forces = V(slope[K::kStates]) * V::load(at.by_parameter + j);
    for (int c = 1; c < K::kForces; ++c)
      through_forces += V(slope[K::kStates + c]) * V::load(at.by_parameter + c * stride + j);
    (through_states + through_forces).store(out + j);
  }
}

// y = x + f k.
template <Axes axes>
inline void along(const VariationalPlan<axes>& plan, const Sensitive<axes>& x, double f,
                  const Sensitive<axes>& k, Sensitive<axes>& y) {
  using V = Lanes<double, kLanes>;
  const V factor(f);
  for (int i = 0; i < Kernel<axes>::kStates; ++i) y.x[i] = x.x[i] + f * k.x[i];
  const int all = Kernel<axes>::kStates * plan.stride;
  for (int j = 0; j < all; j += kLanes)
    (V::load(x.S + j) + factor * V::load(k.S + j)).store(y.S + j);
}

// Rates of the states and of their sensitivities. z: measured outputs there, for the pull.
template <Axes axes>
inline void rates_of(const VariationalPlan<axes>& plan, const Sensitive<axes>& at,
                     const Instant<axes>& here, const double* z, Sensitive<axes>& k) {
  using K = Kernel<axes>;
  for (int i = 0; i < K::kStates; ++i) {
    double* row = k.S + i * plan.stride;
    if (!plan.is_state[i]) {
      k.x[i] = 0.0;
      for (int j = 0; j < plan.stride; ++j) row[j] = 0.0;
      continue;
    }
    const auto& rate = here.y.rate[K::state[i]];
    k.x[i] = rate.value;
    total_slope(plan, rate, at.S, here, row);
    const double gain = plan.pull[i];
    if (gain > 0.0 && z[plan.pull_output[i]] == z[plan.pull_output[i]]) {
      k.x[i] += gain * (z[plan.pull_output[i]] - at.x[i]);
      const double* own = at.S + i * plan.stride;
      for (int j = 0; j < plan.stride; ++j) row[j] -= gain * own[j];
    }
  }
}

}  // namespace alula
