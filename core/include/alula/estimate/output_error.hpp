#pragma once
// Output error: flies one maneuver with given parameters and sums what a Gauss-Newton step needs.
// The maximum-likelihood estimate where the process has no noise. Dittrich 2016, Eq. (3.53) to
// (3.62) with the errata; Jategaonkar 2015, ch. 4.
#include "alula/estimate/variational.hpp"

namespace alula {

// What a run gives. Of each output: the sum of J J' (columns x stride rows, upper triangle), of J e
// and of e^2, J its derivatives by the parameters and e = measured - model; so that weights can be
// chosen afterwards. predicted (n, outputs) and sensitivity (n, outputs, columns): where not null.
struct OutputErrorSums {
  double* information = nullptr;  // (outputs, columns, stride), zeroed by the caller
  double* gradient = nullptr;     // (outputs, stride), zeroed by the caller
  double squares[kMeasuredOutputs] = {};
  int counts[kMeasuredOutputs] = {};
  double* predicted = nullptr;
  double* sensitivity = nullptr;
};

inline int stride_of(int columns) { return (columns + 3) / 4 * 4; }

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

template <Axes axes>
void take_up(const VariationalPlan<axes>& plan, int sample, const Sensitive<axes>& at,
             const Instant<axes>& here, const double* bias, OutputErrorSums& sums) {
  using K = Kernel<axes>;
  using D = typename Instant<axes>::D;
  const MeasuredManeuver& m = *plan.m;
  using V = Lanes<double, kLanes>;
  const int stride = plan.stride;
  const double* z = m.measured + static_cast<long>(sample) * m.outputs;
  const double* u = m.inputs + static_cast<long>(sample) * kManeuverInputs;
  for (int o = 0; o < m.outputs; ++o) {
    const int which = m.output[o];
    const bool wanted = z[o] == z[o];
    if (!wanted && !sums.predicted && !sums.sensitivity) continue;
    alignas(32) SensitivityRow own_row;
    const double* J = own_row;
    double y = 0.0;
    if (which < kMotionVariables) {
      int own = -1;
      for (int i = 0; i < K::kStates; ++i)
        if (K::state[i] == which && plan.is_state[i]) own = i;
      y = own < 0 ? u[kInMotion + which] : at.x[own];
      if (own >= 0 && m.bias_column[o] < 0)
        J = at.S[own];
      else
        for (int j = 0; j < stride; ++j) own_row[j] = own < 0 ? 0.0 : at.S[own][j];
    } else {
      const D& d = which == kOutAx     ? here.y.ax
                   : which == kOutAy   ? here.y.ay
                   : which == kOutAz   ? here.y.az
                   : which == kOutPdot ? here.y.rate[kMotionP]
                   : which == kOutQdot ? here.y.rate[kMotionQ]
                                       : here.y.rate[kMotionR];
      y = d.value;
      total_slope(plan, d, at.S, here, own_row);
    }
    y += bias[o];
    if (m.bias_column[o] >= 0) own_row[m.bias_column[o]] = 1.0;
    if (sums.predicted) sums.predicted[static_cast<long>(sample) * m.outputs + o] = y;
    if (sums.sensitivity) {
      double* row = sums.sensitivity + (static_cast<long>(sample) * m.outputs + o) * m.columns;
      for (int k = 0; k < m.columns; ++k) row[k] = J[k];
    }
    if (!wanted) continue;
    const double e = z[o] - y;
    sums.squares[o] += e * e;
    ++sums.counts[o];
    if (!sums.gradient) continue;
    double* gradient = sums.gradient + o * stride;
    double* row = sums.information + static_cast<long>(o) * m.columns * stride;
    for (int j = 0; j < stride; j += kLanes)
      (V::load(gradient + j) + V(e) * V::load(J + j)).store(gradient + j);
    for (int i = 0; i < m.columns; ++i, row += stride) {
      const V factor(J[i]);
      for (int j = i / kLanes * kLanes; j < stride; j += kLanes)
        (V::load(row + j) + factor * V::load(J + j)).store(row + j);
    }
  }
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
  Sensitive<axes> now, sum, trial, k;
  for (int i = 0; i < K::kStates; ++i) {
    now.x[i] = initial[K::state[i]];
    for (int j = 0; j < plan.stride; ++j) now.S[i][j] = 0.0;
    const int column = m.initial_column[K::state[i]];
    if (plan.is_state[i] && column >= 0) now.S[i][column] = 1.0;
  }
  Instant<axes> here;
  double u[3][kManeuverInputs], z[3][kMeasuredOutputs];
  for (int sample = 0; sample < m.samples; ++sample) {
    if (!detail::flies(plan, now.x)) return sample;
    const double* u0 = m.inputs + static_cast<long>(sample) * kManeuverInputs;
    evaluate(plan, now.x, u0, here);
    detail::take_up(plan, sample, now, here, bias, sums);
    if (sample + 1 == m.samples) break;

    const double* u1 = u0 + kManeuverInputs;
    const double* z0 = m.measured + static_cast<long>(sample) * m.outputs;
    const double* z1 = z0 + m.outputs;
    const double h = (m.t[sample + 1] - m.t[sample]) / m.substeps;
    for (int part = 0; part < m.substeps; ++part) {
      for (int at = 0; at < 3; ++at) {  // beginning, middle and end of the step
        const double w = (part + 0.5 * at) / m.substeps;
        for (int i = 0; i < kManeuverInputs; ++i) u[at][i] = u0[i] + w * (u1[i] - u0[i]);
        for (int o = 0; o < m.outputs; ++o) z[at][o] = z0[o] + w * (z1[o] - z0[o]);
      }
      if (part > 0) evaluate(plan, now.x, u[0], here);
      rates_of(plan, now, here, z[0], sum);
      const Sensitive<axes>* rate = &sum;
      for (int stage = 1; stage < 4; ++stage) {
        along(plan, now, stage == 3 ? h : 0.5 * h, *rate, trial);
        const int at = stage == 3 ? 2 : 1;
        evaluate(plan, trial.x, u[at], here);
        rates_of(plan, trial, here, z[at], k);
        along(plan, sum, stage == 3 ? 1.0 : 2.0, k, sum);
        rate = &k;
      }
      along(plan, now, h / 6.0, sum, now);
    }
  }
  return m.samples;
}

}  // namespace alula
