// Engines in the airframe: signs on every axis and both senses of rotation, conservation laws,
// slopes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "alula/math/quaternion.hpp"
#include "alula/math/rk4.hpp"
#include "alula/motion/rigid_body.hpp"
#include "engine_case.hpp"

namespace {

using namespace alula_test;

TEST(Engine, ThrustLineOffsetsPitchAndYaw) {
  Engine e;  // given thrust, 1000 N in these tests
  e.share = 0.5;
  const Vec3<double> v{40, 0, 0}, w{0, 0, 0};
  e.point = {1.0, 0.0, 0.2};  // below the center of gravity: nose up
  EXPECT_DOUBLE_EQ(at(e, 0.0, 0.0, v, w).moment.y, 100.0);
  e.point = {1.0, 2.0, 0.0};  // on the right wing: nose left
  EXPECT_DOUBLE_EQ(at(e, 0.0, 0.0, v, w).moment.z, -1000.0);
  e.direction = {0.0, 0.0, -1.0};  // lifting, on the right wing: rolls left; ahead: nose up
  EXPECT_DOUBLE_EQ(at(e, 0.0, 0.0, v, w).moment.x, -1000.0);
  EXPECT_DOUBLE_EQ(at(e, 0.0, 0.0, v, w).moment.y, 500.0);
  EXPECT_DOUBLE_EQ(at(e, 0.0, 0.0, v, w).thrust, 500.0);
}

TEST(Engine, PropellerOnTheWingFeelsTheYawRate) {
  auto e = with_propeller(EngineKind::piston);
  const auto center = at(e, 230.0, 0.7, Vec3<double>{39, 0, 0}, Vec3<double>{0, 0, 0});
  e.point = {0.0, 2.0, 0.0};  // yawing right at 0.5 rad/s, the right wing is 1 m/s slower
  const auto right = at(e, 230.0, 0.7, Vec3<double>{40, 0, 0}, Vec3<double>{0, 0, 0.5});
  EXPECT_DOUBLE_EQ(right.thrust, center.thrust);
  EXPECT_DOUBLE_EQ(right.state_rate, center.state_rate);
}

TEST(Engine, ClockwisePropellerTurnsTheAirframeAsEveryPilotKnows) {
  for (const double sense : {1.0, -1.0}) {
    const auto e = with_propeller(EngineKind::electric, sense);
    const Vec3<double> v{0, 0, 0}, still{0, 0, 0};
    const auto base = at(e, 250.0, 0.5, v, still);
    // Right-hand propeller: power rolls left; a left yaw lifts the nose; a lifted tail (nose going
    // down) yaws left. The other sense: the other way.
    EXPECT_LT(sense * base.moment.x, 0.0);
    EXPECT_GT(sense * (at(e, 250.0, 0.5, v, Vec3<double>{0, 0, -0.5}).moment.y - base.moment.y),
              0.0);
    EXPECT_LT(sense * (at(e, 250.0, 0.5, v, Vec3<double>{0, -0.5, 0}).moment.z - base.moment.z),
              0.0);
    // J_P omega r, to rounding
    EXPECT_NEAR(at(e, 250.0, 0.5, v, Vec3<double>{0, 0, -0.5}).moment.y, sense * 0.6 * 250.0 * 0.5,
                1e-12);
  }
}

TEST(Engine, SteadyEngineRollsTheAirframeByTheAirsTorque) {
  // Where the speed is steady, the airframe feels the shaft's torque, whatever turns which way.
  for (const double sense : {1.0, -1.0})
    for (const double gear : {1.0, -1.0}) {
      auto e = with_propeller(EngineKind::piston, sense);
      e.piston.gear_sense = gear;
      const Vec3<double> v{30, 0, 0}, w{0, 0, 0};
      double omega = 200.0;
      for (int i = 0; i < 4000; ++i) omega += 0.005 * at(e, omega, 0.7, v, w).state_rate;
      const auto out = at(e, omega, 0.7, v, w);
      ASSERT_NEAR(out.state_rate, 0.0, 1e-9);
      const double rho = alula::standard_atmosphere(0.0).density;
      EXPECT_NEAR(out.moment.x, -sense * alula::piston_loads(e.piston, omega, 0.7, rho).torque,
                  1e-8);
    }
}

// A free airframe with an engine in it, no air on the propeller: attitude, rates, rotor speed, and
// the work of the shaft's torque. Gravity and forces are of no account.
using Free = std::array<double, 9>;
struct FreeBody {
  Engine engine;
  alula::MassProperties<double> body = alula::mass_properties(
      1.0, alula::Mat3<double>{{{8.0, 0.5, -1.0}, {0.5, 10.0, 0.3}, {-1.0, 0.3, 14.0}}});

