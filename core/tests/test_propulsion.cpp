// Propeller, piston engine, electric drive and turbofan by themselves.
#include <gtest/gtest.h>

#include <cmath>

#include "engine_case.hpp"

namespace {

using namespace alula_test;
constexpr double kPi = 3.14159265358979324;

TEST(Propeller, IsItsCoefficientsInsideTheTable) {
  const auto e = with_propeller(EngineKind::piston);
  for (const double V : {0.0, 12.0, 30.0, 61.0}) {
    const double omega = 230.0, n = omega / (2 * kPi), rho = 1.1, D = 1.7, J = V / (n * D);
    const auto out = alula::propeller_loads(e.propeller, omega, V, rho);
    EXPECT_NEAR(out.thrust, alula::curve(e.propeller.CT, J) * rho * n * n * std::pow(D, 4), 1e-9);
    EXPECT_NEAR(out.torque * omega,  // power, of 1e5 W
                alula::curve(e.propeller.CP, J) * rho * n * n * n * std::pow(D, 5), 1e-7);
  }
}

TEST(Propeller, GoesOnSmoothlyToRestAndBackwards) {
  const auto p = with_propeller(EngineKind::piston).propeller;
  using D = alula::Dual<double, 8>;
  for (const double V : {-20.0, 0.0, 40.0})
    for (const double omega : {-1.0, 0.0, 1e-300, 1e-9, 1.0, 100.0}) {
      const auto out = alula::propeller_loads(p, D::variable(omega, 0), D::variable(V, 1), D(1.2));
      for (int i = 0; i < 2; ++i) {
        EXPECT_TRUE(std::isfinite(out.thrust.slope_of(i))) << V << " " << omega;
        EXPECT_TRUE(std::isfinite(out.torque.slope_of(i))) << V << " " << omega;
      }
    }
  EXPECT_EQ(alula::propeller_loads(p, 0.0, 40.0, 1.2).thrust, 0.0);
  EXPECT_EQ(alula::propeller_loads(p, 0.0, 0.0, 1.2).torque, 0.0);
  // Where the table ends, at J = 1 and at J = 0, the inner and the outer form meet.
  for (const double V : {0.0, 1.7 * 100.0 / (2 * kPi)}) {
    const auto below = alula::propeller_loads(p, 100.0, V - 1e-9, 1.2);
    const auto above = alula::propeller_loads(p, 100.0, V + 1e-9, 1.2);
    EXPECT_NEAR(below.thrust, above.thrust, 1e-6);
    EXPECT_NEAR(below.torque, above.torque, 1e-6);
  }
  EXPECT_LT(alula::propeller_loads(p, 100.0, 60.0, 1.2).torque, 0.0);  // it windmills
}

TEST(Piston, FollowsGaggAndFerrarAndItsThrottle) {
  const auto e = with_propeller(EngineKind::piston).piston;
  const double omega = 500.0 / 2.43, rho0 = alula::kSeaLevelDensity;
  // Full throttle at sea level: the table, through the gear; friction fades in within 1e-4 there.
  EXPECT_NEAR(alula::piston_loads(e, omega, 1.0, rho0).torque, 2.43 * 128.0, 2.43 * 15.0 * 1e-4);
  // Gagg and Ferrar's usual form: power ratio 1.132 sigma - 0.132.
  EXPECT_NEAR(alula::piston_loads(e, omega, 1.0, 0.7 * rho0).torque,
              2.43 * 128.0 * (1.1325 * 0.7 - 0.1325), 2.43 * 15.0 * 1e-4);
  EXPECT_LT(alula::piston_loads(e, omega, 0.0, rho0).torque, 0.0);  // the engine brakes
  EXPECT_GT(alula::piston_loads(e, 20.0, 0.0, rho0).torque, -2.43 * 15.0);
  EXPECT_DOUBLE_EQ(alula::piston_loads(e, omega, 1.7, rho0).torque,
                   alula::piston_loads(e, omega, 1.0, rho0).torque);
  // Fuel at full throttle: specific consumption times shaft power, 128 N m at 500 rad/s.
  EXPECT_NEAR(alula::piston_loads(e, omega, 1.0, rho0).fuel_flow, 7.5e-8 * 64000.0, 1e-12);
  EXPECT_GT(alula::piston_loads(e, omega, 0.0, rho0).fuel_flow, 0.0);
  EXPECT_GE(alula::piston_loads(e, omega, 1.0, 0.05).fuel_flow, 0.0);  // where no power is left
}

TEST(Electric, ConservesPowerAndKeepsItsLimits) {
  auto e = with_propeller(EngineKind::electric).electric;
  e.k_T = 1.0 / e.k_V;  // no other losses than those of the current
  e.no_load_current = 0.0;
  const double omega = 600.0, throttle = 0.8, charge = 3600.0;
  const double U = alula::battery_voltage(e, charge);
  EXPECT_DOUBLE_EQ(U, 36.0 + 6.0 * 0.75);
  const auto out = alula::electric_loads(e, omega, throttle, charge);
  EXPECT_NEAR(out.motor_current, (throttle * U - omega / 22.5) / 0.1282, 1e-12);
  EXPECT_NEAR(U * out.current, out.torque * omega + 0.1282 * out.motor_current * out.motor_current,
              1e-9);
  EXPECT_DOUBLE_EQ(alula::electric_loads(e, 0.0, 1.0, 0.0).motor_current, 90.0);
  EXPECT_DOUBLE_EQ(alula::electric_loads(e, 900.0, 0.1, 0.0).motor_current, 0.0);
  e.most_regenerated_current = 20.0;
  EXPECT_DOUBLE_EQ(alula::electric_loads(e, 900.0, 0.1, 0.0).motor_current, -20.0);
  EXPECT_LT(alula::electric_loads(e, 900.0, 0.1, 0.0).current, 0.0);
  EXPECT_DOUBLE_EQ(alula::battery_voltage(e, 20000.0), 36.0);  // empty, and not below
}

TEST(Turbofan, TakesItsTablesBetweenIdleMilitaryAndMaximum) {
  const double mach[] = {0.0, 1.0}, height[] = {0.0, 10000.0};
  const double idle[] = {500.0, 100.0, -200.0, 50.0}, military[] = {9000.0, 3000.0, 8000.0, 4000.0};
  const double maximum[] = {15000.0, 6000.0, 16000.0, 8000.0};
  const auto table = [&](const double* values) {
    return alula::Lookup<double>{values, {mach, height, nullptr}, {2, 2, 1}, 2};
  };
  alula::Turbofan<double> e;
  e.idle = table(idle);
  e.military = table(military);
  EXPECT_DOUBLE_EQ(alula::turbofan_thrust(e, 0.5, 0.0, 0.0), 4750.0);
  e.maximum = table(maximum);
  e.military_at = 0.77;
  EXPECT_DOUBLE_EQ(alula::turbofan_thrust(e, 0.0, 1.0, 10000.0), 50.0);
  EXPECT_DOUBLE_EQ(alula::turbofan_thrust(e, 0.77, 0.0, 0.0), 9000.0);
  EXPECT_DOUBLE_EQ(alula::turbofan_thrust(e, 1.0, 0.0, 5000.0), 10500.0);
  e.tau = 2.0;
  EXPECT_DOUBLE_EQ(alula::turbofan_rate(e, 0.2, 0.8), 0.3);
}

}  // namespace
