#pragma once
// What one Runge-Kutta step does to the sensitivities: the derivative of the step itself, exact to
// rounding. The rates k_s = f(x_s, C_s) at x_s = x + ahead_s k_(s-1) have the slopes A_s by the
// states and G_s by the coefficients, so that the step's result moves by
// dx' = by_state dx + sum over stages of by_force_s dC_s. Collected from the last stage to the
// first, as an adjoint, it costs the same for any number of parameters.
#include "alula/estimate/variational.hpp"

namespace alula {

// A number for each state, filled up to whole registers.
template <Axes axes>
struct StateColumn {
  using V = Lanes<double, kLanes>;
  static constexpr int kSize = Kernel<axes>::kStates, kBlocks = kSize / kLanes;
  static_assert(kSize % kLanes == 0);
  V block[kBlocks];

  static StateColumn zero() {
    StateColumn r;
    for (int i = 0; i < kBlocks; ++i) r.block[i] = V(0.0);
    return r;
  }
  static StateColumn load(const double* p) {
    StateColumn r;
    for (int i = 0; i < kBlocks; ++i) r.block[i] = V::load(p + kLanes * i);
    return r;
  }
  void store(double* p) const {
    for (int i = 0; i < kBlocks; ++i) block[i].store(p + kLanes * i);
  }
  void add(double factor, const StateColumn& b) {
    const V f(factor);
    for (int i = 0; i < kBlocks; ++i) block[i] += f * b.block[i];
  }
};

template <Axes axes>
struct StepSlopes {
  using K = Kernel<axes>;
  using States = StateColumn<axes>;
  States by_state[K::kStates], by_force[4][K::kForces];

  // stage: rates with slopes. weight: of each stage's rates in the result. ahead: from the step's
  // beginning to each stage.
  void collect(const Instant<axes>* stage, const double* weight, const double* ahead) {
    States later[K::kStates];  // the result by the rates of a stage
    for (int i = 0; i < K::kStates; ++i) {
      by_state[i] = States::load(detail::kDirectionRows<K::kStates>.row[i]);
      later[i] = States::zero();
      later[i].add(weight[3], by_state[i]);
    }
    for (int s = 3; s >= 0; --s) {
      const auto along = [&](int direction) {
        States sum = States::zero();
        for (int i = 0; i < K::kStates; ++i)
          sum.add(stage[s].y.rate[K::state[i]].slope_of(direction), later[i]);
        return sum;
      };
      for (int c = 0; c < K::kForces; ++c) by_force[s][c] = along(K::along_force[c]);
      States moved[K::kStates];
      for (int i = 0; i < K::kStates; ++i) {
        moved[i] = along(K::along_state[i]);
        by_state[i].add(1.0, moved[i]);
      }
      if (s == 0) break;
      for (int i = 0; i < K::kStates; ++i) {
        later[i] = States::zero();
        later[i].add(weight[s - 1], States::load(detail::kDirectionRows<K::kStates>.row[i]));
        later[i].add(ahead[s], moved[i]);
      }
    }
  }

  // S: a column of the states for each parameter.
  void apply(const VariationalPlan<axes>& plan, const Instant<axes>* stage, double* S) const {
    for (int j = 0; j < plan.m->columns; ++j) {
      double* own = S + j * K::kStates;
      States sum = States::zero();
      for (int i = 0; i < K::kStates; ++i) sum.add(own[i], by_state[i]);
      sum.store(own);
    }
    for (int k = 0; k < plan.effects; ++k) {
      const auto& effect = plan.effect[k];
      double* own = S + effect.column * K::kStates;
      States change = States::zero(), sum = States::load(own);
      for (int s = 0; s < 4; ++s)
        change.add(stage[s].regressor[effect.regressor], by_force[s][effect.force]);
      sum.add(effect.weight, change);
      sum.store(own);
    }
  }
};

}  // namespace alula
