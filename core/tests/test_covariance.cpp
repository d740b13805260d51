// Covariances stay positive definite: over many steps and under absurd tuning. The full 1e6 steps
// run where ALULA_LONG is set.
#include <gtest/gtest.h>

#include <alula/filters/extended.hpp>
#include <alula/filters/iterated.hpp>
#include <alula/filters/square_root_unscented.hpp>
#include <alula/filters/unscented.hpp>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "path_case.hpp"

namespace {

using namespace alula;

// Smallest pivot of the correlation matrix of P's upper triangle, in long double: positive exactly
// where P is positive definite.
template <int R>
long double smallest_pivot(const double (*P)[R], int n) {
  long double a[R][R], smallest = 1;
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j)
      a[i][j] = P[i][j] / std::sqrt((long double)P[i][i] * (long double)P[j][j]);
  for (int k = 0; k < n; ++k) {
    if (!(a[k][k] > 0)) return a[k][k];
    smallest = std::min(smallest, a[k][k]);
    for (int i = k + 1; i < n; ++i)
      for (int j = i; j < n; ++j) a[i][j] -= a[k][i] * a[k][j] / a[k][k];
  }
  return smallest;
}

struct Tuning {
  const char* name;
  double initial, readings, inputs;  // factors on P0, R, Q (variances); P0 and R: -1 sets mixed
};

const Tuning kTunings[] = {
    {"as meant", 1, 1, 1},
    {"nothing known, perfect sensors, no noise", 1e10, 1e-12, 0},
    {"deaf", 1, 1e12, 1},
    {"deaf and ignorant", 1e10, 1e12, 0},
    {"certain, wild", 1e-12, 1, 1e6},
    {"mixed", -1, -1, 1},
};

template <class Filter>
class Covariance : public testing::Test {};
using Filters = testing::Types<Unscented<double, kShortRow>, SquareRootUnscented<double, kShortRow>,
                               Extended<double, kShortRow>, Iterated<double, kShortRow>>;
TYPED_TEST_SUITE(Covariance, Filters);

template <class Filter>
void stays_positive(const Tuning& tuning, int steps) {
  SCOPED_TRACE(tuning.name);
  auto model = alula_test::fourteen_states<double>();
  const auto f = alula_test::flight(model, 6000, 11);
  for (int s = 0; s < model.sensors.size(); ++s)
    model.sensors[s].variance *= tuning.readings >= 0 ? tuning.readings : s % 2 ? 1e-12 : 1e12;
  for (double& sigma : model.input_sigma) sigma *= std::sqrt(tuning.inputs);
  for (double& walk : model.walk) walk *= std::sqrt(tuning.inputs);
  auto filter = std::make_unique<Filter>();
  alula_test::set_prior(*filter);
  restart(*filter, model, f.initial.data());
  for (int i = 0; i < 14; ++i)
    filter->P[i][i] *= tuning.initial >= 0 ? tuning.initial : i % 2 ? 1e10 : 1e-10;
  ASSERT_TRUE(filter->adopt(14));
  double innovation[kMaxOutputs], deviation[kMaxOutputs];
  int used = filter->update(model, &f.inputs[0], &f.readings[0], innovation, deviation);
  ASSERT_GE(used, 0) << "first update";
  for (int step = 1; step < steps; ++step) {
    const int k = step % 6000, before = (step - 1) % 6000;  // the motion repeats
    ASSERT_TRUE(filter->predict(model, &f.inputs[before * 6], &f.inputs[k * 6], 0.01)) << step;
    ASSERT_GE(filter->update(model, &f.inputs[k * 6], &f.readings[k * 7], innovation, deviation), 0)
        << step;
    if (step < 100 || step % 997 == 0) {
      ASSERT_GT(smallest_pivot(filter->P, 14), 0) << step;
      for (int i = 0; i < 14; ++i) ASSERT_TRUE(std::isfinite(filter->x[i])) << step << ' ' << i;
    }
  }
}

TYPED_TEST(Covariance, StaysPositiveDefiniteUnderAbsurdTuning) {
  for (const Tuning& tuning : kTunings) stays_positive<TypeParam>(tuning, 20000);
}

TYPED_TEST(Covariance, StaysPositiveDefiniteOverManySteps) {
  stays_positive<TypeParam>(kTunings[0], std::getenv("ALULA_LONG") ? 1000000 : 60000);
}

}  // namespace