  void rate(double t, const Free& x, Free& dx) const {
    const Vec3<double> w{x[4], x[5], x[6]}, v{0, 0, 0};
    const auto out = at(engine, x[7], 0.5 + 0.5 * std::sin(3.0 * t), v, w);
    const auto turn =
        alula::attitude_rate(alula::Quaternion<double>{x[0], x[1], x[2], x[3]}, w, 1.0);
    const auto dw = alula::angular_acceleration(body, out.moment, w);
    // Between airframe and rotor acts inertia times rotor acceleration, at their relative speed.
    const double torque = engine.propeller.inertia * out.state_rate;
    const double power = torque * (x[7] - engine.propeller.sense * alula::dot(engine.direction, w));
    dx = {turn.w, turn.x, turn.y, turn.z, dw.x, dw.y, dw.z, out.state_rate, power};
  }
  Vec3<double> momentum(const Free& x) const {  // in inertial axes
    const auto& p = engine.propeller;
    const bool geared = engine.kind == EngineKind::piston;
    const double crank =
        geared ? engine.piston.gear_sense * engine.piston.reduction * engine.piston.crank_inertia
               : 0;
    const double h = p.sense * (p.inertia + crank) * x[7];
    const Vec3<double> w{x[4], x[5], x[6]};
    const auto R = alula::earth_to_body(alula::Quaternion<double>{x[0], x[1], x[2], x[3]});
    return alula::transposed_times(R, body.inertia * w + h * engine.direction);
  }
  double energy(const Free& x) const {
    const Vec3<double> w{x[4], x[5], x[6]};
    return 0.5 * alula::dot(w, body.inertia * w) + 0.5 * engine.propeller.inertia * x[7] * x[7];
  }
  void run(Free& x) const {
    for (int i = 0; i < 10000; ++i)
      alula::rk4_step([this](double t, const Free& s, Free& dx) { rate(t, s, dx); }, 2e-4 * i, 2e-4,
                      x);
  }
};

const Vec3<double> kDirections[] = {
    {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0.36, 0.48, -0.8}};

TEST(Engine, InternalTorqueConservesAngularMomentum) {
  for (const EngineKind kind : {EngineKind::piston, EngineKind::electric})
    for (const auto& direction : kDirections)
      for (const double sense : {1.0, -1.0})
        for (const double gear : {1.0, -1.0}) {
          FreeBody free{with_propeller(kind, sense)};
          free.engine.direction = direction;
          free.engine.piston.gear_sense = gear;
          free.engine.propeller.CT = free.engine.propeller.CP = {};
          Free x{1, 0, 0, 0, 0.4, -0.3, 0.5, 60.0, 0};
          const auto before = free.momentum(x);
          const double speed = x[7], rates = x[4];
          free.run(x);
          const auto after = free.momentum(x);
          ASSERT_GT(std::abs(x[7] - speed), 1.0);  // there was something to conserve
          ASSERT_GT(std::abs(x[4] - rates), 0.01);
          // RK4 at 0.2 ms of nutations of up to 50 rad/s; a wrong sign makes 10
          EXPECT_NEAR(after.x, before.x, 1e-7);
          EXPECT_NEAR(after.y, before.y, 1e-7);
          EXPECT_NEAR(after.z, before.z, 1e-7);
        }
}

TEST(Engine, EnergyIsWhatTheShaftDid) {
  for (const auto& direction : kDirections)
    for (const double sense : {1.0, -1.0}) {
      FreeBody free{with_propeller(EngineKind::electric, sense)};
      free.engine.direction = direction;
      free.engine.propeller.CT = free.engine.propeller.CP = {};
      Free x{1, 0, 0, 0, 0.4, -0.3, 0.5, 60.0, 0};
      const double before = free.energy(x);
      free.run(x);
      ASSERT_GT(std::abs(x[8]), 100.0);
      EXPECT_NEAR(free.energy(x) - before, x[8], 1e-6 * std::abs(x[8]));  // RK4, as above
    }
}

TEST(Engine, TurbofanRotorConservesAngularMomentum) {
  for (const double momentum : {40.0, -40.0})
    for (const auto& direction : kDirections) {
      FreeBody free;
      free.engine.kind = EngineKind::turbofan;
      free.engine.direction = direction;
      free.engine.turbofan.angular_momentum = momentum;
      free.engine.turbofan.idle_speed = 0.4;
      Free x{1, 0, 0, 0, 0.4, -0.3, 0.5, 0.1, 0};
      const auto inertial = [&](const Free& s) {
        const auto R = alula::earth_to_body(alula::Quaternion<double>{s[0], s[1], s[2], s[3]});
        const double h = momentum * (0.4 + 0.6 * s[7]);
        return alula::transposed_times(
            R, free.body.inertia * Vec3<double>{s[4], s[5], s[6]} + h * direction);
      };
      const auto before = inertial(x);
      free.run(x);
      const auto after = inertial(x);
      ASSERT_GT(x[7], 0.3);
      EXPECT_NEAR(after.x, before.x, 1e-7);
      EXPECT_NEAR(after.y, before.y, 1e-7);
      EXPECT_NEAR(after.z, before.z, 1e-7);
    }
}

TEST(Engine, AStandingPropellerIsNotTurnedBackwards) {
  auto e = with_propeller(EngineKind::electric);
  e.electric.most_regenerated_current = 50.0;
  const Vec3<double> v{-30, 0, 0}, w{0, 0, 0};
  EXPECT_GE(at(e, 0.0, 0.0, v, w).state_rate, 0.0);
  EXPECT_GE(at(e, -0.1, 0.0, v, w).state_rate, 0.0);
}

TEST(Engine, SlopesMatchDifferences) {
  using D = alula::Dual<double, 8>;
  const double mach[] = {0.0, 1.0}, height[] = {0.0, 10000.0};
  const double idle[] = {500.0, 100.0, -200.0, 50.0}, full[] = {9000.0, 3000.0, 8000.0, 4000.0};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const EngineKind kind :
       {EngineKind::given, EngineKind::piston, EngineKind::electric, EngineKind::turbofan}) {
    auto e = with_propeller(kind, -1.0);
    e.point = {1.2, 0.4, -0.3};
    e.direction = {0.96, 0.0, -0.28};
    e.turbofan.idle = {idle, {mach, height, nullptr}, {2, 2, 1}, 2};
    e.turbofan.military = {full, {mach, height, nullptr}, {2, 2, 1}, 2};
    e.turbofan.angular_momentum = 30.0;
    e.turbofan.idle_speed = 0.5;
    for (int trial = 0; trial < 50; ++trial) {
      // state, throttle, u v w, p q r
      double x[8] = {kind == EngineKind::turbofan ? unit(random) : 100 + 200 * unit(random)};
      x[1] = 0.1 + 0.8 * unit(random);
      for (int i = 2; i < 5; ++i) x[i] = 40 * unit(random);
      for (int i = 5; i < 8; ++i) x[i] = unit(random) - 0.5;
      D d[8];
      for (int i = 0; i < 8; ++i) d[i] = D::variable(x[i], i);
      const auto out = at<D>(e, d[0], d[1], {d[2], d[3], d[4]}, {d[5], d[6], d[7]}, 800.0);
      for (int i = 0; i < 8; ++i) {
        const double h = 1e-5 * (1 + std::abs(x[i]));
        const auto moved = [&](double by) {
          double y[8];
          for (int j = 0; j < 8; ++j) y[j] = x[j] + (i == j ? by : 0.0);
          return at<double>(e, y[0], y[1], {y[2], y[3], y[4]}, {y[5], y[6], y[7]}, 800.0);
        };
        const auto up = moved(h), down = moved(-h);
        const auto near = [&](const D& slope, double above, double below) {
          const double difference = (above - below) / (2 * h);
          // h^2 of third derivatives, kinks of the second at the knots, rounding of 1e4 over h
          EXPECT_NEAR(slope.slope_of(i), difference, 2e-5 * (1 + std::abs(difference)))
              << static_cast<int>(kind) << " " << i;
        };
        near(out.force.x, up.force.x, down.force.x);
        near(out.moment.x, up.moment.x, down.moment.x);
        near(out.moment.y, up.moment.y, down.moment.y);
        near(out.moment.z, up.moment.z, down.moment.z);
        near(out.state_rate, up.state_rate, down.state_rate);
        near(out.current, up.current, down.current);
        near(out.fuel_flow, up.fuel_flow, down.fuel_flow);
      }
    }
  }
}

