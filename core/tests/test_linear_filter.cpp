// The linear Kalman filter against closed forms, and free of heap.
#include <gtest/gtest.h>

#include <alula/filters/linear.hpp>
#include <cmath>
#include <vector>

#include "allocations.hpp"

namespace {

using namespace alula;

// Position and velocity under an acceleration that is white and constant over each step.
LinearSystem<double> constant_velocity(double dt, double q, double r) {
  LinearSystem<double> s;
  s.states = 2;
  s.outputs = 1;
  s.transition[0][0] = s.transition[1][1] = 1;
  s.transition[0][1] = dt;
  const double gain[2] = {0.5 * dt * dt, dt};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) s.process[i][j] = gain[i] * q * gain[j];
  s.output[0][0] = 1;
  s.noise[0][0] = r;
  return s;
}

// Steady gain [alpha, beta/dt]: Kalata 1984, by the tracking index dt^2 sigma_w / sigma_v.
TEST(LinearFilter, ReachesTheSteadyGainOfAConstantVelocityModel) {
  for (const double q : {1e-4, 1.0, 300.0}) {
    const double dt = 0.2, r = 0.5, index = dt * dt * std::sqrt(q / r);
    const double root = 0.25 * (4 + index - std::sqrt(8 * index + index * index));
    const double alpha = 1 - root * root, beta = 2 * (2 - alpha) - 4 * std::sqrt(1 - alpha);
    const auto system = constant_velocity(dt, q, r);
    Linear<double> filter;
    filter.P[0][0] = filter.P[1][1] = 10;
    double e, d, nis;
    const double z = 0;
    for (int k = 0; k < 5000; ++k) {
      filter.predict(system, nullptr);
      ASSERT_EQ(filter.update(system, &z, &e, &d, nis), 1);
    }
    // What rounding leaves after 5000 steps of a stable recursion.
    EXPECT_NEAR(filter.P[0][0] / r, alpha, 1e-12) << q;  // K = P C' R^-1
    EXPECT_NEAR(filter.P[1][0] / r * dt, beta, 1e-12) << q;
    EXPECT_NEAR(d, std::sqrt(r / (1 - alpha)), 1e-11) << q;  // S = R/(1 - alpha)
  }
}

TEST(LinearFilter, AllocatesNothing) {
  const auto system = constant_velocity(0.1, 1, 1);
  const int samples = 200;
  std::vector<double> z(samples, 1.0), x(2 * samples), P(4 * samples), e(samples), d(samples),
      nis(samples);
  z[7] = std::nan("");
  Linear<double> filter;
  filter.P[0][0] = filter.P[1][1] = 10;
  const long before = alula_test::allocations();
  const int done = run_linear<double>(filter, system, samples, nullptr, z.data(), x.data(),
                                      P.data(), e.data(), d.data(), nis.data());
  const int reached = smooth_linear<double>(filter, system, samples, nullptr, x.data(), P.data());
  EXPECT_EQ(alula_test::allocations() - before, 0);
  EXPECT_EQ(done, samples);
  EXPECT_EQ(reached, 0);
  EXPECT_TRUE(std::isnan(e[7]));
}

TEST(LinearFilter, StaysPositiveWithSharpReadingsAndNoNoise) {
  auto system = constant_velocity(0.1, 0, 1e-12);
  Linear<double> filter;
  filter.P[0][0] = filter.P[1][1] = 1e12;
  double e, d, nis;
  const double z = 1;
  for (int k = 0; k < 100000; ++k) {
    filter.predict(system, nullptr);
    ASSERT_EQ(filter.update(system, &z, &e, &d, nis), 1);
    ASSERT_GT(filter.P[0][0], 0) << k;
    ASSERT_GT(filter.P[0][0] * filter.P[1][1], filter.P[0][1] * filter.P[0][1]) << k;
  }
}

}  // namespace
