// The extended filter of the filter error: the Kalman filter where the motion is linear, a plain
// flight where there is no noise, consistent, and free of heap.
#include "alula/estimate/filter_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "allocations.hpp"
#include "alula/filters/linear.hpp"
#include "maneuver_case.hpp"

namespace {

using alula::Axes;
using alula::FilteredMotion;
using Case = alula_test::ManeuverCase;

// A random walk seen with noise: P - P^2/(P + R) + q dt = P has one positive root.
TEST(FilterError, ReachesTheSteadyCovarianceOfARandomWalk) {
  const double dt = .02, q[4] = {.5}, r = .01, A[4][4] = {}, none[4] = {};
  FilteredMotion<4> motion;
  double C[1][4] = {{1}}, S = 0;
  for (int k = 0; k < 500; ++k) {
    double v = 0;
    ASSERT_TRUE(motion.update(1, C, &v, &r, &S));
    motion.advance(dt, A, none, none, q);
  }
  const double step = q[0] * dt, P = .5 * (step + std::sqrt(step * step + 4 * step * r));
  EXPECT_NEAR(motion.P[0][0], P, 1e-14);  // rounding of a recursion that contracts
  EXPECT_NEAR(S, P + r, 1e-14);
}

// A damped oscillation with an input that runs straight between samples; two readings.
struct Oscillation {
  static constexpr double w = 3, d = .4, dt = .05;
  double A[4][4] = {{0, 1}, {-w * w, -2 * d * w}};
  double C[2][4] = {{1, .2}, {-w * w, -2 * d * w}};
  double q[4] = {.01, .3}, noise[2] = {.002, .05};
  static double input(int k) { return std::sin(.9 * k) > 0 ? 1 : -1; }

