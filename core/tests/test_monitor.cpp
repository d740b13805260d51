// The monitor of flow-angle sources: each fault is named, the vote carries on.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "allocations.hpp"
#include "alula/airdata/monitor.hpp"

namespace {

using namespace alula::airdata;
constexpr double kDeg = 0.017453292519943295;

template <class S>
class Monitor : public ::testing::Test {};
using Scalars = ::testing::Types<double, float>;
TYPED_TEST_SUITE(Monitor, Scalars);

// Reproducible standard normal numbers (sums of twelve uniform ones).
struct Normal {
  unsigned state = 1;
  double operator()() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) {
      state = state * 1664525u + 1013904223u;
      sum += (state >> 8) / 16777216.0;
    }
    return sum;
  }
};

template <class S>
MonitorSettings<S> four() {
  MonitorSettings<S> s;
  for (int i = 0; i < 4; ++i) s.sources.push({S(0.2 * kDeg), S(0.2 * kDeg), 20});
  return s;
}

enum Fault { none, stuck, biased, noisy, dead };

// 20 s of four sources at 50 Hz; source 2 fails at 10 s. Returns the worst error of the vote.
template <class S>
double run(Fault fault, MonitorState<S>& state, int& first_named, double& after) {
  const auto settings = four<S>();
  Normal normal;
  first_named = -1;
  double worst = 0.0;
  S held{};
  for (int k = 1; k <= 1000; ++k) {
    const double t = 0.02 * k, truth = kDeg * (4.0 + 3.0 * std::sin(t));
    S x[4];
    bool fresh[4] = {true, true, true, true};
    for (S& one : x) one = S(truth + 0.2 * kDeg * normal());
    const double noise = normal();
    if (k < 500) held = x[2];
    if (k >= 500) {
      if (fault == stuck) x[2] = held;
      if (fault == biased) x[2] += S(3 * kDeg);
      if (fault == noisy) x[2] += S(2 * kDeg * noise);
      if (fault == dead) fresh[2] = false;
    }
    const auto voted = monitor_step(settings, state, S(t), x, fresh);
    if (voted.named >= 0 && first_named < 0) {
      first_named = voted.named;
      after = t - 10.0;
    }
    worst = std::fmax(worst, std::abs(double(voted.angle) - truth));
  }
  return worst;
}

TYPED_TEST(Monitor, NamesTheFaultAndCarriesOn) {
  using S = TypeParam;
  const Health::Value told[] = {Health::healthy, Health::stuck, Health::biased, Health::noisy,
                                Health::dead};
  for (Fault fault : {none, stuck, biased, noisy, dead}) {
    MonitorState<S> state;
    int named = -1;
    double after = 0.0;
    const double worst = run<S>(fault, state, named, after);
    EXPECT_EQ(named, fault == none ? -1 : 2) << fault;
    EXPECT_EQ(state.source[2].health, told[fault]);
    if (fault != none) { EXPECT_LT(after, 2.0) << fault; }
    EXPECT_GE(after, 0.0);
    for (int i : {0, 1, 3}) EXPECT_EQ(state.source[i].health, Health::healthy) << fault << i;
    // Mean of three or four with noise of 0.2 deg: 0.12, over 1000 steps 3.5 times that, and what
    // a noisy or biased one adds before it is named, within the gate of 4 x 0.3.
    EXPECT_LT(worst, 1.0 * kDeg) << fault;
  }
}

TYPED_TEST(Monitor, TwoThatDisagreeAreASplitVote) {
  using S = TypeParam;
  MonitorSettings<S> s;
  for (int i = 0; i < 2; ++i) s.sources.push({S(0.2 * kDeg), S(0.2 * kDeg), 0});
  MonitorState<S> state;
  Voted<S> voted;
  for (int k = 1; k < 100; ++k) {
    const S x[2] = {S(0), S(5 * kDeg)};
    const bool fresh[2] = {true, true};
    voted = monitor_step(s, state, S(0.02 * k), x, fresh);
    EXPECT_EQ(voted.named, -1);
  }
  EXPECT_TRUE(voted.split);
  EXPECT_EQ(voted.used, 2);
}

TYPED_TEST(Monitor, BadInputLeavesTheStateAlone) {
  using S = TypeParam;
  const auto s = four<S>();
  MonitorState<S> state;
  const S nan = std::numeric_limits<S>::quiet_NaN();
  const bool fresh[4] = {true, true, true, true};
  S x[4] = {S(0.1), S(0.1), S(0.1), S(0.1)};
  monitor_step(s, state, S(1), x, fresh);
  x[1] = nan;
  auto voted = monitor_step(s, state, S(1.02), x, fresh);
  EXPECT_EQ(state.source[1].rejected, 1);
  EXPECT_EQ(state.source[1].value, S(0.1));
  EXPECT_NEAR(voted.angle, 0.1, 1e-6);
  voted = monitor_step(s, state, S(0.5), x, fresh);  // backward
  EXPECT_EQ(state.refused, 1);
  EXPECT_EQ(state.t, S(1.02));
  EXPECT_NEAR(voted.angle, 0.1, 1e-6);
  voted = monitor_step(s, state, nan, x, fresh);
  EXPECT_EQ(state.refused, 2);
  const bool silent[4] = {};
  voted = monitor_step(s, state, S(30), x, silent);  // a long gap accuses nobody
  EXPECT_EQ(voted.named, -1);
}

TYPED_TEST(Monitor, AllocatesNothing) {
  using S = TypeParam;
  long before = alula_test::allocations();
  {
    std::vector<double> control(10);
    EXPECT_GT(alula_test::allocations(), before);  // the counter counts
  }
  before = alula_test::allocations();
  MonitorState<S> state;
  int named = 0;
  double after = 0.0;
  run<S>(biased, state, named, after);
  EXPECT_EQ(alula_test::allocations(), before);
}

}  // namespace
