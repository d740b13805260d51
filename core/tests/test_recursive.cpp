// Recursive least squares and Fourier transforms against their definitions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "allocations.hpp"
#include "alula/estimate/recursive_fourier.hpp"
#include "alula/estimate/recursive_least_squares.hpp"

namespace {

using Filter = alula::RecursiveLeastSquares<double, 8>;

// The textbook: P <- (P - K x'P)/a with K = P x/(a + x'P x), in full matrices.
struct Textbook {
  int n;
  std::vector<double> P, value;
  Textbook(int n, double variance) : n(n), P(static_cast<std::size_t>(n * n)), value(P.size()) {
    for (int i = 0; i < n; ++i) at(i, i) = variance;
  }
  double& at(int i, int j) { return P[static_cast<std::size_t>(i * n + j)]; }
  void update(const double* x, double z, double a) {
    std::vector<double> Px(static_cast<std::size_t>(n));
    double s = a, expected = 0.0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) Px[static_cast<std::size_t>(i)] += at(i, j) * x[j];
      s += x[i] * Px[static_cast<std::size_t>(i)];
      expected += x[i] * value[static_cast<std::size_t>(i)];
    }
    for (int i = 0; i < n; ++i) {
      const double Ki = Px[static_cast<std::size_t>(i)] / s;
      value[static_cast<std::size_t>(i)] += Ki * (z - expected);
      for (int j = 0; j < n; ++j) at(i, j) -= Ki * Px[static_cast<std::size_t>(j)];
    }
    for (double& p : P) p /= a;
  }
};

void sample(std::mt19937_64& random, int n, double* x) {
  std::normal_distribution<double> normal;
  x[0] = 1.0;
  for (int i = 1; i < n; ++i) x[i] = normal(random);
}

template <class T, int Max>
double entry(const alula::RecursiveLeastSquares<T, Max>& f, int i, int j) {
  double sum = 0.0;
  for (int k = std::max(i, j); k < f.n; ++k)
    sum += (k == i ? 1.0 : f.u[k][i]) * (k == j ? 1.0 : f.u[k][j]) * f.d[k];
  return sum;
}

TEST(RecursiveLeastSquares, IsTheTextbooksWithPlainForgetting) {
  for (const double a : {1.0, 0.98}) {
    Filter f;
    f.forgetting.factor = a;
    f.forgetting.directional = false;
    const double variance[] = {100.0, 100.0, 100.0, 100.0};
    alula::start(f, 4, variance);
    for (double& b : f.bound) b = 1e9;
    Textbook t(4, 100.0);
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (int s = 0; s < 500; ++s) {
      double x[4];
      sample(random, 4, x);
      const double z = 2.0 * x[1] - x[3] + normal(random);
      alula::update(f, x, z);
      t.update(x, z, a);
    }
    for (int i = 0; i < 4; ++i) {
      // 1e-9: the textbook's own roundings, which plain forgetting lets grow
      EXPECT_NEAR(f.value[i], t.value[static_cast<std::size_t>(i)], 1e-9);
      for (int j = 0; j < 4; ++j) EXPECT_NEAR(entry(f, i, j), t.at(i, j), 1e-9);
    }
  }
}

TEST(RecursiveLeastSquares, ForgetsAlongTheRegressorOnly) {
  // The information matrix itself: R - (1 - a) R x x'R/(x'R x) + x x', for two parameters.
  Filter f;
  f.forgetting.factor = 0.9;
  const double variance[] = {2.0, 5.0};
  alula::start(f, 2, variance);
  for (double& b : f.bound) b = 1e9;
  double R[2][2] = {{0.5, 0.0}, {0.0, 0.2}};
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int s = 0; s < 50; ++s) {
    const double x[] = {normal(random), normal(random)};
    double Rx[2], along = 0.0;
    for (int i = 0; i < 2; ++i) {
      Rx[i] = R[i][0] * x[0] + R[i][1] * x[1];
      along += x[i] * Rx[i];
    }
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) R[i][j] += -0.1 * Rx[i] * Rx[j] / along + x[i] * x[j];
    EXPECT_TRUE(alula::update(f, x, 0.0).forgot);
    const double det = R[0][0] * R[1][1] - R[0][1] * R[0][1];
    EXPECT_NEAR(entry(f, 0, 0), R[1][1] / det, 1e-12);
    EXPECT_NEAR(entry(f, 1, 1), R[0][0] / det, 1e-12);
    EXPECT_NEAR(entry(f, 0, 1), -R[0][1] / det, 1e-12);
  }
}

