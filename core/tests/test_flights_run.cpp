// Flights side by side: each is the flight that `fly` makes of it alone, whatever the others do.
#include <gtest/gtest.h>

#include <alula/motion/flights_run.hpp>
#include <alula/motion/settle.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "aircraft_case.hpp"
#include "allocations.hpp"

namespace {

using aircraft_case::Full;
using Model = alula::AircraftModel<double>;
using State = alula::FlightState<double>;
constexpr int kSamples = 60, kSubsteps = 4;
constexpr double kStep = 0.05;

// One flight's arrays; flights differ in start, elevator, gusts and wind.
struct Case {
  State start;
  std::vector<double> controls, gusts, states, outputs, inputs;
  alula::Wind<double> wind;

  Case(const Model& a, const State& base, int number, double largest = 1.0)
      : start(base), controls(kSamples * 6), gusts(kSamples * 6), wind(a.wind) {
    start[7] += largest * number;
    start[2] -= 30.0 * number;
    for (int i = 0; i < kSamples; ++i) {
      controls[i * 6] = -0.05 + 0.02 * std::sin(0.3 * i + number);
      controls[i * 6 + 1] = 0.01 * number;
      controls[i * 6 + 4] = 0.6 + 0.05 * number;
      controls[i * 6 + 5] = 500.0;
      gusts[i * 6 + 2] = i > 20 ? 0.5 * number : 0.0;
    }
    wind.steady.x += number;
    states.resize(static_cast<std::size_t>(kSamples * a.layout.size));
    outputs.resize(kSamples * alula::kFlightOutputs);
    inputs.resize(kSamples * alula::kFlightInputs);
  }
  alula::FlightRecord<double> record() { return {states.data(), outputs.data(), inputs.data()}; }
  alula::OneOfMany<double> one() {
    return {start.data.data(), controls.data(), gusts.data(), wind, record(), 0};
  }
};

int alone(Model a, Case& c, bool hold = false) {
  a.wind = c.wind;
  alula::FlightPlan<double> plan;
  plan.samples = kSamples;
  plan.substeps = kSubsteps;
  plan.dt = kStep;
  plan.hold = hold;
  plan.controls = c.controls.data();
  plan.gusts = c.gusts.data();
  return alula::fly(a, c.start, plan, c.record());
}

template <int W>
std::array<int, W> together(const Model& a, std::vector<Case>& cases, bool hold = false) {
  std::array<alula::OneOfMany<double>, W> one;
  std::array<alula::OneOfMany<double>*, W> each;
  for (unsigned w = 0; w < W; ++w) {
    one[w] = cases[w].one();
    each[w] = &one[w];
  }
  alula::fly_side_by_side<W>(a, kSamples, kSubsteps, kStep, hold, each);
  std::array<int, W> flown;
  for (unsigned w = 0; w < W; ++w) flown[w] = one[w].flown;
  return flown;
}

void expect_same(const std::vector<double>& a, const std::vector<double>& b, int rows) {
  const auto n = a.size() / kSamples * static_cast<std::size_t>(rows);
  // Rounding of other exponentials and arctangents, grown over 240 steps of a stable flight.
  for (std::size_t i = 0; i < n; ++i)
    ASSERT_NEAR(a[i], b[i], 1e-10 * (1.0 + std::abs(a[i]))) << "number " << i;
}

void expect_as_alone(const Model& a, const State& base, bool hold = false) {
  std::vector<Case> cases, single;
  for (int i = 0; i < 4; ++i) {
    cases.emplace_back(a, base, i);
    single.emplace_back(a, base, i);
  }
  const auto flown = together<4>(a, cases, hold);
  for (unsigned i = 0; i < 4; ++i) {
    EXPECT_EQ(flown[i], alone(a, single[i], hold));
    EXPECT_EQ(flown[i], kSamples);
    expect_same(single[i].states, cases[i].states, kSamples);
    expect_same(single[i].outputs, cases[i].outputs, kSamples);
    EXPECT_EQ(single[i].inputs, cases[i].inputs);
  }
}

State everything_at(const Model& a, State x) {
  alula::FlightInput<double> u{};
  u[4] = 0.7;
  for (int i = alula::kBodyStates; i < alula::kMaxStates; ++i) x[i] = 0.0;
  alula::settle(a, u, x);
  return x;
}

TEST(SideBySide, IsEachFlightAlone) {
  expect_as_alone(aircraft_case::light_aircraft<double>(), aircraft_case::level_flight<double>());
}

TEST(SideBySide, IsEachFlightAloneWithEveryKindOfState) {
  const Full full;
  const auto x = everything_at(full.a, aircraft_case::level_flight<double>());
  expect_as_alone(full.a, x);
  expect_as_alone(full.a, x, true);
}

TEST(SideBySide, IsEachFlightAloneInAProfileOfWind) {
  Full full;
  full.a.wind.logarithmic = true;
  full.a.wind.reference_height = 300.0;
  full.a.wind.ground = 800.0;
  expect_as_alone(full.a, everything_at(full.a, aircraft_case::level_flight<double>()));
}

TEST(SideBySide, IsEachFlightAloneInOtherLayersOfTheAtmosphere) {
  const auto a = aircraft_case::light_aircraft<double>();
  std::vector<Case> cases, single;
  const double heights[] = {900.0, 10999.0, 15000.0, 25000.0};
  for (int i = 0; i < 4; ++i)
    for (auto* to : {&cases, &single}) {
      to->emplace_back(a, aircraft_case::level_flight<double>(), 1);
      to->back().start[2] = -heights[i];
      to->back().start[7] = 100.0;
    }
  together<4>(a, cases);
  for (unsigned i = 0; i < 4; ++i) {
    alone(a, single[i]);
    expect_same(single[i].states, cases[i].states, kSamples);
    expect_same(single[i].outputs, cases[i].outputs, kSamples);
  }
}

TEST(SideBySide, IsEachFlightAloneOverTheTurningEarth) {
  auto a = aircraft_case::light_aircraft<double>();
  a.earth = alula::Earth::wgs84;
  std::vector<Case> cases, single;
  for (int i = 0; i < 2; ++i)
    for (auto* to : {&cases, &single}) {
      auto x = aircraft_case::level_flight<double>();
      x[2] -= 100.0 * i;
      to->emplace_back(a, aircraft_case::over_wgs84(x), 0);
    }
  together<2>(a, cases);
  for (unsigned i = 0; i < 2; ++i) {
    alone(a, single[i]);
    expect_same(single[i].states, cases[i].states, kSamples);
    expect_same(single[i].outputs, cases[i].outputs, kSamples);
  }
}

// A flight that stands still in the air, one that is not a number from the start, one that grows
// without bound: the fourth is bit for bit what it is among flights like itself.
TEST(SideBySide, DoesNotDependOnTheOthers) {
  auto a = aircraft_case::light_aircraft<double>();
  const auto x = aircraft_case::level_flight<double>();
  std::vector<Case> calm, wild;
  for (int i = 0; i < 4; ++i) {
    calm.emplace_back(a, x, 3);
    wild.emplace_back(a, x, 3);
  }
  for (int j = 7; j < 13; ++j) wild[0].start[j] = 0.0;
  wild[0].wind.steady = {0, 0, 0};
  wild[1].start[8] = std::numeric_limits<double>::quiet_NaN();
  wild[2].start[10] = 1e200;
  together<4>(a, calm);
  const auto flown = together<4>(a, wild);
  EXPECT_EQ(flown[0], kSamples);
  EXPECT_EQ(flown[1], 0);
  EXPECT_LT(flown[2], kSamples);
  EXPECT_EQ(flown[3], kSamples);
  EXPECT_EQ(wild[3].states, calm[0].states);
  EXPECT_EQ(wild[3].outputs, calm[0].outputs);
  Case falling(a, x, 3);
  falling.start = wild[0].start;
  falling.wind = wild[0].wind;
  alone(a, falling);
  expect_same(falling.states, wild[0].states, kSamples);
  EXPECT_EQ(wild[0].outputs[6], 0.0);  // airspeed of what has not begun to fall
}

TEST(SideBySide, EndsWhereAllHaveEnded) {
  auto a = aircraft_case::light_aircraft<double>();
  a.values[7] = 3e6;  // Cm_q that drives
  alula::prepare(a);
  std::vector<Case> cases;
  std::vector<int> expected;
  for (int i = 0; i < 4; ++i) {
    cases.emplace_back(a, aircraft_case::level_flight<double>(), i, 10.0);
    Case c(a, aircraft_case::level_flight<double>(), i, 10.0);
    expected.push_back(alone(a, c));
    EXPECT_LT(expected.back(), kSamples);
  }
  const auto flown = together<4>(a, cases);
  for (unsigned i = 0; i < 4; ++i) EXPECT_EQ(flown[i], expected[i]);
}

TEST(SideBySide, AllocatesNothing) {
  const Full full;
  const auto x = everything_at(full.a, aircraft_case::level_flight<double>());
  std::vector<Case> cases;
  for (int i = 0; i < 4; ++i) cases.emplace_back(full.a, x, i);
  const long before = alula_test::allocations();
  const auto flown = together<4>(full.a, cases);
  EXPECT_EQ(alula_test::allocations(), before);
  EXPECT_EQ(flown[3], kSamples);
  ::operator delete(::operator new(1));
  EXPECT_GT(alula_test::allocations(), before);  // the counter counts
}

}  // namespace
