// Kirchhoff stall: limits, lag, hysteresis, wing drop, slopes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "alula/aero/stall.hpp"

namespace {

using alula::Wing;

alula::Stall<double> example() {
  return {20.0, 0.28, 0.25, 0.08, 5.0, -0.09, 0.35, -0.12, 0.0, 0.0};
}

TEST(Stall, SteadySeparationIsTheHyperbolicTangent) {
  const auto s = example();
  for (double alpha = -3.0; alpha < 3.1; alpha += 0.01)
    EXPECT_NEAR(alula::attached_part(s, alpha), 0.5 * (1 - std::tanh(20.0 * (alpha - 0.28))),
                1e-15);
  // Far away there is neither overflow nor a slope that is not a number.
  auto steep = s;
  steep.a1 = 1e6;
  using D = alula::Dual<double, 8>;
  for (const double alpha : {-3.0, 3.0}) {
    const D x = alula::attached_part(steep, D::variable(alpha, 0));
    EXPECT_EQ(x.value, alpha < 0 ? 1.0 : 0.0);
    EXPECT_EQ(x.slope_of(0), 0.0);
  }
}

TEST(Stall, AttachedFlowAddsNothingAndFullSeparationTakesThreeQuarters) {
  const auto s = example();
  const double alpha = 0.4;
  const auto none = alula::stall_increments(s, alpha, 1.0);
  EXPECT_EQ(none.CL, 0.0);
  EXPECT_EQ(none.CD, 0.0);
  EXPECT_EQ(none.Cm, 0.0);
  const auto full = alula::stall_increments(s, alpha, 0.0);
  EXPECT_DOUBLE_EQ(full.CL, -0.75 * 5.0 * (alpha + 0.09));
  EXPECT_DOUBLE_EQ(full.CD, 0.35);
  EXPECT_DOUBLE_EQ(full.Cm, -0.12);
  const auto beyond = alula::stall_increments(s, alpha, -0.2);
  EXPECT_EQ(beyond.CL, full.CL);
}

TEST(Stall, RootIsTheRootButForItsFirstThousandth) {
  for (double x = 0.0; x <= 1.0; x += 1e-5) {
    const double error = std::abs(alula::root_of_separation(x) - std::sqrt(x));
    EXPECT_LE(error, x < alula::kSmallX ? 0.006 : 1e-15) << x;
  }
  using D = alula::Dual<double, 8>;
  const double before = alula::kSmallX * (1 - 1e-9), behind = alula::kSmallX * (1 + 1e-9);
  EXPECT_NEAR(alula::root_of_separation(D::variable(before, 0)).slope_of(0),
              alula::root_of_separation(D::variable(behind, 0)).slope_of(0), 1e-6);
  // 1.5/sqrt(kSmallX) at zero, and one half from the left at one
  EXPECT_NEAR(alula::root_of_separation(D::variable(0.0, 0)).slope_of(0), 47.4, 0.1);
  EXPECT_DOUBLE_EQ(alula::root_of_separation(D::variable(1.0, 0)).slope_of(0), 0.5);
}

TEST(Stall, LiftIsGreaterGoingUpThanComingDown) {
  const auto s = example();
  double X = 1.0;
  const double dt = 1e-3, mean = 0.26, size = 0.12, omega = 3.0;
  double up = 0.0, down = 0.0, least = 1.0, most = 0.0;
  for (int i = 0; i < 12000; ++i) {
    const double t = i * dt, alpha = mean + size * std::sin(omega * t);
    const double alphadot = size * omega * std::cos(omega * t);
    X += dt * alula::separation_rate(s, alpha, alphadot, X);
    least = std::min(least, X);
    most = std::max(most, X);
    if (t > 6.0 && std::abs(alpha - mean) < 2e-3)
      (alphadot > 0 ? up : down) = alula::lift_lost(s, alpha, X);
  }
  EXPECT_LT(down, up - 0.2);  // less lift on the way down, by a fifth of CL and more
  EXPECT_GT(least, 0.0);
  EXPECT_LT(most, 1.0);
}

TEST(Stall, TimeConstantIsTauOne) {
  const auto s = example();
  const double alpha = 0.3, X0 = alula::attached_part(s, alpha);
  EXPECT_NEAR(alula::separation_rate(s, alpha, 0.0, X0), 0.0, 1e-15);
  EXPECT_NEAR(alula::separation_rate(s, alpha, 0.0, X0 + 0.1), -0.4, 1e-14);
  // A pitch-up of 0.5 rad/s delays stall by tau2 times that.
  EXPECT_NEAR(alula::separation_rate(s, alpha + 0.04, 0.5, X0), 0.0, 1e-14);
}

TEST(Stall, TheWingThatGoesDownStallsAndGoesOnDown) {
  auto s = example();
  s.y_station = 2.0;
  EXPECT_EQ(alula::separation_states(s), 2);
  const alula::Vec3<double> v{25.0, 0.0, 7.0}, rolling{0.5, 0, 0}, yawing{0, 0, 0.5};
  const double alpha = std::atan2(7.0, 25.0);
  const double left = alula::local_alpha(s, v, rolling, Wing::left);
  const double right = alula::local_alpha(s, v, rolling, Wing::right);
  EXPECT_DOUBLE_EQ(right, std::atan2(8.0, 25.0));
  EXPECT_DOUBLE_EQ(left, std::atan2(6.0, 25.0));
  // Yawing right, the right wing is the slower one and has the larger angle.
  EXPECT_GT(alula::local_alpha(s, v, yawing, Wing::right),
            alula::local_alpha(s, v, yawing, Wing::left));
  EXPECT_EQ(alula::local_alpha(s, alula::Vec3<double>{}, alula::Vec3<double>{}, Wing::left), 0.0);
  const double X_left = alula::attached_part(s, left, Wing::left);
  const double X_right = alula::attached_part(s, right, Wing::right);
  ASSERT_LT(X_right, X_left);
  const auto out = alula::stall_increments(s, alpha, left, right, X_left, X_right, 8.65);
  EXPECT_GT(out.Cl, 0.0);  // rolling right goes on to the right: autorotation
  EXPECT_GT(out.Cn, 0.0);  // and its drag yaws right
}

TEST(Stall, HalvesThatAreAlikeAreTheWholeWing) {
  auto s = example();
  s.y_station = 2.0;
  const auto two = alula::stall_increments(s, 0.3, 0.3, 0.3, 0.4, 0.4, 8.65);
  const auto one = alula::stall_increments(s, 0.3, 0.4);
  EXPECT_DOUBLE_EQ(two.CL, one.CL);
  EXPECT_DOUBLE_EQ(two.CD, one.CD);
  EXPECT_DOUBLE_EQ(two.Cm, one.Cm);
  EXPECT_NEAR(two.Cl, 0.0, 1e-16);  // fused products round once
  EXPECT_NEAR(two.Cn, 0.0, 1e-16);
}

TEST(Stall, HalfWingsForcesGiveTheirMoments) {
  // Each half's lift and drag, turned into body axes and put at its station.
  auto s = example();
  s.y_station = 2.0;
  const double alpha = 0.35, b = 8.65;
  const double local[] = {0.3, 0.4}, X[] = {0.8, 0.2};
  double Cl = 0.0, Cn = 0.0;
  for (int side = 0; side < 2; ++side) {
    const auto half = alula::stall_increments(s, local[side], X[side]);
    const double CX = 0.5 * (half.CL * std::sin(alpha) - half.CD * std::cos(alpha));
    const double CZ = 0.5 * (-half.CL * std::cos(alpha) - half.CD * std::sin(alpha));
    const double y = side == 0 ? -2.0 : 2.0;
    Cl += y * CZ / b;  // r x F with r = (0, y, 0)
    Cn += -y * CX / b;
  }
  const auto out = alula::stall_increments(s, alpha, local[0], local[1], X[0], X[1], b);
  EXPECT_NEAR(out.Cl, Cl, 1e-15);
  EXPECT_NEAR(out.Cn, Cn, 1e-15);
}

TEST(Stall, UnequalWingsStallOneAfterTheOther) {
  auto s = example();
  s.y_station = 2.0;
  s.alpha_star_difference = 0.04;
  EXPECT_NEAR(alula::attached_part(s, 0.30, Wing::right), 0.5, 1e-14);
  EXPECT_NEAR(alula::attached_part(s, 0.26, Wing::left), 0.5, 1e-14);
  EXPECT_NEAR(alula::attached_part(s, 0.28, Wing::whole), 0.5, 1e-14);
}

TEST(Stall, SlopesMatchDifferences) {
  auto s = example();
  s.y_station = 1.5;
  using D = alula::Dual<double, 8>;
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto all = [&](auto a, auto left, auto right, auto Xl, auto Xr, auto rate) {
    const auto out = alula::stall_increments(s, a, left, right, Xl, Xr, 8.0);
    return out.CL + 2.0 * out.CD + 3.0 * out.Cl + 4.0 * out.Cm + 5.0 * out.Cn +
           alula::separation_rate(s, left, rate, Xl, Wing::left);
  };
  for (int trial = 0; trial < 200; ++trial) {
    double x[6];
    for (double& v : x) v = 0.01 + 0.6 * unit(random);
    D d[6];
    for (int i = 0; i < 6; ++i) d[i] = D::variable(x[i], i);
    const D y = all(d[0], d[1], d[2], d[3], d[4], d[5]);
    for (int i = 0; i < 6; ++i) {
      const double h = 1e-6;
      double up[6], down[6];
      for (int j = 0; j < 6; ++j) {
        up[j] = x[j] + (i == j ? h : 0);
        down[j] = x[j] - (i == j ? h : 0);
      }
      const double slope = (all(up[0], up[1], up[2], up[3], up[4], up[5]) -
                            all(down[0], down[1], down[2], down[3], down[4], down[5])) /
                           (2 * h);
      EXPECT_NEAR(y.slope_of(i), slope, 1e-7 * (1 + std::abs(slope)));  // h^2 of third derivatives
    }
  }
}

}  // namespace