TEST(RecursiveLeastSquares, KeepsWhatItKnowsWhereNothingIsExcited) {
  // Ten seconds of maneuver, then an hour of trim with sensor noise, at 50 Hz.
  for (const bool directional : {true, false}) {
    Filter f;
    f.forgetting.factor = 0.995;
    f.forgetting.directional = directional;
    const double variance[] = {1e4, 1e4, 1e4};
    alula::start(f, 3, variance);
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    const auto run = [&](int samples, double size) {
      for (int s = 0; s < samples; ++s) {
        const double x[] = {1.0, size * std::sin(0.1 * s), size * std::cos(0.23 * s)};
        const double z = 0.3 + 2.0 * x[1] - 4.0 * x[2] + 0.01 * normal(random);
        alula::update(f, x, z);
        for (int i = 0; i < f.n; ++i) ASSERT_GE(f.d[i], 0.0);
      }
    };
    run(500, 0.1);
    double before[3], after[3];
    alula::variances(f, before);
    EXPECT_NEAR(f.value[2], -4.0, 0.1);
    run(180000, 0.0);  // nothing but the constant
    alula::variances(f, after);
    EXPECT_NEAR(f.value[2], -4.0, 0.1);
    for (int i = 0; i < 3; ++i) EXPECT_LE(after[i], 1e4 * (1 + 1e-9));
    if (directional)
      for (int i = 1; i < 3; ++i) EXPECT_LT(after[i], 1.1 * before[i]);
    else  // what plain forgetting does: up to the bound, which holds it
      EXPECT_GT(after[1], 1e3 * before[1]);
  }
}

TEST(RecursiveLeastSquares, StaysPositiveForAMillionSamplesInSinglePrecision) {
  alula::RecursiveLeastSquares<float, 8> f;
  f.forgetting.factor = 0.999f;
  float variance[8];
  for (float& v : variance) v = 1e6f;
  alula::start(f, 8, variance);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (int s = 0; s < 1000000; ++s) {
    float x[8];
    for (int i = 0; i < 8; ++i)
      x[i] = static_cast<float>(std::pow(10.0, i % 4 - 3) * normal(random));
    x[7] = x[6] * (1.0f + 1e-4f * x[7]);  // nearly collinear
    float z = 0.1f * static_cast<float>(normal(random));
    for (int i = 0; i < 8; ++i) z += x[i] * static_cast<float>(i);
    alula::update(f, x, z);
    if (s % 1000 == 0) {
      for (int i = 0; i < 8; ++i) ASSERT_GE(f.d[i], 0.0f) << s;
    }
  }
  // Noise of 0.1 against regressors of 1 and 0.01 over some 1000 samples: standard errors of 0.003
  // and 0.3; five of them. What is collinear is known by its sum.
  EXPECT_NEAR(f.value[3], 3.0, 0.015);
  EXPECT_NEAR(f.value[1], 1.0, 1.5);
  EXPECT_NEAR(f.value[6] + f.value[7], 13.0, 0.15);
}