TEST(Engine, FloatFollowsDouble) {
  // The same engine in single precision, spooling up: 2 s of rounding of 6e-8 a step.
  alula::Engine<float> f;
  f.kind = EngineKind::electric;
  f.propeller.diameter = 1.7f;
  f.propeller.inertia = 0.6f;
  float J[6], CT[6], CP[6];
  for (int i = 0; i < 6; ++i) {
    J[i] = static_cast<float>(kJ[i]);
    CT[i] = static_cast<float>(kCT[i]);
    CP[i] = static_cast<float>(kCP[i]);
  }
  alula::make_curve(J, CT, 6, f.propeller.CT);
  alula::make_curve(J, CP, 6, f.propeller.CP);
  f.electric = {22.5f, 0.0444f, 1.2f, 0.1282f, 42.0f, 36.0f, 14400.0f, 90.0f, 0.0f};
  const auto e = with_propeller(EngineKind::electric);
  double omega = 0.0;
  float omega_f = 0.0f;
  const auto air = alula::standard_atmosphere(0.0f);
  for (int i = 0; i < 200; ++i) {
    omega += 0.01 * at<double>(e, omega, 1.0, {20, 0, 0}, {0, 0, 0}).state_rate;
    omega_f += 0.01f * alula::engine_loads<float, float>(f, omega_f, 1.0f, 0.0f, air, 0.0f, 0.0f,
                                                         {20, 0, 0}, {0, 0, 0}, 100.0f)
                           .state_rate;
  }
  ASSERT_GT(omega, 5.0);
  EXPECT_NEAR(omega_f, omega, 1e-4 * omega);
}

}  // namespace
