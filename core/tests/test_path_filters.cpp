// The filters: equal to each other where the problem is linear, free of heap, the same in
// float within what float can hold.
#include <gtest/gtest.h>

#include <alula/filters/extended.hpp>
#include <alula/filters/iterated.hpp>
#include <alula/filters/square_root_unscented.hpp>
#include <alula/filters/unscented.hpp>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "allocations.hpp"
#include "path_case.hpp"

namespace {

using namespace alula;
using alula_test::fourteen_states;
using alula_test::set_prior;

template <class Filter>
class PathFilters : public testing::Test {};
using Filters =
    testing::Types<Unscented<double, kShortRow>, Unscented<double, kLongRow>,
                   SquareRootUnscented<double, kShortRow>, SquareRootUnscented<double, kLongRow>,
                   Extended<double, kShortRow>, Extended<double, kLongRow>,
                   Iterated<double, kShortRow>, Iterated<double, kLongRow>>;
TYPED_TEST_SUITE(PathFilters, Filters);

template <class Filter, class T>
int run(Filter& filter, const PathModel<T>& model, const alula_test::Flight<T>& f) {
  return run_filter(filter, model, f.record(), PathHistory<T>{});
}

TYPED_TEST(PathFilters, FindTheBiasesWithinTheirOwnErrors) {
  const auto model = fourteen_states<double>();
  const auto f = alula_test::flight(model, 6000, 1);
  auto filter = std::make_unique<TypeParam>();
  set_prior(*filter);
  ASSERT_EQ(run(*filter, model, f), 6000);
  const double truth[7] = {0.05, -0.03, 0.04, 1e-3, -8e-4, 6e-4, 0};
  for (int i = 0; i < 7; ++i)  // seven normal numbers stay within 4 but once in 2000 seeds
    EXPECT_NEAR(filter->x[7 + i], truth[i], 4 * std::sqrt(filter->P[7 + i][7 + i])) << i;
  EXPECT_LT(std::sqrt(filter->P[7][7]), 0.02);  // from 0.1: the data have told something
  EXPECT_EQ(filter->repairs, 0);
}

TYPED_TEST(PathFilters, AllocateNothingPerStepAndPerRun) {
  const auto model = fourteen_states<double>();
  const auto f = alula_test::flight(model, 600, 2);
  const int n = model.states, ny = model.sensors.size();
  std::vector<double> x(600 * n), covariance(600 * n * (n + 1) / 2), e(600 * ny), d(600 * ny),
      nis(600);
  const PathHistory<double> history{x.data(), covariance.data(), e.data(), d.data(), nis.data()};
  auto filter = std::make_unique<TypeParam>();
  set_prior(*filter);

  long before = alula_test::allocations();
  { std::vector<double> control(3); }
  ASSERT_GE(alula_test::allocations() - before, 1) << "the counter does not count";

  before = alula_test::allocations();
  const int done = run_filter(*filter, model, f.record(), history);
  const int reached = run_smoother(*filter, model, f.record(), history);
  EXPECT_EQ(alula_test::allocations() - before, 0);
  EXPECT_EQ(done, 600);
  EXPECT_EQ(reached, 0);

  before = alula_test::allocations();
  filter->predict(model, &f.inputs[0], &f.inputs[6], 0.01);
  filter->update(model, &f.inputs[6], &f.readings[7], e.data(), d.data());
  EXPECT_EQ(alula_test::allocations() - before, 0);
}

TEST(PathOpenLoop, AllocatesNothing) {
  const auto model = fourteen_states<double>();
  const auto f = alula_test::flight(model, 200, 2);
  std::vector<double> motion(200 * 7), z(200 * 7), jm(200 * 7 * 14), jz(200 * 7 * 14), x0(14);
  std::copy(f.initial.begin(), f.initial.begin() + 7, x0.begin());
  const long before = alula_test::allocations();
  run_open_loop<double>(model, f.t.data(), f.inputs.data(), 200, x0.data(), nullptr, motion.data(),
                        z.data(), jm.data(), jz.data());
  EXPECT_EQ(alula_test::allocations() - before, 0);
}

// With attitude and rates known, velocity, height and accelerometer biases obey linear equations:
// there all filters are the Kalman filter.
TEST(PathFiltersAgree, OnALinearProblem) {
  PathModel<double> model;
  model.states = 10;
  model.dynamic = 10;
  for (int i = 0; i < 3; ++i) {
    model.slot[kBiasAx + i] = 7 + i;
    model.input_sigma[i] = 0.05;
    model.walk[7 + i] = 1e-3;
  }
  for (const Quantity q : {Quantity::height, Quantity::velocity_north, Quantity::velocity_east,
                           Quantity::velocity_down}) {
    PathSensor<double> sensor;
    sensor.quantity = q;
    sensor.variance = q == Quantity::height ? 4 : 0.04;
    sensor.position[0] = 2;
    model.sensors.push(sensor);
  }
  auto f = alula_test::flight(model, 2000, 3);
  for (int i = 11; i < 14; ++i) f.initial[i] = 1e-9;  // attitude is known
  Unscented<double, kShortRow> u;
  SquareRootUnscented<double, kShortRow> root;
  Extended<double, kShortRow> e;
  Iterated<double, kShortRow> iterated;
  for (int i = 7; i < 10; ++i) u.P[i][i] = root.P[i][i] = e.P[i][i] = iterated.P[i][i] = 0.01;
  ASSERT_EQ(run(u, model, f), 2000);
  ASSERT_EQ(run(root, model, f), 2000);
  ASSERT_EQ(run(e, model, f), 2000);
  ASSERT_EQ(run(iterated, model, f), 2000);
  EXPECT_EQ(iterated.unsettled, 0);
  const auto attitude = [](int i) { return i >= kPhi && i <= kPsi; };
  for (int i = 0; i < 10; ++i) {
    // What is not linear is the attitude's 1e-9 rad; rounding over 2000 steps is below that.
    EXPECT_NEAR(u.x[i], e.x[i], 1e-8 * (1 + std::abs(e.x[i]))) << i;
    EXPECT_NEAR(root.x[i], e.x[i], 1e-8 * (1 + std::abs(e.x[i]))) << i;
    EXPECT_NEAR(iterated.x[i], e.x[i], 1e-8 * (1 + std::abs(e.x[i]))) << i;
    for (int j = i; j < 10; ++j) {
      if (attitude(i) || attitude(j)) continue;
      const double bound = 1e-7 * std::sqrt(e.P[i][i] * e.P[j][j]);
      EXPECT_NEAR(u.P[i][j], e.P[i][j], bound) << i << ' ' << j;
      EXPECT_NEAR(root.P[i][j], e.P[i][j], bound) << i << ' ' << j;
      EXPECT_NEAR(iterated.P[i][j], e.P[i][j], bound) << i << ' ' << j;
    }
  }
}

TEST(PathFiltersAgree, WithShortAndLongRows) {
  const auto model = fourteen_states<double>();
  const auto f = alula_test::flight(model, 1000, 4);
  Unscented<double, kShortRow> a;
  Unscented<double, kLongRow> b;
  set_prior(a);
  set_prior(b);
  ASSERT_EQ(run(a, model, f), 1000);
  ASSERT_EQ(run(b, model, f), 1000);
  // The sums differ in their order only.
  for (int i = 0; i < 14; ++i) EXPECT_NEAR(a.x[i], b.x[i], 1e-9 * (1 + std::abs(a.x[i])));
}

// The same estimate, computed otherwise: histories, smoothed ones and repairs.
TEST(PathFiltersAgree, SquareRootAndCovariance) {
  const auto model = fourteen_states<double>();
  const auto f = alula_test::flight(model, 2000, 8);
  const int n = 14, packed = n * (n + 1) / 2;
  struct Run {
    std::vector<double> x = std::vector<double>(2000 * n), P = std::vector<double>(2000 * packed),
                        e = std::vector<double>(2000 * 7), d = std::vector<double>(2000 * 7);
  } a, b;
  const auto over = [&](auto& filter, Run& r) {
    set_prior(filter);
    const PathHistory<double> history{r.x.data(), r.P.data(), r.e.data(), r.d.data(), nullptr};
    ASSERT_EQ(run_filter(filter, model, f.record(), history), 2000);
    const std::vector<double> forward = r.x;
    ASSERT_EQ(run_smoother(filter, model, f.record(), history), 0);
    EXPECT_NE(forward, r.x);
    EXPECT_EQ(filter.repairs, 0);
  };
  Unscented<double, kShortRow> u;
  SquareRootUnscented<double, kShortRow> root;
  over(u, a);
  over(root, b);
  // Both round 16 digits; a covariance whose standard deviations are 1e4 apart loses eight of them.
  for (std::size_t i = 0; i < a.e.size(); ++i)
    if (std::isfinite(a.e[i])) {
      ASSERT_NEAR(a.e[i], b.e[i], 1e-8 * a.d[i]) << i;
      ASSERT_NEAR(a.d[i], b.d[i], 1e-8 * a.d[i]) << i;
    }
  for (int k = 0; k < 2000; ++k)
    for (int i = 0, at = 0; i < n; at += n - i++) {
      const double sigma = std::sqrt(a.P[k * packed + at]);
      ASSERT_NEAR(a.x[k * n + i], b.x[k * n + i], 1e-7 * sigma) << k << ' ' << i;
      ASSERT_NEAR(std::sqrt(b.P[k * packed + at]), sigma, 1e-7 * sigma) << k << ' ' << i;
    }
}

// Slow flight, velocity hardly known, sharp vanes: angles bend over the prior's width. The truth is
// drawn from the prior, so an honest filter's normalized error squared is 3 on average.
TEST(PathFiltersCurved, IteratedIsHonestWhereExtendedIsNot) {
  PathModel<double> model;
  for (const Quantity q : {Quantity::airspeed, Quantity::alpha, Quantity::beta_flank}) {
    PathSensor<double> sensor;
    sensor.quantity = q;
    sensor.variance = q == Quantity::airspeed ? 0.01 : 1e-4;
    model.sensors.push(sensor);
  }
  std::mt19937 random(17);
  std::normal_distribution<double> normal;
  constexpr int draws = 2000;
  const double m[6] = {}, mean[3] = {12, 0, 0}, sigma[3] = {3, 5, 5};
  double extended = 0, iterated = 0, error_extended = 0, error_iterated = 0;
  int count = 0, unsettled = 0;
  for (int draw = 0; draw < draws; ++draw) {
    double truth[7] = {}, z[3], e[kMaxOutputs], d[kMaxOutputs];
    for (int i = 0; i < 3; ++i) truth[kU + i] = mean[i] + sigma[i] * normal(random);
    if (truth[kU] < 1) continue;  // flying backward is another story
    const double wind[3] = {};
    const auto air = path_air(model, truth, wind, m);
    for (int s = 0; s < 3; ++s)
      z[s] = path_output(model.sensors[s], truth, air) +
             std::sqrt(model.sensors[s].variance) * normal(random);
    Extended<double, kShortRow> a;
    Iterated<double, kShortRow> b;
    for (int i = 0; i < 7; ++i) a.P[i][i] = b.P[i][i] = 1e-6;
    for (int i = 0; i < 3; ++i) {
      a.x[kU + i] = b.x[kU + i] = mean[i];
      a.P[kU + i][kU + i] = b.P[kU + i][kU + i] = sigma[i] * sigma[i];
    }
    ASSERT_EQ(a.update(model, m, z, e, d), 3);
    ASSERT_EQ(b.update(model, m, z, e, d), 3);
    const auto normalized = [&](const auto& filter) {
      double U[kShortRow][kShortRow], v[kShortRow] = {}, total = 0;
      cholesky<kShortRow>(filter.P, U, 7);
      for (int i = 0; i < 3; ++i) v[kU + i] = truth[kU + i] - filter.x[kU + i];
      std::array<double, 3> error{v[1], v[2], v[3]};
      solve<kShortRow>(U, v, 7);
      for (int i = 0; i < 3; ++i) total += error[i] * v[kU + i];
      return total;
    };
    const auto squared = [&](const auto& filter) {
      double total = 0;
      for (int i = 1; i < 4; ++i) total += (truth[i] - filter.x[i]) * (truth[i] - filter.x[i]);
      return total;
    };
    ++count;
    unsettled += b.unsettled;
    extended += normalized(a);
    iterated += normalized(b);
    error_extended += squared(a);
    error_iterated += squared(b);
  }
  EXPECT_EQ(unsettled, 0);
  // Of 2000 draws the mean has a deviation of sqrt(6/2000) = 0.055; four of them, and 0.1 for the
  // curvature that is left within the estimate's own deviation.
  EXPECT_NEAR(iterated / count, 3, 0.32);
  EXPECT_GT(extended / count, 30);
  EXPECT_LT(error_iterated, 0.1 * 0.1 * error_extended);
}

// One vane, forward speed known: whatever the start, the update ends where prediction and reading
// together are most likely, found by a search over all speeds; a full step overshoots by far.
TEST(PathFiltersCurved, IteratedFindsTheMostProbableState) {
  PathModel<double> model;
  PathSensor<double> vane;
  vane.quantity = Quantity::alpha;
  vane.variance = 1e-4;
  model.sensors.push(vane);
  const double m[6] = {}, forward = 10;
  for (const double start : {-20.0, 5.0, 50.0, 100.0})
    for (const double z : {-1.4, -0.5, 0.3, 1.5}) {
      const double sigma = 100;
      Iterated<double, kShortRow> filter;
      for (int i = 0; i < 7; ++i) filter.P[i][i] = 1e-8;
      filter.x[kU] = forward;
      filter.x[kW] = start;
      filter.P[kW][kW] = sigma * sigma;
      double e, d, best = 0, least = 1e300;
      ASSERT_EQ(filter.update(model, m, &z, &e, &d), 1);
      EXPECT_EQ(filter.unsettled, 0) << start << ' ' << z;
      for (double w = -500; w < 500; w += 0.01) {
        const double of_reading = (z - std::atan(w / forward)) / 0.01,
                     of_start = (w - start) / sigma;
        const double cost = of_reading * of_reading + of_start * of_start;
        if (cost < least) {
          least = cost;
          best = w;
        }
      }
      // The search's step, and 1e-3 of the deviation at which the filter stops.
      EXPECT_NEAR(filter.x[kW], best, 0.01 + 2e-3 * std::sqrt(filter.P[kW][kW])) << start;
    }
}

// A vane that shows a flow from behind while forward speed is known to be positive: no state
// explains it, and the filter says that it found none.
TEST(PathFiltersCurved, IteratedSaysWhenItHasNotSettled) {
  PathModel<double> model;
  PathSensor<double> vane;
  vane.quantity = Quantity::alpha;
  vane.variance = 1e-4;
  model.sensors.push(vane);
  Iterated<double, kShortRow> filter;
  for (int i = 0; i < 7; ++i) filter.P[i][i] = 1e-8;
  filter.x[kU] = 10;
  filter.x[kW] = 50;
  filter.P[kW][kW] = 900;
  const double m[6] = {}, z = -3;
  double e, d;
  EXPECT_EQ(filter.update(model, m, &z, &e, &d), 1);
  EXPECT_EQ(filter.unsettled, 1);
  EXPECT_TRUE(std::isfinite(filter.x[kW]));
  EXPECT_GT(filter.P[kW][kW], 0);
}

template <template <class, int> class Filter>
void compare_float() {
  const auto model = fourteen_states<double>();
  const auto single_model = fourteen_states<float>();
  const auto f = alula_test::flight(model, 1000, 5);
  alula_test::Flight<float> g;
  g.start = f.start;
  for (int k = 0; k < 1000; ++k) g.t.push_back(float(f.t[k]));
  g.inputs.assign(f.inputs.begin(), f.inputs.end());
  g.readings.assign(f.readings.begin(), f.readings.end());
  g.initial.assign(f.initial.begin(), f.initial.end());
  auto d = std::make_unique<Filter<double, kShortRow>>();
  auto s = std::make_unique<Filter<float, kShortRow>>();
  set_prior(*d);
  set_prior(*s);
  ASSERT_EQ(run(*d, model, f), 1000);
  ASSERT_EQ(run(*s, single_model, g), 1000);
  // 1e-3 of the value, or 0.05 of a standard deviation, which no user can see.
  for (int i = 0; i < 14; ++i)
    EXPECT_NEAR(s->x[i], d->x[i], 1e-3 * std::abs(d->x[i]) + 0.05 * std::sqrt(d->P[i][i])) << i;
}

TEST(PathFiltersInFloat, UnscentedFollowsDouble) { compare_float<Unscented>(); }
TEST(PathFiltersInFloat, ExtendedFollowsDouble) { compare_float<Extended>(); }
TEST(PathFiltersInFloat, SquareRootFollowsDouble) { compare_float<SquareRootUnscented>(); }
TEST(PathFiltersInFloat, IteratedFollowsDouble) { compare_float<Iterated>(); }

TYPED_TEST(PathFilters, LeaveThePredictionWithoutReading) {
  const auto model = fourteen_states<double>();
  const double nan = std::nan("");
  const double z[7] = {nan, nan, nan, nan, nan, nan, nan};
  double e[kMaxOutputs], d[kMaxOutputs];
  TypeParam filter;
  for (int i = 0; i < 14; ++i) filter.P[i][i] = 1;
  ASSERT_TRUE(filter.adopt(14));
  const auto at = alula_test::motion_at(0);
  std::copy(at.y, at.y + 7, filter.x);
  EXPECT_EQ(filter.update(model, at.m, z, e, d), 0);
  EXPECT_EQ(filter.x[1], at.y[1]);
  EXPECT_NEAR(filter.P[3][3], 1, 1e-12);  // a square root, squared
}

TYPED_TEST(PathFilters, StopWhereAStateIsNoNumber) {
  const auto model = fourteen_states<double>();
  auto f = alula_test::flight(model, 100, 6);
  f.inputs[50 * 6 + 1] = std::nan("");
  TypeParam filter;
  set_prior(filter);
  EXPECT_LE(run(filter, model, f), 51);
}

TEST(PathFiltersFailure, PositionNeedsTheLongRows) {
  auto model = fourteen_states<double>();
  EXPECT_TRUE(short_rows(model));
  model.motion = kMotionStatesWithPosition;
  EXPECT_FALSE(short_rows(model));
  const double u[6] = {};
  Extended<double, kShortRow> filter;
  EXPECT_FALSE(filter.predict(model, u, u, 0.01));
}

}  // namespace
