// The equations of motion as a whole: no allocation, float as good as float is, laws of physics.
#include <gtest/gtest.h>

#include <cmath>
#include <new>
#include <type_traits>

#include "allocations.hpp"
#include "alula/math/dual.hpp"
#include "alula/math/rk4.hpp"
#include "alula/motion/aircraft.hpp"
#include "alula/sensors/error_model.hpp"
#include "alula/sensors/lever_arm.hpp"

namespace {

template <class T>
alula::AircraftModel<T> light_aircraft() {
  alula::AircraftModel<T> a;
  a.body = alula::mass_properties(
      T(560),
      alula::Mat3<T>{{{T(655), T(0), T(-30)}, {T(0), T(723), T(0)}, {T(-30), T(0), T(1139)}}});
  a.S = T(10.6);
  a.b = T(8.65);
  a.c = T(1.25);
  a.reference_point = {T(0.1), T(0), T(0.05)};
  a.thrust_point = {T(1.6), T(0), T(-0.05)};
  a.wind = {T(4), T(-3), T(0)};
  a.stability_axes = true;
  struct Entry {
    int coefficient, slot;
    double value;
  };
  using namespace alula;
  const Entry entries[] = {{0, kOne, .051},          {0, kAlpha, .69},        {2, kOne, .488},
                           {2, kAlpha, 5.07},        {2, kDe, .473},          {4, kOne, -.1},
                           {4, kAlpha, -.43},        {4, kQhat, -25.},        {4, kDe, -2.08},
                           {1, kBeta, -.55},         {3, kPhat, -.47},        {3, kBeta, -.085},
                           {5, kBeta, .08},          {5, kRhat, -.11},        {0, kVariables, .5},
                           {1, kVariables + 1, .01}, {1, kVariables + 2, .02}};
  a.table.steps[0] = {0.0, Operation::multiply, kAlpha, kAlpha};
  a.table.steps[1] = {0.0, Operation::absolute, kBeta, 0};
  a.table.steps[2] = {0.05, Operation::ramp, kAlpha, 0};
  a.table.step_count = 3;
  for (const Entry& e : entries) {
    a.values[a.table.term_count] = T(e.value);
    a.table.terms[a.table.term_count++] = {static_cast<std::uint8_t>(e.coefficient),
                                           static_cast<std::uint8_t>(e.slot)};
  }
  return a;
}

template <class T>
alula::BodyState<T> level_flight() {
  return {T(0),  T(0), T(-900), T(0.999), T(0.02), T(0.03), T(0.01),
          T(45), T(1), T(1.5),  T(0.1),   T(0.05), T(-0.05)};
}

template <class T>
void fly(const alula::AircraftModel<T>& a, alula::BodyState<T>& x, int steps) {
  const alula::BodyInput<T> u{T(-0.05), T(0.01), T(0), T(0), T(0), T(600)};
  for (int i = 0; i < steps; ++i)
    alula::rk4_step([&](T t, const alula::BodyState<T>& at,
                        alula::BodyState<T>& rate) { rate = alula::derivative(t, at, u, a); },
                    T(0), T(0.01), x);
}

TEST(Aircraft, TableIsWellFormedAndSmall) {
  auto a = light_aircraft<double>();
  EXPECT_TRUE(alula::well_formed(a.table));
  EXPECT_LT(sizeof(a.table), 2048u);
  EXPECT_TRUE(std::is_trivially_copyable_v<alula::TermTable>);
  a.table.steps[0].b = alula::kVariables;  // itself
  EXPECT_FALSE(alula::well_formed(a.table));
}

TEST(Aircraft, FliesWithoutAllocating) {
  const auto a = light_aircraft<double>();
  auto x = level_flight<double>();
  const long control = alula_test::allocations();
  ::operator delete(::operator new(1));  // the counter counts
  ASSERT_GT(alula_test::allocations(), control);
  const long before = alula_test::allocations();
  fly(a, x, 1000);
  EXPECT_EQ(alula_test::allocations(), before);
  EXPECT_TRUE(std::isfinite(x[7]));
}

TEST(Aircraft, FloatFollowsDouble) {
  auto xd = level_flight<double>();
  auto xf = level_flight<float>();
  fly(light_aircraft<double>(), xd, 500);
  fly(light_aircraft<float>(), xf, 500);
  // 500 steps of rounding at 6e-8 of 1000 m and 45 m/s
  EXPECT_NEAR(xf[2], xd[2], 0.05);
  for (unsigned i = 3; i < 13; ++i) EXPECT_NEAR(xf[i], xd[i], 2e-3) << i;
}

TEST(Aircraft, StandsStillWithoutAirspeed) {
  auto a = light_aircraft<double>();
  a.wind = {};
  const alula::BodyState<double> x{0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const auto rate = alula::derivative(0.0, x, alula::BodyInput<double>{}, a);
  for (unsigned i = 0; i < 13; ++i)
    EXPECT_DOUBLE_EQ(rate[i], i == 9 ? alula::kStandardGravity : 0.0) << i;
}

TEST(Aircraft, MomentMovesWithTheReferencePoint) {
  // The same loads stated about a point further aft: Cm there is Cm - CZ dx/c for body axes.
  auto a = light_aircraft<double>();
  a.stability_axes = false;
  a.wind = {};
  const auto x = level_flight<double>();
  const auto R = alula::earth_to_body(alula::Quaternion<double>{x[3], x[4], x[5], x[6]});
  const alula::BodyInput<double> u{};
  a.reference_point = {};
  const auto at_cg = alula::loads(x, u, a, R);
  a.reference_point = {-0.2, 0, 0};
  const auto aft = alula::loads(x, u, a, R);
  EXPECT_DOUBLE_EQ(aft.force.z, at_cg.force.z);
  EXPECT_NEAR(aft.moment.y, at_cg.moment.y + 0.2 * at_cg.force.z, 1e-9);  // of about 1000 N m
}

TEST(Aircraft, DualSlopesMatchDifferences) {
  using D = alula::Dual<double, 8>;
  const auto a = light_aircraft<double>();
  const auto x = level_flight<double>();
  alula::BodyInput<double> u{-0.05, 0.01, 0, 0, 0, 600};
  alula::BodyInput<D> ud;
  for (unsigned j = 0; j < 6; ++j) ud[j] = D(u[j]);
  for (unsigned first = 0; first < 13; first += 8) {
    alula::BodyState<D> xd;
    for (unsigned i = 0; i < 13; ++i) {
      xd[i] = D(x[i]);
      if (i >= first && i < first + 8) xd[i] = D::variable(x[i], static_cast<int>(i - first));
    }
    const auto rate = alula::derivative(0.0, xd, ud, a);
    for (unsigned j = first; j < 13 && j < first + 8; ++j) {
      const double h = 1e-5 * (1.0 + std::abs(x[j]));
      auto up = x, down = x;
      up[j] += h;
      down[j] -= h;
      const auto fu = alula::derivative(0.0, up, u, a), fd = alula::derivative(0.0, down, u, a);
      for (unsigned i = 0; i < 13; ++i)  // central differences: h^2 and rounding / h
        EXPECT_NEAR(rate[i].slope_of(static_cast<int>(j - first)), (fu[i] - fd[i]) / (2 * h), 2e-6)
            << i << " " << j;
    }
  }
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
