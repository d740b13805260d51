// Blade elements: momentum balance of a ring, the ideal limit, tip loss, bad states.
#include <gtest/gtest.h>

#include <cmath>

#include "allocations.hpp"
#include "alula/propulsion/blade_element.hpp"
#include "propeller_case.hpp"

namespace {

using namespace alula_test;
constexpr double kPi = 3.14159265358979324;

alula::SectionPolar<double> polar() {
  alula::SectionPolar<double> p;
  p.c_l_0 = 0.3;
  p.c_l_alpha = 5.7;
  p.c_l_min = -0.5;
  p.c_l_max = 1.2;
  p.c_d_0 = 0.012;
  p.c_d_2_upper = p.c_d_2_lower = 0.01;
  p.c_l_cd0 = 0.3;
  return p;
}

alula::BladeElementCase<double> flight(double V) {
  alula::BladeElementCase<double> c;
  c.axial_speed = V;
  c.omega = 600.0;
  c.density = 1.2;
  c.viscosity = 1.8e-5;
  return c;
}

TEST(BladeElement, RingsKeepMomentum) {
  const auto b = test_blades<double>();
  const auto p = polar();
  for (const bool tip : {false, true})
    for (const double V : {0.0, 3.0, 15.0, 30.0})
      for (const double x : {0.2, 0.5, 0.8, 0.99}) {
        auto c = flight(V);
        c.tip_loss = tip;
        const double r = x * b.radius;
        const auto e = alula::blade_element(b, &p, 1, c, r);
        ASSERT_TRUE(e.solved) << V << " " << x;
        const double u = e.speed * std::sin(e.inflow);  // through the ring
        const double turned = c.omega * r - e.speed * std::cos(e.inflow);
        const double f = 0.5 * b.count * (1 - x) / (x * std::sin(e.inflow));
        const double F = tip ? 2 / kPi * std::acos(std::exp(-f)) : 1.0;
        EXPECT_NEAR(e.thrust, 4 * kPi * r * 1.2 * F * u * (u - V), 1e-8 * (1 + e.thrust));
        EXPECT_NEAR(e.torque, 4 * kPi * r * r * 1.2 * F * u * turned, 1e-8);
      }
}

TEST(BladeElement, WithoutDragPowerIsThrustTimesTheInflow) {
  // No drag: the force is normal to the air that the blade meets, so each ring has
  // dQ (w - swirl) = dT u1: Froude's disk but for the swirl, which costs dQ swirl.
  const auto b = test_blades<double>();
  auto p = polar();
  p.c_d_0 = p.c_d_2_upper = p.c_d_2_lower = p.c_d_stalled = 0.0;
  auto c = flight(12.0);
  const double r = 0.7 * b.radius;
  const auto e = alula::blade_element(b, &p, 1, c, r);
  ASSERT_TRUE(e.solved);
  EXPECT_NEAR(e.torque / r * std::cos(e.inflow), e.thrust * std::sin(e.inflow), 1e-9);
  c.swirl = false;
  const auto d = alula::blade_element(b, &p, 1, c, r);
  EXPECT_NEAR(d.torque * c.omega, d.thrust * d.speed * std::sin(d.inflow), 1e-7);
}

TEST(BladeElement, TipLossTakesTheTipsLoadAndBladesWithoutEndDoNot) {
  auto b = test_blades<double>();
  const auto p = polar();
  const auto c = flight(10.0);
  EXPECT_NEAR(alula::blade_element(b, &p, 1, c, b.radius).thrust, 0.0, 1e-9);
  const double with = alula::blade_loads(b, &p, 1, c).thrust;
  auto without = c;
  without.tip_loss = false;
  const double all = alula::blade_loads(b, &p, 1, without).thrust;
  EXPECT_LT(with, all);
  // Many narrow blades of the same solidity lose next to nothing.
  b.count = 200;
  for (double& chord : b.chord) chord /= 100.0;
  EXPECT_NEAR(alula::blade_loads(b, &p, 1, c).thrust, all, 0.01 * all);
}

TEST(BladeElement, QuadratureHasConverged) {
  // The same blades by four times as many stations: pieces are shorter, the answer stays.
  const auto b = test_blades<double>();
  const auto p = polar();
  auto fine = b;
  fine.stations = 0;
  for (int i = 0; i + 1 < b.stations; ++i)
    for (int k = 0; k < 10; ++k) {
      const unsigned to = static_cast<unsigned>(fine.stations++), at = static_cast<unsigned>(i);
      fine.r[to] = b.r[at] + (b.r[at + 1] - b.r[at]) * k / 10.0;
      fine.chord[to] = b.chord[at] + (b.chord[at + 1] - b.chord[at]) * k / 10.0;
    }
  const unsigned tip = static_cast<unsigned>(fine.stations++);
  fine.r[tip] = 1.0;
  fine.chord[tip] = b.chord[static_cast<unsigned>(b.stations - 1)];
  for (const double V : {0.0, 20.0}) {
    const auto one = alula::blade_loads(b, &p, 1, flight(V));
    const auto two = alula::blade_loads(fine, &p, 1, flight(V));
    // drag jumps where the lift is held, and Gauss's rule does not know where that is
    EXPECT_NEAR(one.thrust, two.thrust, 1e-3 * one.thrust);
    EXPECT_NEAR(one.torque, two.torque, 1e-3 * one.torque);
  }
}

TEST(BladeElement, SaysWhereItEnds) {
  const auto b = test_blades<double>();
  const auto p = polar();
  EXPECT_EQ(alula::blade_loads(b, &p, 1, flight(-1.0)).regime, alula::PropellerRegime::reverse);
  EXPECT_EQ(alula::blade_loads(b, &p, 1, flight(60.0)).regime, alula::PropellerRegime::windmill);
  auto standing = flight(10.0);
  standing.omega = 0.0;
  EXPECT_EQ(alula::blade_loads(b, &p, 1, standing).regime, alula::PropellerRegime::standing);
  EXPECT_EQ(alula::blade_loads(b, &p, 1, flight(0.0)).regime, alula::PropellerRegime::inside);
}

TEST(SectionPolar, IsQpropsParabolaWithItsLimits) {
  auto p = polar();
  p.reynolds = 1e5;
  p.reynolds_power = -0.5;
  p.mach_corrected = true;
  const auto s = alula::section_loads(p, 0.05, 4e5, 0.6);
  EXPECT_DOUBLE_EQ(s.c_l, (0.3 + 5.7 * 0.05) / 0.8);
  EXPECT_DOUBLE_EQ(s.c_d, 0.5 * (0.012 + 0.01 * (s.c_l - 0.3) * (s.c_l - 0.3)));
  const auto held = alula::section_loads(p, 0.5, 1e5, 0.0);
  EXPECT_DOUBLE_EQ(held.c_l, 1.2);
  EXPECT_DOUBLE_EQ(held.c_d, 0.012 + 0.01 * 0.81 + 2 * std::pow(std::sin(0.5), 2));
}

TEST(SectionPolar, TablesAreLinesHeldOutside) {
  const double alpha[] = {-0.1, 0.0, 0.2}, c_l[] = {-0.5, 0.1, 1.1}, c_d[] = {0.03, 0.01, 0.05};
  alula::SectionPolar<double> p;
  p.alpha = alpha;
  p.c_l = c_l;
  p.c_d = c_d;
  p.points = 3;
  EXPECT_DOUBLE_EQ(alula::section_loads(p, 0.1, 0.0, 0.0).c_l, 0.6);
  EXPECT_DOUBLE_EQ(alula::section_loads(p, 0.1, 0.0, 0.0).c_d, 0.03);
  EXPECT_DOUBLE_EQ(alula::section_loads(p, 3.0, 0.0, 0.0).c_l, 1.1);
  EXPECT_DOUBLE_EQ(alula::section_loads(p, -3.0, 0.0, 0.0).c_l, -0.5);
}

TEST(BladeElement, AllocatesNothing) {
  const auto b = test_blades<double>();
  const auto p = polar();
  const long before = alula_test::allocations();
  const auto l = alula::blade_loads(b, &p, 1, flight(10.0));
  EXPECT_EQ(alula_test::allocations(), before);
  EXPECT_GT(l.thrust, 0.0);
}

}  // namespace
