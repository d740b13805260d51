// Quaternion laws over regimes: none, tiny, large and random rotations.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "alula/math/quaternion.hpp"
#include "alula/math/rk4.hpp"

namespace {

using alula::Quaternion;
using alula::Vec3;

constexpr double kPi = 3.14159265358979323846;

void expect_near(const Vec3<double>& a, const Vec3<double>& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Attitude, NoseUpSeesGravityAft) {
  // Pitched up by 90 degrees, down (the Earth's z) points out of the tail: minus x of the body.
  const auto q = alula::quaternion_from_euler(0.0, kPi / 2, 0.0);
  expect_near(alula::earth_to_body(q) * Vec3<double>{0, 0, 1}, {-1, 0, 0}, 1e-15);
}

TEST(Attitude, RightWingDownSeesGravityRight) {
  const auto q = alula::quaternion_from_euler(kPi / 2, 0.0, 0.0);
  expect_near(alula::earth_to_body(q) * Vec3<double>{0, 0, 1}, {0, 1, 0}, 1e-15);
}

TEST(Attitude, HeadingEastSeesEastAhead) {
  const auto q = alula::quaternion_from_euler(0.0, 0.0, kPi / 2);
  expect_near(alula::earth_to_body(q) * Vec3<double>{0, 1, 0}, {1, 0, 0}, 1e-15);
}

TEST(Attitude, EulerAnglesComeBack) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const double size : {0.0, 1e-8, 1e-3, 1.0}) {
    for (int i = 0; i < 100; ++i) {
      const Vec3<double> angles{size * 3.1 * unit(random), size * 1.5 * unit(random),
                                size * 3.1 * unit(random)};
      const auto q = alula::quaternion_from_euler(angles.x, angles.y, angles.z);
      // atan2 near 85 degrees of pitch loses about one digit
      expect_near(alula::euler_from_quaternion(q), angles, 1e-13);
    }
  }
}

TEST(Attitude, RotationKeepsLengthAndComesBack) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    Quaternion<double> q{normal(random), normal(random), normal(random), normal(random)};
    const double k = 1.0 / std::sqrt(norm_squared(q));
    q = {k * q.w, k * q.x, k * q.y, k * q.z};
    const Vec3<double> v{normal(random), normal(random), normal(random)};
    const auto R = alula::earth_to_body(q);
    EXPECT_NEAR(determinant(R), 1.0, 1e-14);
    expect_near(alula::transposed_times(R, R * v), v, 1e-14);
  }
}

struct State {
  double v[4];
  static constexpr int size() { return 4; }
  double& operator[](int i) { return v[i]; }
  double operator[](int i) const { return v[i]; }
};

TEST(Attitude, SteadyRollTurnsByRateTimesTime) {
  State q{{1, 0, 0, 0}};
  const double p = 1.0, dt = 0.01;
  for (int i = 0; i < 100; ++i)
    alula::rk4_step(
        [&](double, const State& x, State& dx) {
          const auto r = alula::attitude_rate(Quaternion<double>{x[0], x[1], x[2], x[3]},
                                              Vec3<double>{p, 0, 0}, 1.0);
          dx = {{r.w, r.x, r.y, r.z}};
        },
        i * dt, dt, q);
  // Truncation of RK4: (p dt)^5 / 120 a step, times 100 steps: below 1e-10.
  EXPECT_NEAR(alula::euler_from_quaternion(Quaternion<double>{q[0], q[1], q[2], q[3]}).x, 1.0,
              1e-10);
}

TEST(Attitude, NormIsDrawnBackToOne) {
  State q{{1.1, 0, 0, 0}};
  for (int i = 0; i < 2000; ++i)
    alula::rk4_step(
        [](double, const State& x, State& dx) {
          const auto r = alula::attitude_rate(Quaternion<double>{x[0], x[1], x[2], x[3]},
                                              Vec3<double>{0.1, -0.2, 0.3}, 1.0);
          dx = {{r.w, r.x, r.y, r.z}};
        },
        0.0, 0.01, q);
  // After 20 s with 1/s: 0.1 exp(-20) is left, 2e-10.
  EXPECT_NEAR(norm_squared(Quaternion<double>{q[0], q[1], q[2], q[3]}), 1.0, 1e-8);
}

TEST(RungeKutta, IsOfFourthOrder) {
  // x' = x cos(t): x = exp(sin(t)). Halving the step divides the error by 16.
  struct One {
    double v;
    static constexpr int size() { return 1; }
    double& operator[](int) { return v; }
    double operator[](int) const { return v; }
  };
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const int n = 20 << k;
    const double h = 2.0 / n;
    One x{1.0};
    for (int i = 0; i < n; ++i)
      alula::rk4_step([](double t, const One& a, One& dx) { dx.v = a.v * std::cos(t); }, i * h, h,
                      x);
    error[k] = std::abs(x.v - std::exp(std::sin(2.0)));
  }
  EXPECT_NEAR(error[0] / error[1], 16.0, 2.0);  // the next order's part of the error
}

}  // namespace
