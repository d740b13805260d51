#pragma once
// Output error: flies one maneuver with given parameters and sums what a Gauss-Newton step needs.
// The maximum-likelihood estimate where the process has no noise. Dittrich 2016, Eq. (3.53) to
// (3.62) with the errata; Jategaonkar 2015, ch. 4.
#include "alula/estimate/output_slopes.hpp"
#include "alula/estimate/step_slopes.hpp"

namespace alula {
namespace detail {

// A motion that no aircraft flies: the run stops there.
template <Axes axes>
bool flies(const VariationalPlan<axes>& plan, const double* x) {
  for (int i = 0; i < Kernel<axes>::kStates; ++i) {
    if (!plan.is_state[i]) continue;
    if (!(x[i] > -1e4 && x[i] < 1e4)) return false;
    if (Kernel<axes>::state[i] == kMotionV && !(x[i] > 0.1)) return false;
  }
  return true;
}

// A row of `columns` numbers between sample and the next one, w of the way; written to `space`
// where it has to be made.
inline const double* between(const double* rows, int columns, int sample, double w, double* space) {
  const double* first = rows + static_cast<long>(sample) * columns;
  if (w == 0.0) return first;
  if (w == 1.0) return first + columns;
  for (int i = 0; i < columns; ++i) space[i] = first[i] + w * (first[columns + i] - first[i]);
  return space;
}

}  // namespace detail

// values: one per term. initial: the eight variables at the first sample, of which states count.
// bias: one per output, added to the model's. Returns the number of samples flown: fewer than the
// maneuver has where the motion diverged.
template <Axes axes>
int fly_maneuver(const MeasuredManeuver& m, const double* values, const double* initial,
                 const double* bias, OutputErrorSums& sums) {
  using K = Kernel<axes>;
  const VariationalPlan<axes> plan = variational_plan<axes>(m, values);
  OutputSlopes<axes> outputs(plan);
  StepSlopes<axes> slopes;
  Instant<axes> stages[4];
  double x[K::kStates], inputs[3][kManeuverInputs], readings[3][kMeasuredOutputs];
  alignas(32) double S[kMaxParameters * K::kStates] = {};  // a column of states for each parameter
  for (int i = 0; i < K::kStates; ++i) {
    x[i] = initial[K::state[i]];
    const int column = m.initial_column[K::state[i]];
    if (plan.is_state[i] && column >= 0) S[column * K::kStates + i] = 1.0;
  }
  int sample = 0;
  for (; sample < m.samples && detail::flies(plan, x); ++sample) {
    evaluate(plan, x, m.inputs + static_cast<long>(sample) * kManeuverInputs, stages[0]);
    outputs.take_up(sample, x, S, stages[0], bias, sums);
    if (sample + 1 == m.samples) continue;

    const double h = (m.t[sample + 1] - m.t[sample]) / m.substeps;
    const double weight[4] = {h / 6.0, h / 3.0, h / 3.0, h / 6.0};
    const double ahead[4] = {0.0, 0.5 * h, 0.5 * h, h};
    for (int part = 0; part < m.substeps; ++part) {
      const double* u[3];  // beginning, middle, end
      const double* z[3];
      for (int i = 0; i < 3; ++i) {
        const double w = (part + 0.5 * i) / m.substeps;
        u[i] = detail::between(m.inputs, kManeuverInputs, sample, w, inputs[i]);
        z[i] = detail::between(m.measured, m.outputs, sample, w, readings[i]);
      }
      double at[K::kStates], after[K::kStates];
      for (int i = 0; i < K::kStates; ++i) at[i] = after[i] = x[i];
      for (int s = 0; s < 4; ++s) {
        const int moment = (s + 1) / 2;
        if (s > 0 || part > 0) evaluate(plan, at, u[moment], stages[s]);
        correct(plan, at, z[moment], stages[s]);
        for (int i = 0; i < K::kStates; ++i) {
          const double rate = stages[s].y.rate[K::state[i]].value;
          after[i] += weight[s] * rate;
          if (s < 3) at[i] = x[i] + ahead[s + 1] * rate;
        }
      }
      slopes.collect(stages, weight, ahead);
      slopes.apply(plan, stages, S);
      for (int i = 0; i < K::kStates; ++i) x[i] = after[i];
    }
  }
  outputs.finish(sums);
  return sample;
}

}  // namespace alula
