#pragma once
// Filter error: one maneuver through an extended Kalman filter, whose innovations and their
// covariances make the likelihood of parameters where the air is not still (Jategaonkar 2015,
// ch. 5). The estimate moves by the exponential Rosenbrock-Euler method (Hochbruck and Ostermann
// 2010), exact where the motion is linear and inputs run straight between samples; its covariance
// by the slopes there, P = Phi (P + Q dt/2) Phi' + Q dt/2.
#include "alula/estimate/output_error.hpp"
#include "alula/math/rows.hpp"

namespace alula {

// An estimate of N variables (a multiple of four) and its covariance. What is no state has neither
// slopes nor noise. Not inlined: two kernels share what is long to compile.
template <int N>
struct FilteredMotion {
  static constexpr int kSeries = 10;  // terms: 1e-8 where a sample is as long as the fastest mode
  double x[N] = {};
  alignas(32) double P[N][N] = {};

  // Takes up the innovations v, whose slopes by x are the rows of C and whose sensors have the
  // variances `noise`; NaN where there is no reading, which counts as a zero of variance one and
  // tells nothing. Writes S (outputs, outputs). False where a covariance has lost its rank.
  [[gnu::noinline]] bool update(int outputs, double (*C)[N], double* v, const double* noise,
                                double* S) {
    alignas(32) double CP[kMeasuredOutputs][N];
    double left[kMeasuredOutputs][kMeasuredOutputs], e[kMeasuredOutputs];
    for (int o = 0; o < outputs; ++o) {
      const bool heard = v[o] == v[o];
      if (!heard) clear<N>(C[o]);
      clear<N>(CP[o]);
      for (int i = 0; i < N; ++i) add_scaled<N>(CP[o], C[o][i], P[i]);
      for (int b = 0; b <= o; ++b) {
        double sum = b < o ? 0.0 : heard ? noise[o] : 1.0;
        for (int i = 0; i < N; ++i) sum += CP[o][i] * C[b][i];
        left[o][b] = left[b][o] = S[o * outputs + b] = S[b * outputs + o] = sum;
      }
      e[o] = v[o] = heard ? v[o] : 0.0;
    }
    // By elimination each output in turn becomes independent of those before it.
    for (int o = 0; o < outputs; ++o) {
      if (!(left[o][o] > 0.0)) return false;
      const double inverse = 1.0 / left[o][o];
      for (int b = o + 1; b < outputs; ++b) {
        const double factor = left[b][o] * inverse;
        for (int k = o + 1; k < outputs; ++k) left[b][k] -= factor * left[o][k];
        e[b] -= factor * e[o];
        add_scaled<N>(CP[b], -factor, CP[o]);
      }
      add_scaled<N>(x, e[o] * inverse, CP[o]);
      for (int i = 0; i < N; ++i) add_scaled<N>(P[i], -CP[o][i] * inverse, CP[o]);
    }
    return true;
  }

  // On by dt. A: row i, the slopes of variable i's rate; rate: in the middle of the inputs; rise:
  // what the inputs' change from the first to the last adds to it; process: Q's diagonal.
  [[gnu::noinline]] void advance(double dt, const double (*A)[N], const double* rate,
                                 const double* rise, const double* process) {
    // power = (A dt)^(k - 1) / k!; share: their sum, (exp(A dt) - 1) / (A dt); gain: what moves x
    alignas(32) double power[N][N] = {}, share[N][N] = {}, phi[N][N] = {}, next[N][N];
    double gain[N], ramp[N] = {};
    for (int i = 0; i < N; ++i) power[i][i] = share[i][i] = phi[i][i] = 1.0;
    for (int k = 2; k <= kSeries; ++k) {
      for (int i = 0; i < N; ++i) {
        clear<N>(next[i]);
        for (int j = 0; j < N; ++j) add_scaled<N>(next[i], dt / k * A[i][j], power[j]);
      }
      for (int i = 0; i < N; ++i) {
        scale<N>(power[i], 1.0, next[i]);
        add_scaled<N>(share[i], 1.0, power[i]);
        double sum = 0.0;
        for (int j = 0; j < N; ++j) sum += power[i][j] * rise[j];
        ramp[i] += (1.0 / (k + 1) - 0.5) * sum;
      }
    }
    for (int i = 0; i < N; ++i) {
      gain[i] = ramp[i];
      for (int j = 0; j < N; ++j) {
        gain[i] += share[i][j] * rate[j];
        add_scaled<N>(phi[i], dt * A[i][j], share[j]);
      }
      P[i][i] += 0.5 * dt * process[i];
    }
    add_scaled<N>(x, dt, gain);
    for (int i = 0; i < N; ++i) {
      clear<N>(next[i]);
      for (int j = 0; j < N; ++j) add_scaled<N>(next[i], phi[i][j], P[j]);
    }
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) {
        double sum = i == j ? 0.5 * dt * process[i] : 0.0;
        for (int k = 0; k < N; ++k) sum += next[i][k] * phi[j][k];
        P[i][j] = P[j][i] = sum;
      }
  }
};

