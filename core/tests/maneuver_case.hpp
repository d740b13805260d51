#pragma once
// A maneuver of a light aircraft for the tests of output error and filter error.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "alula/estimate/output_error.hpp"

namespace alula_test {

using alula::Axes;

// A maneuver of a light aircraft with made-up readings; models in body or stability axes.
struct ManeuverCase {
  alula::TermTable table{};
  alula::MeasuredManeuver m;
  std::vector<double> values, t, inputs, measured;
  double initial[alula::kMotionVariables] = {45, .05, .01, .02, .01, -.02, .03, .05};
  double bias[alula::kMeasuredOutputs] = {};

  int step(alula::Operation operation, int a, int b) {
    table.steps[table.step_count] = {
        0, operation, static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), 0, 0};
    return alula::kVariables + table.step_count++;
  }
  void term(int coefficient, int slot, double value) {
    table.terms[table.term_count++] = {static_cast<std::uint8_t>(coefficient),
                                       static_cast<std::uint8_t>(slot)};
    values.push_back(value);
  }

  ManeuverCase(bool lateral, bool longitudinal, bool stability) {
    using namespace alula;
    if (longitudinal) {
      const double sign = stability ? 1.0 : -1.0;
      term(2, kOne, sign * .25);
      term(2, kAlpha, sign * 5.0);
      term(2, kQhat, sign * 4.0);
      term(4, kOne, .03);
      term(4, kAlpha, -.8);
      term(4, kQhat, -12.0);
      term(4, kDe, -1.1);
      if (stability) {
        const int lift = step(Operation::lift, 0, 0);
        term(0, kOne, .035);
        term(0, step(Operation::multiply, lift, lift), .05);
      } else {
        term(0, kOne, -.03);
        term(0, step(Operation::multiply, kAlpha, kAlpha), 2.0);
        term(0, kMach, -.01);
      }
    }
    if (lateral) {
      term(1, kBeta, -.7);
      term(3, kBeta, -.08);
      term(3, kPhat, -.5);
      term(3, kDa, -.2);
      term(5, kBeta, .09);
      term(5, kRhat, -.15);
      term(5, kDr, -.09);
    }
    m.table = &table;
    m.stability_axes = stability;
    m.S = 11.85, m.b = 9, m.c = 1.21, m.mass = 600;
    m.inertia = {{{1200, 0, -90}, {0, 1100, 0}, {-90, 0, 2100}}};
    m.inertia_inverse = inverse(m.inertia);
    m.arm = {.05, .01, -.02};
    for (int i : {0, 1, 4, 7}) m.is_state[i] = longitudinal;
    for (int i : {2, 3, 5, 6}) m.is_state[i] = lateral;
    for (int i = 0; i < kMotionVariables; ++i)
      if (m.is_state[i]) m.output[m.outputs++] = i;
    if (longitudinal)
      for (int o : {kOutAx, kOutAz, kOutQdot}) m.output[m.outputs++] = o;
    if (lateral)
      for (int o : {kOutAy, kOutPdot, kOutRdot}) m.output[m.outputs++] = o;
    for (int k = 0; k < table.term_count; ++k) {
      m.term_column[k] = m.columns++;
      m.term_weight[k] = 1.0;
    }
    for (int i = 0; i < kMotionVariables; ++i)
      m.initial_column[i] = m.is_state[i] ? m.columns++ : -1;
    for (int o = 0; o < m.outputs; ++o) m.bias_column[o] = -1;
    m.bias_column[1] = m.columns++;
    m.pull[kMotionAlpha] = longitudinal ? 0.3 : 0.0;
    m.samples = 150;
    t.resize(150);
    inputs.assign(150 * kManeuverInputs, 0.0);
    measured.assign(static_cast<std::size_t>(150 * m.outputs), 0.0);
    for (int k = 0; k < 150; ++k) {
      t[static_cast<std::size_t>(k)] = .02 * k;
      double* u = &inputs[static_cast<std::size_t>(k * kManeuverInputs)];
      std::copy(initial, initial + kMotionVariables, u);
      u[kInControls] = .03 * std::sin(.1 * k);
      u[kInControls + 1] = .02 * std::cos(.07 * k);
      u[kInControls + 2] = .02 * std::sin(.05 * k);
      u[kInDensity] = 1.112;
      u[kInSlowness] = 1 / 340.0;
      u[kInForce] = 700;
      u[kInMoment + 1] = 5;
      if (!longitudinal) u[kInCoefficients] = -.03, u[kInCoefficients + 2] = -.5;
      for (int o = 0; o < m.outputs; ++o)
        measured[static_cast<std::size_t>(k * m.outputs + o)] = .05 + .01 * o;
    }
    m.t = t.data();
    m.inputs = inputs.data();
    m.measured = measured.data();
  }

  // Outputs with column c of the parameters moved by h.
  template <Axes axes>
  std::vector<double> moved(int c, double h) const {
    std::vector<double> v = values, y(static_cast<std::size_t>(m.samples * m.outputs));
    double x[alula::kMotionVariables], b[alula::kMeasuredOutputs];
    std::copy(initial, initial + alula::kMotionVariables, x);
    std::copy(bias, bias + alula::kMeasuredOutputs, b);
    for (std::size_t k = 0; k < v.size(); ++k)
      if (m.term_column[k] == c) v[k] += h * m.term_weight[k];
    for (int i = 0; i < alula::kMotionVariables; ++i)
      if (m.initial_column[i] == c) x[i] += h;
    for (int o = 0; o < m.outputs; ++o)
      if (m.bias_column[o] == c) b[o] += h;
    alula::OutputErrorSums sums;
    sums.predicted = y.data();
    EXPECT_EQ(alula::fly_maneuver<axes>(m, v.data(), x, b, sums), m.samples);
    return y;
  }
};

}  // namespace alula_test
