// Curves and lookup tables: at and between their points, outside, and their slopes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "alula/aero/lookup.hpp"
#include "alula/math/curve.hpp"

namespace {

using D = alula::Dual<double, 8>;

TEST(Curve, PassesItsPointsAndHasNoExtremeOfItsOwn) {
  const double x[] = {-1.0, -0.4, 0.0, 0.1, 0.9, 2.0}, y[] = {3.0, 3.0, 1.0, 1.2, 4.0, 4.0};
  alula::Curve<double> c;
  ASSERT_TRUE(alula::make_curve(x, y, 6, c));
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(alula::curve(c, x[i]), y[i], 1e-14);
  for (int i = 0; i < 5; ++i)
    for (int k = 0; k <= 100; ++k) {
      const double at = alula::curve(c, x[i] + (x[i + 1] - x[i]) * k / 100);
      EXPECT_GE(at, std::min(y[i], y[i + 1]) - 1e-14);  // rounding
      EXPECT_LE(at, std::max(y[i], y[i + 1]) + 1e-14);
    }
}

TEST(Curve, StraightLineStaysStraightEverywhere) {
  double x[24], y[24];
  for (int i = 0; i < 24; ++i) {
    x[i] = 0.1 * i * i;
    y[i] = 2.0 - 3.0 * x[i];
  }
  alula::Curve<double> c;
  ASSERT_TRUE(alula::make_curve(x, y, 24, c));
  for (double at = -20; at < 80; at += 0.37)
    EXPECT_NEAR(alula::curve(c, at), 2.0 - 3.0 * at, 1e-12);
}

TEST(Curve, SlopeIsContinuousAtEveryKnotAndTheEnds) {
  const double x[] = {0.0, 0.2, 0.5, 0.6, 1.0}, y[] = {0.11, 0.10, 0.06, 0.05, -0.03};
  alula::Curve<double> c;
  ASSERT_TRUE(alula::make_curve(x, y, 5, c));
  for (const double knot : x) {
    const D below = alula::curve(c, D::variable(knot - 1e-9, 0));
    const D above = alula::curve(c, D::variable(knot + 1e-9, 0));
    EXPECT_NEAR(below.slope_of(0), above.slope_of(0), 1e-7);  // 2e-9 of second derivatives of ten
    EXPECT_NEAR(below.value, above.value, 1e-9);
  }
}

TEST(Curve, RefusesWhatIsNoCurveAndSurvivesAnyArgument) {
  const double x[] = {0.0, 1.0, 1.0}, y[] = {1.0, 2.0, 3.0};
  alula::Curve<double> c;
  EXPECT_FALSE(alula::make_curve(x, y, 3, c));
  EXPECT_FALSE(alula::make_curve(x, y, 0, c));
  EXPECT_EQ(alula::curve(c, 0.3), 0.0);  // still empty
  ASSERT_TRUE(alula::make_curve(x, y, 1, c));
  EXPECT_EQ(alula::curve(c, 7.0), 1.0);
  ASSERT_TRUE(alula::make_curve(x, y, 2, c));
  EXPECT_FALSE(std::isfinite(alula::curve(c, std::numeric_limits<double>::infinity())));
  EXPECT_TRUE(std::isnan(alula::curve(c, std::nan(""))));
}

// A function that the interpolation must reproduce: linear in each variable, or of second degree.
double grid_function(double a, double b, double c, bool cubic) {
  const double square = cubic ? 0.7 * a * a - 0.3 * b * b + 0.2 * c * c + 0.1 * a * a * b : 0.0;
  return 1.0 + 2.0 * a - 3.0 * b + 0.5 * c + 0.4 * a * b - 0.2 * b * c + 0.3 * a * b * c + square;
}

struct Grid {
  double a[5] = {-1.0, -0.2, 0.1, 0.8, 2.0}, b[4] = {0.0, 0.5, 0.6, 1.4}, c[3] = {-2.0, 0.0, 3.0};
  double values[60];
  alula::Lookup<double> table(int axes, bool cubic, bool line) {
    const int nb = axes > 1 ? 4 : 1, nc = axes > 2 ? 3 : 1;
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < nb; ++j)
        for (int k = 0; k < nc; ++k)
          values[(i * nb + j) * nc + k] =
              grid_function(a[i], axes > 1 ? b[j] : 0.0, axes > 2 ? c[k] : 0.0, cubic);
    return {values,
            {a, b, c},
            {5, nb, nc},
            axes,
            cubic ? alula::Interpolation::cubic : alula::Interpolation::linear,
            line ? alula::Outside::line : alula::Outside::hold};
  }
};

TEST(Lookup, ReproducesThePolynomialsOfItsDegree) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const bool cubic : {false, true})
    for (int axes = 1; axes <= 3; ++axes) {
      Grid grid;
      const auto table = grid.table(axes, cubic, true);
      for (int trial = 0; trial < 200; ++trial) {
        const double a = -1 + 3 * unit(random), b = axes > 1 ? 1.4 * unit(random) : 0.0;
        const double c = axes > 2 ? -2 + 5 * unit(random) : 0.0;
        EXPECT_NEAR(alula::lookup(table, a, b, c), grid_function(a, b, c, cubic), 1e-12);
      }
    }
}

TEST(Lookup, OutsideIsHeldOrALine) {
  Grid grid;
  const auto held = grid.table(2, true, false);
  EXPECT_NEAR(alula::lookup(held, 9.0, -4.0, 0.0), grid_function(2.0, 0.0, 0.0, true), 1e-12);
  EXPECT_NEAR(alula::lookup(held, -9.0, 0.3, 0.0), grid_function(-1.0, 0.3, 0.0, true), 1e-12);
  Grid other;
  const auto line = other.table(1, true, true);
  // 1 + 2 a + 0.7 a^2: slope 4.8 at 2, 0.6 at -1
  EXPECT_NEAR(alula::lookup(line, 3.0, 0.0, 0.0), 7.8 + 4.8, 1e-12);
  EXPECT_NEAR(alula::lookup(line, -3.0, 0.0, 0.0), -0.3 - 1.2, 1e-12);
  Grid plain;
  const auto linear = plain.table(3, false, true);
  EXPECT_NEAR(alula::lookup(linear, 3.0, -1.0, 5.0), grid_function(3.0, -1.0, 5.0, false), 1e-12);
  EXPECT_EQ(alula::lookup(alula::Lookup<double>{}, 1.0, 1.0, 1.0), 0.0);
  EXPECT_TRUE(std::isnan(alula::lookup(linear, std::nan(""), 0.0, 0.0)));  // and no stray address
}

TEST(Lookup, SlopesMatchDifferencesInsideAndOutside) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> wide(-2.5, 3.5);
  for (const bool cubic : {false, true})
    for (const bool line : {false, true}) {
      Grid grid;
      const auto table = grid.table(3, cubic, line);
      for (int trial = 0; trial < 100; ++trial) {
        const double at[3] = {wide(random), wide(random), wide(random)};
        const D y = alula::lookup(table, D::variable(at[0], 0), D::variable(at[1], 1),
                                  D::variable(at[2], 2));
        for (int i = 0; i < 3; ++i) {
          const double h = 1e-6;
          double up[3] = {at[0], at[1], at[2]}, down[3] = {at[0], at[1], at[2]};
          up[i] += h;
          down[i] -= h;
          const double slope = (alula::lookup(table, up[0], up[1], up[2]) -
                                alula::lookup(table, down[0], down[1], down[2])) /
                               (2 * h);
          EXPECT_NEAR(y.slope_of(i), slope, 1e-7);  // rounding of values of 100 over 2e-6
        }
      }
    }
}

}  // namespace