namespace detail {

// The outputs y at one instant and their slopes C; `here` serves accelerations.
template <Axes axes>
void outputs_of(const VariationalPlan<axes>& plan, const double* x, const double* u,
                const Instant<axes>& here, double* y, double (*C)[Kernel<axes>::kStates]) {
  using K = Kernel<axes>;
  for (int o = 0; o < plan.m->outputs; ++o) {
    const int which = plan.m->output[o];
    clear<K::kStates>(C[o]);
    if (which < kMotionVariables) {
      y[o] = u[kInMotion + which];
      for (int i = 0; i < K::kStates; ++i)
        if (K::state[i] == which && plan.is_state[i]) {
          y[o] = x[i];
          C[o][i] = 1.0;
        }
      continue;
    }
    const auto& d = acceleration(here.y, which);
    y[o] = d.value;
    for (int i = 0; i < K::kStates; ++i) C[o][i] = d.slope_of(K::along_state[i]);
  }
}

}  // namespace detail

// values: one per term. initial: the eight variables as predicted for the first sample, which has
// the process noise of one sample like any other: without it they could meet a reading exactly, and
// the likelihood would have no bound as the sensor's noise goes to zero. process: F F' of each of
// the eight, per second. noise: variance of each output's sensor. Writes the predicted outputs y
// and innovations v (samples, outputs) and S (samples, outputs, outputs). Returns the number of
// samples filtered: fewer than the maneuver has where the motion diverged.
template <Axes axes>
int filter_maneuver(const MeasuredManeuver& m, const double* values, const double* initial,
                    const double* process, const double* noise, double* y, double* v, double* S) {
  using K = Kernel<axes>;
  constexpr int N = K::kStates;
  VariationalPlan<axes> plan = variational_plan<axes>(m, values);
  for (double& pull : plan.pull) pull = 0.0;  // the filter corrects by its gain
  FilteredMotion<N> motion;
  double Q[N], C[kMeasuredOutputs][N], A[N][N], rate[N], rise[N], space[kManeuverInputs];
  for (int i = 0; i < N; ++i) {
    motion.x[i] = initial[K::state[i]];
    Q[i] = plan.is_state[i] ? process[K::state[i]] : 0.0;
    motion.P[i][i] = m.samples > 1 ? (m.t[1] - m.t[0]) * Q[i] : 0.0;
  }
  Instant<axes> here;
  constexpr double way[3] = {0.0, 1.0, 0.5}, sign[3] = {-1.0, 1.0, 0.0};
  for (int sample = 0; sample < m.samples; ++sample) {
    if (!detail::flies(plan, motion.x)) return sample;
    const double* u = m.inputs + static_cast<long>(sample) * kManeuverInputs;
    const long row = static_cast<long>(sample) * m.outputs;
    evaluate(plan, motion.x, u, here);
    detail::outputs_of(plan, motion.x, u, here, y + row, C);
    for (int o = 0; o < m.outputs; ++o) v[row + o] = m.measured[row + o] - y[row + o];
    if (!motion.update(m.outputs, C, v + row, noise, S + row * m.outputs)) return sample;
    if (sample + 1 == m.samples) break;

    // The rates with the inputs at the beginning, at the end and in the middle.
    for (double& r : rise) r = 0.0;
    for (int part = 0; part < 3; ++part) {
      evaluate(plan, motion.x, detail::between(m.inputs, kManeuverInputs, sample, way[part], space),
               here);
      correct(plan, motion.x, nullptr, here);
      for (int i = 0; i < N; ++i) {
        rate[i] = here.y.rate[K::state[i]].value;
        rise[i] += sign[part] * rate[i];
      }
    }
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) A[i][j] = here.y.rate[K::state[i]].slope_of(K::along_state[j]);
    motion.advance(m.t[sample + 1] - m.t[sample], A, rate, rise, Q);
  }
  return m.samples;
}

}  // namespace alula
