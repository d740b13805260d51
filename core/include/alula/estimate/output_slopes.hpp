#pragma once
// The outputs of a model at one instant, their derivatives by the parameters, and the sums of both
// that a Gauss-Newton step needs. Outputs lie side by side in registers.
#include "alula/estimate/variational.hpp"

namespace alula {

// Of each output: the sums of J J' (upper triangle), of J e and of e^2, J its derivatives by the
// parameters and e = measured - model; so that weights can be chosen afterwards. Outputs are filled
// up to `rows_of` them. predicted (n, outputs) and sensitivity (n, outputs, columns): where not
// null.
struct OutputErrorSums {
  double* information = nullptr;  // (columns, columns, rows), zeroed by the caller
  double* gradient = nullptr;     // (columns, rows), zeroed by the caller
  double squares[kMeasuredOutputs] = {};
  int counts[kMeasuredOutputs] = {};
  double* predicted = nullptr;
  double* sensitivity = nullptr;
};

constexpr int rows_of(int outputs) { return (outputs + kLanes - 1) / kLanes * kLanes; }

template <Axes axes>
class OutputSlopes {
 public:
  explicit OutputSlopes(const VariationalPlan<axes>& plan) : plan_(plan) {
    const MeasuredManeuver& m = *plan.m;
    for (int o = 0; o < m.outputs; ++o) {
      if (m.output[o] >= kMotionVariables) accelerations_[o / kLanes] = true;
      for (int i = 0; i < K::kStates; ++i)
        if (m.output[o] == K::state[i] && plan.is_state[i]) {
          state_[o] = i;
          along_[K::along_state[i]][o] = 1.0;
        }
    }
  }

  // Takes up one sample. S: sensitivities, a column of states for each parameter.
  void take_up(int sample, const double* x, const double* S, const Instant<axes>& here,
               const double* bias, OutputErrorSums& sums) {
    const MeasuredManeuver& m = *plan_.m;
    const long place = static_cast<long>(sample) * m.outputs;
    const double* u = m.inputs + static_cast<long>(sample) * kManeuverInputs;
    const double* z = m.measured + place;
    double* e = e_[waiting_];
    for (int o = 0; o < m.outputs; ++o) {
      const double y = value(o, x, u, here) + bias[o];
      if (sums.predicted) sums.predicted[place + o] = y;
      e[o] = z[o] == z[o] ? z[o] - y : 0.0;
      sums.squares[o] += e[o] * e[o];
      sums.counts[o] += z[o] == z[o];
    }
    if (!sums.gradient && !sums.sensitivity) return;
    double* J = J_[waiting_];
    slopes(S, here, J);
    for (int o = 0; o < m.outputs; ++o) {
      if (sums.sensitivity)
        for (int j = 0; j < m.columns; ++j)
          sums.sensitivity[(place + o) * m.columns + j] = J[j * kRows + o];
      if (z[o] != z[o])
        for (int j = 0; j < m.columns; ++j) J[j * kRows + o] = 0.0;
    }
    if (sums.gradient && ++waiting_ == kSamples) add(sums);
  }

  // Adds what still waits.
  void finish(OutputErrorSums& sums) {
    if (waiting_ == 0) return;
    for (int n = waiting_; n < kSamples; ++n) {
      for (double& e : e_[n]) e = 0.0;
      for (double& slope : J_[n]) slope = 0.0;
    }
    add(sums);
  }

 private:
  using K = Kernel<axes>;
  using V = Lanes<double, kLanes>;
  static constexpr int kRows = rows_of(kMeasuredOutputs), kSamples = 4;

  // Without bias. The slopes of accelerations along the kernel's directions are noted.
  double value(int o, const double* x, const double* u, const Instant<axes>& here) {
    const int which = plan_.m->output[o];
    if (which < kMotionVariables) return state_[o] < 0 ? u[kInMotion + which] : x[state_[o]];
    const auto& d = acceleration(here.y, which);
    for (int i = 0; i < K::kDirections; ++i) along_[i][o] = d.slope_of(i);
    return d.value;
  }

  void slopes(const double* S, const Instant<axes>& here, double* J) const {
    const MeasuredManeuver& m = *plan_.m;
    for (int row = 0; row < m.outputs; row += kLanes) {
      for (int j = 0; j < m.columns; ++j) {
        V sum(0.0);
        for (int i = 0; i < K::kStates; ++i)
          sum += V(S[j * K::kStates + i]) * V::load(along_[K::along_state[i]] + row);
        sum.store(J + j * kRows + row);
      }
      if (!accelerations_[row / kLanes]) continue;
      for (int k = 0; k < plan_.effects; ++k) {
        const auto& effect = plan_.effect[k];
        double* own = J + effect.column * kRows + row;
        const V along = V::load(along_[K::along_force[effect.force]] + row);
        (V::load(own) + V(effect.weight * here.regressor[effect.regressor]) * along).store(own);
      }
    }
    for (int o = 0; o < m.outputs; ++o)
      if (m.bias_column[o] >= 0) J[m.bias_column[o] * kRows + o] = 1.0;
  }

  void add(OutputErrorSums& sums) {
    const int columns = plan_.m->columns, rows = rows_of(plan_.m->outputs);
    for (int row = 0; row < rows; row += kLanes) {
      for (int i = 0; i < columns; ++i) {
        V own[kSamples], slope = V::load(sums.gradient + i * rows + row);
        for (int n = 0; n < kSamples; ++n) {
          own[n] = V::load(J_[n] + i * kRows + row);
          slope += own[n] * V::load(e_[n] + row);
        }
        slope.store(sums.gradient + i * rows + row);
        double* information = sums.information + i * columns * rows + row;
        for (int j = i; j < columns; ++j) {
          V sum = V::load(information + j * rows);
          for (int n = 0; n < kSamples; ++n) sum += own[n] * V::load(J_[n] + j * kRows + row);
          sum.store(information + j * rows);
        }
      }
    }
    waiting_ = 0;
  }

  const VariationalPlan<axes>& plan_;
  int state_[kMeasuredOutputs] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
  bool accelerations_[kRows / kLanes] = {};  // among the outputs of a register
  alignas(32) double along_[K::kDirections][kRows] = {};
  // Samples wait until there are a few, so that sums stay in registers meanwhile.
  int waiting_ = 0;
  alignas(32) double e_[kSamples][kRows] = {}, J_[kSamples][kMaxParameters * kRows];
};

}  // namespace alula
