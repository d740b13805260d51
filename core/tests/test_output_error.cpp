// Output error: sensitivities against differences in every set of states, no allocation, a motion
// that diverges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "allocations.hpp"
#include "alula/estimate/output_error.hpp"
#include "maneuver_case.hpp"

namespace {

using alula::Axes;
using Case = alula_test::ManeuverCase;

template <Axes axes>
void expect_slopes(Case c) {
  c.m.table = &c.table;
  const alula::MeasuredManeuver& m = c.m;
  std::vector<double> J(static_cast<std::size_t>(m.samples * m.outputs * m.columns));
  alula::OutputErrorSums sums;
  sums.sensitivity = J.data();
  ASSERT_EQ(alula::fly_maneuver<axes>(m, c.values.data(), c.initial, c.bias, sums), m.samples);
  for (int p = 0; p < m.columns; ++p) {
    const double h = 1e-5;
    const std::vector<double> up = c.moved<axes>(p, h), down = c.moved<axes>(p, -h);
    double largest = 0, apart = 0;
    for (std::size_t i = 0; i < up.size(); ++i) {
      const double slope = J[i * static_cast<std::size_t>(m.columns) + static_cast<std::size_t>(p)];
      largest = std::max(largest, std::abs(slope));
      apart = std::max(apart, std::abs((up[i] - down[i]) / (2 * h) - slope));
    }
    EXPECT_GT(largest, 0.0) << "parameter " << p;
    // Central differences: rounding 1e-16 * 45 / 1e-5 and curvature of h^2
    EXPECT_LT(apart, 1e-6 * largest + 1e-9) << "parameter " << p;
  }
}

TEST(OutputError, SlopesAreThoseOfDifferences) {
  expect_slopes<Axes::longitudinal>(Case(false, true, false));
  expect_slopes<Axes::longitudinal>(Case(false, true, true));
  expect_slopes<Axes::lateral>(Case(true, false, false));
  expect_slopes<Axes::six>(Case(true, true, false));
  expect_slopes<Axes::six>(Case(true, true, true));
}

TEST(OutputError, TheKernelsAgreeWhereBothServe) {
  Case c(false, true, true);
  c.m.table = &c.table;
  for (int i : {2, 3, 5, 6})  // a symmetric motion
    for (int k = 0; k < 150; ++k)
      c.inputs[static_cast<std::size_t>(k * alula::kManeuverInputs + i)] = 0;
  const auto small = c.moved<Axes::longitudinal>(-2, 0.0), large = c.moved<Axes::six>(-2, 0.0);
  for (std::size_t i = 0; i < small.size(); ++i) EXPECT_NEAR(small[i], large[i], 1e-9);
}

TEST(OutputError, SumsAreThoseOfTheSlopesAndSkipWhatIsMissing) {
  Case c(false, true, false);
  c.m.table = &c.table;
  c.measured[3] = c.measured[7 * 9 + 1] = std::nan("");
  const auto& m = c.m;
  const int k = m.columns, rows = alula::rows_of(m.outputs);
  std::vector<double> J(static_cast<std::size_t>(m.samples * m.outputs * k)),
      y(static_cast<std::size_t>(m.samples * m.outputs)),
      information(static_cast<std::size_t>(k * k * rows)),
      gradient(static_cast<std::size_t>(k * rows));
  alula::OutputErrorSums sums;
  sums.information = information.data();
  sums.gradient = gradient.data();
  sums.predicted = y.data();
  sums.sensitivity = J.data();
  alula::fly_maneuver<Axes::longitudinal>(m, c.values.data(), c.initial, c.bias, sums);
  for (int o = 0; o < m.outputs; ++o) {
    double squares = 0, slope = 0, element = 0;
    int count = 0;
    for (int n = 0; n < m.samples; ++n) {
      const auto i = static_cast<std::size_t>(n * m.outputs + o);
      if (std::isnan(c.measured[i])) continue;
      const double e = c.measured[i] - y[i], *row = &J[i * static_cast<std::size_t>(k)];
      squares += e * e;
      slope += row[1] * e;
      element += row[1] * row[2];
      ++count;
    }
    EXPECT_EQ(sums.counts[o], count);
    EXPECT_NEAR(sums.squares[o], squares, 1e-12 * squares);
    EXPECT_NEAR(gradient[static_cast<std::size_t>(rows + o)], slope, 1e-9 * (1 + std::abs(slope)));
    EXPECT_NEAR(information[static_cast<std::size_t>((k + 2) * rows + o)], element,
                1e-9 * (1 + std::abs(element)));
  }
}

TEST(OutputError, AMotionThatDivergesStops) {
  Case c(false, true, false);
  c.m.table = &c.table;
  c.m.pull[alula::kMotionAlpha] = 0;
  c.values[4] = 400.0;  // Cm_alpha
  alula::OutputErrorSums sums;
  const int flown =
      alula::fly_maneuver<Axes::longitudinal>(c.m, c.values.data(), c.initial, c.bias, sums);
  EXPECT_GT(flown, 0);
  EXPECT_LT(flown, c.m.samples);
}

TEST(OutputError, FlyingAllocatesNothing) {
  Case c(true, true, true);
  c.m.table = &c.table;
  alula::OutputErrorSums sums;
  const long before = alula_test::allocations();
  alula::fly_maneuver<Axes::six>(c.m, c.values.data(), c.initial, c.bias, sums);
  EXPECT_EQ(alula_test::allocations(), before);
  std::vector<int> control(10);  // the counter counts
  EXPECT_GT(alula_test::allocations(), before);
  EXPECT_EQ(control.size(), 10U);
}

}  // namespace
