// States behind the body's: where they stand, exact Jacobians, mass that burns, a whole flight.
#include <gtest/gtest.h>

#include <cmath>
#include <new>
#include <vector>

#include "aircraft_case.hpp"
#include "allocations.hpp"
#include "alula/motion/jacobian.hpp"
#include "alula/motion/settle.hpp"

namespace {

using aircraft_case::Full;
using aircraft_case::level_flight;
using Input = alula::FlightInput<double>;
using Output = alula::FlightOutput<double>;
using State = alula::FlightState<double>;

const Input kInput{-0.05, 0.02, 0.01, 0, 0.7, 600, 1, -0.5, 0.3, 0.02, -0.01, 0.03};

State settled(const alula::AircraftModel<double>& a, State x) {
  for (int i = alula::kBodyStates; i < alula::kMaxStates; ++i) x[i] = 0.0;
  alula::settle(a, kInput, x);
  return x;
}

TEST(FurtherStates, StandInTheOrderOfTheContract) {
  const Full full;
  const auto& l = full.a.layout;
  EXPECT_EQ(l.engine[0], -1);  // a given thrust has no state
  EXPECT_EQ(l.engine[1], 13);
  EXPECT_EQ(l.engine[2], 14);
  EXPECT_EQ(l.charge, 15);
  EXPECT_EQ(l.stall[0], 16);
  EXPECT_EQ(l.stall[1], 17);
  EXPECT_EQ(l.actuator[0], 18);
  EXPECT_EQ(l.actuator[4], 19);
  EXPECT_EQ(l.fuel, 20);
  EXPECT_EQ(l.size, 21);
}

TEST(FurtherStates, SettledOnesRest) {
  const Full full;
  const auto x = settled(full.a, level_flight<double>());
  const auto rate = alula::derivative(0.0, x, kInput, full.a);
  EXPECT_GT(x[13], 100.0);
  EXPECT_NEAR(rate[13], 0.0, 1e-9);  // bisected to rounding of 200 rad/s
  EXPECT_NEAR(rate[14], 0.0, 1e-9);
  EXPECT_DOUBLE_EQ(rate[18], 0.0);
  EXPECT_DOUBLE_EQ(rate[19], 0.0);
  EXPECT_GT(rate[15], 0.0);  // charge and fuel are drawn
  EXPECT_GT(rate[20], 0.0);
}

void expect_exact(const alula::AircraftModel<double>& a, const State& x) {
  const int n = a.layout.size, m = alula::kFlightInputs, k = alula::kFlightOutputs;
  std::vector<double> A(n * n), B(n * m), C(k * n), D(k * m);
  alula::jacobian(x, kInput, a, A.data(), B.data(), C.data(), D.data());
  const auto at = [&](int j, double off, State& rate, Output& y) {
    State moved = x;
    Input u = kInput;
    (j < n ? moved[j] : u[static_cast<unsigned>(j - n)]) += off;
    alula::derivative_and_outputs(moved, u, a, rate, y);
  };
  std::vector<double> size(n + k, 0.0);  // of each row, for the rounding of the differences
  for (int j = 0; j < n + m; ++j) {
    const double value = j < n ? x[j] : kInput[static_cast<unsigned>(j - n)];
    // Rounding of a place on the Earth is 1e-9 m, its curvature 1e-7 of a meter's slopes.
    const double h = j < 3 ? 0.1 : 1e-5 * (1.0 + std::abs(value));
    State up, down;
    Output y_up, y_down;
    at(j, h, up, y_up);
    at(j, -h, down, y_down);
    for (int i = 0; i < n + k; ++i) {
      const auto o = static_cast<unsigned>(i - n);
      const double difference = (i < n ? up[i] - down[i] : y_up[o] - y_down[o]) / (2 * h);
      const double magnitude = std::abs(i < n ? up[i] : y_up[o]);
      const double exact = i < n ? (j < n ? A[i * n + j] : B[i * m + j - n])
                                 : (j < n ? C[(i - n) * n + j] : D[(i - n) * m + j - n]);
      // Central differences: third derivatives times h^2/6, rounding of the value over h.
      EXPECT_NEAR(exact, difference, 2e-6 + 1e-6 * std::abs(exact) + 4e-16 * magnitude / h)
          << "row " << i << " column " << j;
    }
  }
}

TEST(Jacobian, IsExactOnAFlatEarth) {
  Full full;
  auto x = settled(full.a, level_flight<double>());
  x[16] = 0.6;
  x[17] = 0.8;
  x[18] = -0.02;
  x[19] = 0.6;  // off the kink where an actuator turns back
  x[20] = 20.0;
  expect_exact(full.a, x);
}

TEST(Jacobian, IsExactOverTheTurningEarth) {
  Full full;
  full.a.earth = alula::Earth::wgs84;
  full.a.stability_axes = false;
  auto x = settled(full.a, aircraft_case::over_wgs84(level_flight<double>()));
  x[16] = 0.6;
  x[19] = 0.6;
  x[20] = 20.0;
  expect_exact(full.a, x);
}

TEST(Fuel, BurningKeepsWhatIsLeft) {
  // Taking the fuel away and putting it back: mass, first and second moments of the whole.
  const Full full;
  const auto& a = full.a;
  const double used = 25.0;
  const auto now = alula::after_burning(a.body, a.fuel, used);
  EXPECT_DOUBLE_EQ(now.body.mass, 560.0 - used);
  const alula::Vec3<double> back =
      (now.body.mass / 560.0) * now.shift + (used / 560.0) * a.fuel.position;
  EXPECT_NEAR(back.x, 0.0, 1e-15);
  EXPECT_NEAR(back.z, 0.0, 1e-15);
  const auto of_rest = alula::point_inertia(now.body.mass, now.shift);
  const auto of_fuel = alula::point_inertia(used, a.fuel.position);
  for (int i = 0; i < 3; ++i) {
    const auto sum = now.body.inertia.row[i] + of_rest.row[i] + of_fuel.row[i] +
                     (used / 60.0) * a.fuel.inertia.row[i];
    EXPECT_NEAR(sum.x, a.body.inertia.row[i].x, 1e-9);
    EXPECT_NEAR(sum.y, a.body.inertia.row[i].y, 1e-9);
    EXPECT_NEAR(sum.z, a.body.inertia.row[i].z, 1e-9);
  }
  const auto empty = alula::after_burning(a.body, a.fuel, 100.0);
  EXPECT_DOUBLE_EQ(empty.body.mass, 500.0);
}

struct Flown {
  std::vector<double> states, outputs, inputs;
  int samples;
};

Flown fly(const alula::AircraftModel<double>& a, const State& x, alula::FlightPlan<double> plan) {
  const auto n = static_cast<std::size_t>(plan.samples);
  Flown f{std::vector<double>(n * a.layout.size), std::vector<double>(n * alula::kFlightOutputs),
          std::vector<double>(n * alula::kFlightInputs), 0};
  f.samples = alula::fly(a, x, plan, {f.states.data(), f.outputs.data(), f.inputs.data()});
  return f;
}

TEST(Flight, AllocatesNothing) {
  const Full full;
  const auto x = settled(full.a, level_flight<double>());
  const int n = 200;
  std::vector<double> controls(n * 6), gusts(n * 6), normals(4 * n * 8), references(n * 10);
  for (int i = 0; i < n; ++i) controls[i * 6 + 4] = 0.7;
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = std::sin(12.9898 * double(i)) * 1.4;
  std::vector<unsigned char> active(n, 1);
  alula::Dryden<double> dryden{8.65, 5.0, 1.5};
  alula::Pilot<double> pilot;
  pilot.gain[1][alula::kSeePhi] = -0.5;
  pilot.gain[1][alula::kSeeP] = -0.2;
  for (int i = 0; i < 5; ++i) pilot.low[i] = -0.3, pilot.high[i] = 0.3;
  alula::FlightPlan<double> plan;
  plan.samples = n;
  plan.substeps = 3;
  plan.dt = 0.02;
  plan.controls = controls.data();
  plan.gusts = gusts.data();
  plan.turbulence = &dryden;
  plan.normals = normals.data();
  plan.pilot = &pilot;
  plan.references = references.data();
  plan.active = active.data();
  std::vector<double> states(n * full.a.layout.size), outputs(n * 24), inputs(n * 12);
  const long control = alula_test::allocations();
  ::operator delete(::operator new(1));  // the counter counts
  ASSERT_GT(alula_test::allocations(), control);
  const long before = alula_test::allocations();
  const int flown = alula::fly(full.a, x, plan, {states.data(), outputs.data(), inputs.data()});
  std::vector<double> A(441), B(21 * 12), C(24 * 21), D(24 * 12);
  const long vectors = alula_test::allocations();
  alula::jacobian(x, kInput, full.a, A.data(), B.data(), C.data(), D.data());
  EXPECT_EQ(vectors, before + 4);  // these four vectors, nothing else
  EXPECT_EQ(alula_test::allocations(), vectors);
  EXPECT_EQ(flown, n);
  EXPECT_NE(inputs[12 + 6], 0.0);  // turbulence is in the record
}

TEST(Flight, HeldControlsAreSteps) {
  auto a = aircraft_case::light_aircraft<double>();
  std::vector<double> controls(3 * 6);
  controls[6] = -0.1;
  alula::FlightPlan<double> plan;
  plan.samples = 3;
  plan.dt = 0.1;
  plan.substeps = 10;
  plan.controls = controls.data();
  const auto x = level_flight<double>();
  const auto lines = fly(a, x, plan);
  plan.hold = true;
  const auto held = fly(a, x, plan);
  // In the first interval the held elevator is still at zero, in the second it is at -0.1: the
  // pitching moment then is that of a step.
  State by_hand = x;
  const Input zero{};
  Input up{};
  up[0] = -0.1;
  for (int i = 0; i < 20; ++i)
    alula::rk4_step([&](double t, const State& at,
                        State& rate) { rate = alula::derivative(t, at, i < 10 ? zero : up, a); },
                    0.0, 0.01, by_hand);
  for (int j = 0; j < 13; ++j) EXPECT_NEAR(held.states[26 + j], by_hand[j], 1e-12) << j;
  EXPECT_NE(lines.states[26 + 11], held.states[26 + 11]);
  EXPECT_EQ(held.inputs[12], -0.1);
}

TEST(Flight, EndsWhereTheStateIsNotFinite) {
  auto a = aircraft_case::light_aircraft<double>();
  a.values[7] = 3e4;  // Cm_q that drives
  alula::prepare(a);
  std::vector<double> controls(1000 * 6);
  alula::FlightPlan<double> plan;
  plan.samples = 1000;
  plan.dt = 0.05;
  plan.controls = controls.data();
  EXPECT_LT(fly(a, level_flight<double>(), plan).samples, 1000);
}

TEST(Pilot, HoldsBankWithinHisLimits) {
  auto a = aircraft_case::light_aircraft<double>();
  a.values[a.table.term_count] = -0.22;
  a.table.terms[a.table.term_count++] = {3, alula::kDa};
  alula::prepare(a);
  const int n = 400;
  std::vector<double> controls(n * 6), references(n * 10);
  for (int i = 0; i < n; ++i) {
    controls[i * 6] = -0.055;
    controls[i * 6 + 5] = 600;
    references[i * 10 + alula::kSeePhi] = 0.3;
  }
  std::vector<unsigned char> active(n, 1);
  alula::Pilot<double> pilot;
  pilot.gain[1][alula::kSeePhi] = -0.6;
  pilot.gain[1][alula::kSeeP] = -0.1;
  pilot.low[1] = -0.1;
  pilot.high[1] = 0.1;
  alula::FlightPlan<double> plan;
  plan.samples = n;
  plan.dt = 0.01;
  plan.controls = controls.data();
  plan.pilot = &pilot;
  plan.references = references.data();
  plan.active = active.data();
  const auto f = fly(a, level_flight<double>(), plan);
  ASSERT_EQ(f.samples, n);
  const double* q = &f.states[(n - 1) * 13 + 3];
  EXPECT_NEAR(alula::euler_from_quaternion(alula::Quaternion<double>{q[0], q[1], q[2], q[3]}).x,
              0.3,
              0.05);  // proportional, so that a few degrees stay
  for (int i = 0; i < n; ++i) EXPECT_LE(std::abs(f.inputs[i * 12 + 1]), 0.1);
  EXPECT_DOUBLE_EQ(f.inputs[1], -0.1);  // at first he is at the stop
}

}  // namespace