  // exp(A t) of the two states in closed form.
  void transition(double t, double (&phi)[2][2]) const {
    const double n = w * std::sqrt(1 - d * d), e = std::exp(-d * w * t), c = std::cos(n * t),
                 s = std::sin(n * t) / n;
    phi[0][0] = e * (c + d * w * s), phi[0][1] = e * s;
    phi[1][0] = -w * w * e * s, phi[1][1] = e * (c - d * w * s);
  }
};

TEST(FilterError, IsTheKalmanFilterOfALinearSystem) {
  const Oscillation o;
  double phi[2][2];
  o.transition(o.dt, phi);
  alula::LinearSystem<double> system;
  system.states = system.outputs = 2;
  system.inputs = 2;  // beginning and end of a sample, each with its share of the convolution
  constexpr int kParts = 200;
  for (int part = 0; part < kParts; ++part) {  // midpoint rule: errs by (dt / 200)^2
    const double share = (part + .5) / kParts;
    double after[2][2];
    o.transition(o.dt * (1 - share), after);
    for (int i = 0; i < 2; ++i) {
      system.input[i][0] += after[i][1] * (1 - share) * o.dt / kParts;
      system.input[i][1] += after[i][1] * share * o.dt / kParts;
    }
  }
  for (int i = 0; i < 2; ++i) {
    system.noise[i][i] = o.noise[i];
    for (int j = 0; j < 2; ++j) {
      system.transition[i][j] = phi[i][j];
      system.output[i][j] = o.C[i][j];
      system.process[i][j] = i == j ? .5 * o.dt * o.q[i] : 0;
      for (int k = 0; k < 2; ++k)
        system.process[i][j] += .5 * o.dt * phi[i][k] * o.q[k] * phi[j][k];
    }
  }
  alula::Linear<double> kalman;
  FilteredMotion<4> motion;
  kalman.P[0][0] = kalman.P[1][1] = motion.P[0][0] = motion.P[1][1] = .3;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double C[2][4], S[4];
  for (int k = 0; k < 60; ++k) {
    double z[2] = {normal(random), k % 7 == 3 ? std::nan("") : normal(random)};
    double e[2], deviation[2], nis, v[2];
    for (int i = 0; i < 2; ++i) {
      std::copy(o.C[i], o.C[i] + 4, C[i]);
      v[i] = z[i] - o.C[i][0] * motion.x[0] - o.C[i][1] * motion.x[1];
    }
    ASSERT_TRUE(motion.update(2, C, v, o.noise, S));
    ASSERT_GT(kalman.update(system, z, e, deviation, nis), 0);
    for (int i = 0; i < 2; ++i) {
      // The convolution above to 1e-8; the series' last term is smaller.
      EXPECT_NEAR(motion.x[i], kalman.x[i], 1e-6);
      if (std::isnan(z[i])) {
        EXPECT_EQ(v[i], 0.0);
        EXPECT_EQ(S[i * 3], 1.0);
        continue;
      }
      EXPECT_NEAR(v[i], e[i], 1e-6);
      EXPECT_NEAR(std::sqrt(S[i * 3]), deviation[i], 1e-9);
    }
    const double u[2] = {o.input(k), o.input(k + 1)}, rise[4] = {0, u[1] - u[0]};
    double rate[4] = {};
    for (int i = 0; i < 2; ++i)
      rate[i] = o.A[i][0] * motion.x[0] + o.A[i][1] * motion.x[1] + (i == 1) * .5 * (u[0] + u[1]);
    motion.advance(o.dt, o.A, rate, rise, o.q);
    kalman.predict(system, u);
  }
}

struct Filtered {
  std::vector<double> y, v, S;
  int done;
};

template <Axes axes>
Filtered filtered(const Case& c, double process, double noise) {
  const auto n = static_cast<std::size_t>(c.m.samples * c.m.outputs);
  Filtered f{std::vector<double>(n), std::vector<double>(n),
             std::vector<double>(n * static_cast<std::size_t>(c.m.outputs)), 0};
  double Q[alula::kMotionVariables], R[alula::kMeasuredOutputs];
  std::fill_n(Q, alula::kMotionVariables, process);
  std::fill_n(R, alula::kMeasuredOutputs, noise);
  f.done = alula::filter_maneuver<axes>(c.m, c.values.data(), c.initial, Q, R, f.y.data(),
                                        f.v.data(), f.S.data());
  return f;
}

// Without process noise the estimate is the flight from its initial state. Two integrators: the
// filter's, of second order, at 0.02 s and RK4, over three seconds.
template <Axes axes>
void expect_flight(Case c) {
  c.m.table = &c.table;
  c.m.pull[alula::kMotionAlpha] = 0;
  std::fill_n(c.m.bias_column, alula::kMeasuredOutputs, -1);
  const std::vector<double> flown = c.moved<axes>(-2, 0.0);
  const Filtered f = filtered<axes>(c, 0.0, 1.0);
  ASSERT_EQ(f.done, c.m.samples);
  for (std::size_t i = 0; i < flown.size(); ++i)
    ASSERT_NEAR(f.y[i], flown[i], 2e-4 * std::max(1.0, std::abs(flown[i]))) << i;
}

TEST(FilterError, FliesWhereThereIsNoProcessNoise) {
  expect_flight<Axes::longitudinal>(Case(false, true, false));
  expect_flight<Axes::longitudinal>(Case(false, true, true));
  expect_flight<Axes::lateral>(Case(true, false, false));
  expect_flight<Axes::six>(Case(true, true, true));
}

TEST(FilterError, TheKernelsAgreeWhereBothServe) {
  Case c(false, true, true);
  c.m.table = &c.table;
  for (int i : {2, 3, 5, 6})  // a symmetric motion
    for (int k = 0; k < 150; ++k)
      c.inputs[static_cast<std::size_t>(k * alula::kManeuverInputs + i)] = 0;
  const Filtered small = filtered<Axes::longitudinal>(c, 1e-4, 1e-3),
                 large = filtered<Axes::six>(c, 1e-4, 1e-3);
  for (std::size_t i = 0; i < small.y.size(); ++i) ASSERT_NEAR(small.v[i], large.v[i], 1e-9);
  for (std::size_t i = 0; i < small.S.size(); ++i) ASSERT_NEAR(small.S[i], large.S[i], 1e-9);
}

// Normalized innovations of readings with the stated noise: as many as outputs, on average.
TEST(FilterError, InnovationsAreAsLargeAsStated) {
  Case c(true, true, false);
  c.m.table = &c.table;
  const double deviation = .01;
  c.measured = filtered<Axes::six>(c, 0.0, 1.0).y;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, deviation);
  for (double& z : c.measured) z += normal(random);
  c.m.measured = c.measured.data();
  const Filtered f = filtered<Axes::six>(c, 1e-12, deviation * deviation);
  ASSERT_EQ(f.done, c.m.samples);
  const int ny = c.m.outputs;
  double nis = 0;
  for (int k = 0; k < c.m.samples; ++k) {
    double S[alula::kMaxOutputs][alula::kMaxOutputs] = {},
           U[alula::kMaxOutputs][alula::kMaxOutputs], e[alula::kMaxOutputs];
    for (int i = 0; i < ny; ++i) {
      e[i] = f.v[static_cast<std::size_t>(k * ny + i)];
      for (int j = 0; j < ny; ++j) S[i][j] = f.S[static_cast<std::size_t>((k * ny + i) * ny + j)];
    }
    ASSERT_EQ(alula::cholesky<alula::kMaxOutputs>(S, U, ny), 0);
    alula::solve<alula::kMaxOutputs>(U, e, ny);
    for (int i = 0; i < ny; ++i) nis += e[i] * f.v[static_cast<std::size_t>(k * ny + i)];
  }
  // Chi squared of 150 * 14 degrees of freedom: four deviations.
  const double freedom = c.m.samples * ny;
  EXPECT_NEAR(nis, freedom, 4 * std::sqrt(2 * freedom));
}

TEST(FilterError, StopsWhereTheMotionDiverges) {
  Case c(false, true, false);
  c.m.table = &c.table;
  c.values[4] = 400.0;  // Cm_alpha
  const Filtered f = filtered<Axes::longitudinal>(c, 0.0, 1.0);
  EXPECT_GT(f.done, 0);
  EXPECT_LT(f.done, c.m.samples);
}

TEST(FilterError, AllocatesNothing) {
  Case c(true, true, true);
  c.m.table = &c.table;
  const auto n = static_cast<std::size_t>(c.m.samples * c.m.outputs);
  std::vector<double> y(n), v(n), S(n * static_cast<std::size_t>(c.m.outputs));
  const std::vector<double> Q(alula::kMotionVariables, 1e-4), R(alula::kMeasuredOutputs, 1e-3);
  const long before = alula_test::allocations();
  alula::filter_maneuver<Axes::six>(c.m, c.values.data(), c.initial, Q.data(), R.data(), y.data(),
                                    v.data(), S.data());
  EXPECT_EQ(alula_test::allocations(), before);
  std::vector<int> control(10);  // the counter counts
  EXPECT_GT(alula_test::allocations(), before);
  EXPECT_EQ(control.size(), 10U);
}

}  // namespace
