// The equations of motion as a whole: no allocation, float as good as float is, laws of physics.
#include <gtest/gtest.h>

#include <cmath>
#include <new>
#include <type_traits>

#include "aircraft_case.hpp"
#include "allocations.hpp"
#include "alula/math/rk4.hpp"
#include "alula/sensors/error_model.hpp"
#include "alula/sensors/lever_arm.hpp"

namespace {

using aircraft_case::level_flight;
using aircraft_case::light_aircraft;
using Input = alula::FlightInput<double>;
using State = alula::FlightState<double>;

template <class T>
void step(const alula::AircraftModel<T>& a, alula::FlightState<T>& x, int steps) {
  const alula::FlightInput<T> u{T(-0.05), T(0.01), T(0), T(0), T(0), T(600)};
  for (int i = 0; i < steps; ++i)
    alula::rk4_step([&](T t, const alula::FlightState<T>& at,
                        alula::FlightState<T>& rate) { rate = alula::derivative(t, at, u, a); },
                    T(0), T(0.01), x);
}

TEST(Aircraft, TableIsWellFormedAndSmall) {
  auto a = light_aircraft<double>();
  EXPECT_TRUE(alula::well_formed(a.table));
  EXPECT_LT(sizeof(a.table), 2048u);
  EXPECT_TRUE(std::is_trivially_copyable_v<alula::TermTable>);
  a.table.steps[0].b = alula::kVariables;  // itself
  EXPECT_FALSE(alula::well_formed(a.table));
  aircraft_case::Full full;
  EXPECT_TRUE(alula::well_formed(full.a.table, 1));
  EXPECT_FALSE(alula::well_formed(full.a.table, 0));  // a lookup without its table
}

TEST(Aircraft, StepsGiveSignsAndLookedUpValues) {
  aircraft_case::Full full;
  double slots[alula::kMaxSlots] = {1.0};
  for (const double beta : {-0.1, 0.0, 0.1}) {
    slots[alula::kBeta] = beta;
    slots[alula::kAlpha] = 0.15;  // a breakpoint
    alula::fill_slots(full.a.table, slots, full.a.lookups);
    EXPECT_EQ(slots[alula::kVariables + 4], beta == 0.0 ? 0.0 : beta / std::abs(beta));
    EXPECT_DOUBLE_EQ(slots[alula::kVariables + 3], 0.03);
  }
}

TEST(Aircraft, RowsOfTermsGiveWhatTheTableGives) {
  const aircraft_case::Full full;
  ASSERT_GT(full.a.rows.rows, 0);
  double slots[alula::kMaxSlots];
  for (int i = 0; i < alula::kMaxSlots; ++i) slots[i] = std::sin(1.0 + i);
  const auto by_rows = alula::coefficients(full.a.rows, slots);
  const auto by_terms = alula::coefficients(full.a.table, full.a.values.data(), slots);
  for (unsigned i = 0; i < 6; ++i) EXPECT_NEAR(by_rows[i], by_terms[i], 1e-14);  // fused products
  // Too many terms of one coefficient: no rows, and the table is read itself.
  alula::TermTable long_one{};
  long_one.term_count = 13;
  EXPECT_EQ(alula::term_rows(long_one, full.a.values.data()).rows, 0);
}

TEST(Aircraft, FloatFollowsDouble) {
  auto xd = level_flight<double>();
  auto xf = level_flight<float>();
  step(light_aircraft<double>(), xd, 500);
  step(light_aircraft<float>(), xf, 500);
  // 500 steps of rounding at 6e-8 of 1000 m and 45 m/s
  EXPECT_NEAR(xf[2], xd[2], 0.05);
  for (int i = 3; i < 13; ++i) EXPECT_NEAR(xf[i], xd[i], 2e-3) << i;
}

TEST(Aircraft, StandsStillWithoutAirspeed) {
  auto a = light_aircraft<double>();
  a.wind = {};
  State x;
  x.length = 13;
  x[3] = 1.0;
  const auto rate = alula::derivative(0.0, x, Input{}, a);
  for (int i = 0; i < 13; ++i) EXPECT_DOUBLE_EQ(rate[i], i == 9 ? alula::kStandardGravity : 0.0);
}

TEST(Aircraft, MomentMovesWithTheReferencePoint) {
  // The same loads stated about a point further aft: Cm there is Cm - CZ dx/c for body axes.
  auto a = light_aircraft<double>();
  a.stability_axes = false;
  a.wind = {};
  const auto x = level_flight<double>();
  const auto at = alula::place(x, a.earth, a.gravity);
  a.reference_point = {};
  const auto at_cg = alula::loads(x, Input{}, a, a.wind, at);
  a.reference_point = {-0.2, 0, 0};
  const auto aft = alula::loads(x, Input{}, a, a.wind, at);
  EXPECT_DOUBLE_EQ(aft.force.z, at_cg.force.z);
  EXPECT_NEAR(aft.moment.y, at_cg.moment.y + 0.2 * at_cg.force.z, 1e-9);  // of about 1000 N m
}

TEST(Aircraft, GustIsWindInBodyAxes) {
  // Wind of the same velocity, and a gust that turns: what the aerodynamics sees is w - w_gust.
  auto a = light_aircraft<double>();
  auto x = level_flight<double>();
  const auto at = alula::place(x, a.earth, a.gravity);
  const auto with_wind = alula::loads(x, Input{}, a, a.wind, at);
  const auto v = at.R_BN * a.wind.steady;
  a.wind = {};
  const Input gust{0, 0, 0, 0, 0, 0, v.x, v.y, v.z, 0.1, 0.05, -0.05};
  const auto with_gust = alula::loads(x, gust, a, a.wind, at);
  x[10] = x[11] = x[12] = 0.0;
  const auto none = alula::loads(x, Input{0, 0, 0, 0, 0, 0, v.x, v.y, v.z}, a, a.wind, at);
  EXPECT_NEAR(with_gust.force.x, with_wind.force.x, 1e-9);
  EXPECT_NEAR(with_gust.flow.beta, with_wind.flow.beta, 1e-15);
  EXPECT_NEAR(with_gust.moment.x, none.moment.x, 1e-9);
  EXPECT_NEAR(with_gust.moment.y, none.moment.y, 1e-9);
}

TEST(Aircraft, SlowFlightOverTheTurningEarthIsFlightOverAFlatOne) {
  // At rest over the ground gravity is along down within 0.2 deg; the rates of change of velocity
  // differ by Coriolis' acceleration, 2 W v = 7e-3 m/s2 at 45 m/s, and by gravity, 0.02 m/s2.
  auto a = light_aircraft<double>();
  const auto x = level_flight<double>();
  const auto flat = alula::derivative(0.0, x, Input{}, a);
  a.earth = alula::Earth::wgs84;
  const auto round = alula::derivative(0.0, aircraft_case::over_wgs84(x), Input{}, a);
  for (int i = 7; i < 10; ++i) EXPECT_NEAR(round[i], flat[i], 0.03) << i;
  for (int i = 10; i < 13; ++i) EXPECT_NEAR(round[i], flat[i], 2e-2) << i;  // air turns: 7e-5 rad/s
}

TEST(Aircraft, FreeFallOverTheTurningEarthKeepsItsEnergy) {
  // Jacobi's integral of the turning frame: v^2/2 + U - (W r)^2/2, U from the same J2 field.
  alula::AircraftModel<double> a;
  a.body = alula::mass_properties(1.0, alula::Mat3<double>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  a.earth = alula::Earth::wgs84;
  alula::prepare(a);
  auto x = aircraft_case::over_wgs84(level_flight<double>());
  x[7] = 7000.0;  // nearly in orbit, as if there were no air
  x[9] = -300.0;
  const auto integral = [](const State& s) {
    using namespace alula::wgs84;
    const double r2 = s[0] * s[0] + s[1] * s[1] + s[2] * s[2], r = std::sqrt(r2);
    const double U = -kGM / r * (1 - kJ2 * kRadius * kRadius / r2 * (1.5 * s[2] * s[2] / r2 - 0.5));
    const double v2 = s[7] * s[7] + s[8] * s[8] + s[9] * s[9];
    return 0.5 * v2 + U - 0.5 * kRate * kRate * (s[0] * s[0] + s[1] * s[1]);
  };
  const double before = integral(x);
  for (int i = 0; i < 3000; ++i)
    alula::rk4_step([&](double t, const State& at,
                        State& rate) { rate = alula::derivative(t, at, Input{}, a); },
                    0.0, 0.05, x);
  EXPECT_NEAR(integral(x) / before, 1.0, 1e-11);  // rounding of 3000 steps
}

TEST(Sensors, LeverArmOfSteadyRotationIsCentripetal) {
  const alula::Vec3<double> none{0, 0, 0}, w{0, 0, 2}, r{3, 0, 0};
  const auto f = alula::specific_force_at(none, w, none, r);
  EXPECT_DOUBLE_EQ(f.x, -12.0);  // -w^2 r, toward the axis
  const auto v = alula::velocity_at(none, w, r);
  EXPECT_DOUBLE_EQ(v.y, 6.0);  // yawing right, the nose moves right
}

TEST(Sensors, ErrorsApplyInOrder) {
  const alula::SensorError<double> error{0.01, 0.5, 2.0, 0.25};
  // 1.01 * 10 + 0.5 + 2 * 0.1 = 10.8, nearest quarter 10.75
  EXPECT_DOUBLE_EQ(alula::reading(error, 10.0, 0.1), 10.75);
}

}  // namespace