TEST(RecursiveLeastSquares, FollowsASuddenChangeWhenAdaptive) {
  // A derivative halves: how many samples until the estimate is within 20 % of the new value.
  const auto samples_needed = [](int window, double reset_ratio) {
    Filter f;
    f.forgetting.factor = 0.999;
    f.forgetting.window = window;
    f.forgetting.reset_ratio = reset_ratio;
    const double variance[] = {1e4, 1e4};
    alula::start(f, 2, variance);
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    for (int s = 0; s < 6000; ++s) {
      const double x[] = {1.0, std::sin(0.05 * s)};
      alula::update(f, x, (s < 3000 ? -4.0 : -2.0) * x[1] + 0.05 * normal(random));
      if (s == 2999) { EXPECT_NEAR(f.value[1], -4.0, 0.02); }
      if (s > 3000 && std::fabs(f.value[1] + 2.0) < 0.4) return s - 3000;
    }
    return 6000;
  };
  const int fixed = samples_needed(0, 0.0), adaptive = samples_needed(50, 0.0);
  EXPECT_GT(fixed, 1000);
  EXPECT_LT(adaptive, 380);  // three periods of the motion
  EXPECT_LT(samples_needed(50, 4.0), 380);
}

TEST(RecursiveLeastSquares, SamplesThatAreNotFiniteArePassedOver) {
  Filter f, g;
  const double variance[] = {1.0, 1.0};
  alula::start(f, 2, variance);
  alula::start(g, 2, variance);
  const double x[] = {1.0, 2.0}, bad[] = {1.0, std::nan("")};
  alula::update(f, x, 3.0);
  alula::update(g, x, 3.0);
  EXPECT_TRUE(std::isnan(alula::update(g, bad, 1.0).innovation));
  EXPECT_TRUE(std::isnan(alula::update(g, x, std::nan("")).innovation));
  EXPECT_EQ(f.value[0], g.value[0]);
  EXPECT_EQ(f.count, g.count);
}

TEST(RecursiveFourier, IsTheFourierTransform) {
  alula::RecursiveFourier<double> f;
  const double omega[] = {0.7, 2.0, 11.0};
  alula::start(f, omega, 3, 2, 0.02);
  double re[3] = {}, im[3] = {};
  for (int s = 0; s < 100000; ++s) {
    const double x[] = {std::sin(0.013 * s), 1.0};
    alula::update(f, x);
    for (int k = 0; k < 3; ++k) {
      re[k] += x[0] * std::cos(omega[k] * 0.02 * s);
      im[k] -= x[0] * std::sin(omega[k] * 0.02 * s);
    }
  }
  for (int k = 0; k < 3; ++k) {  // the phase after 1e5 turns: 1e5 roundings of 1e-16 times the sum
    EXPECT_NEAR(f.re[k][0], re[k], 1e-6);
    EXPECT_NEAR(f.im[k][0], im[k], 1e-6);
    EXPECT_NEAR(std::hypot(f.cosine[k], f.sine[k]), 1.0, 1e-14);
  }
}

TEST(Recursive, AllocatesNothing) {
  Filter f;
  alula::RecursiveFourier<double> g;
  const double variance[] = {1e4, 1e4, 1e4, 1e4};
  const double omega[] = {1.0, 2.0, 3.0};
  long before = alula_test::allocations();
  {
    std::vector<double> control(10);
    EXPECT_GT(alula_test::allocations(), before);
  }
  before = alula_test::allocations();
  f.forgetting = {0.99, true, 50, 0.9, 0.0, 5.0};
  alula::start(f, 4, variance);
  alula::start(g, omega, 3, 4, 0.02);
  double sum = 0.0;
  for (int s = 0; s < 2000; ++s) {
    const double x[] = {1.0, std::sin(0.1 * s), std::cos(0.07 * s), std::sin(0.031 * s)};
    alula::update(f, x, x[1] + (s > 1000 ? 3.0 : 1.0) * x[2]);
    alula::update(g, x);
    sum += alula::solve(g, 3.0).value[0];
  }
  EXPECT_EQ(alula_test::allocations(), before);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
