// Laws of turns over regimes: none, tiny, small, large, and half a revolution.
#include <gtest/gtest.h>

#include <random>

#include "alula/navigate/attitude.hpp"
#include "navigate_case.hpp"

namespace {

using alula::Quaternion;
using alula::Vec3;
using navigate_case::kG;
using navigate_case::kPi;

template <class T>
class Rotation : public ::testing::Test {
 protected:
  std::mt19937 random{7};
  std::normal_distribution<double> normal;

  Vec3<T> direction() {
    const Vec3<double> v{normal(random), normal(random), normal(random)};
    const double k = 1.0 / std::sqrt(dot(v, v));
    return {T(k * v.x), T(k * v.y), T(k * v.z)};
  }
  // a few roundings of the largest number in play
  static constexpr double kTolerance = sizeof(T) == 8 ? 1e-13 : 2e-5;
};
using Scalars = ::testing::Types<double, float>;
TYPED_TEST_SUITE(Rotation, Scalars);

TYPED_TEST(Rotation, TurnComesBackFromItsQuaternion) {
  using T = TypeParam;
  for (const double size : {0.0, 1e-8, 1e-3, 0.03, 0.0317, 1.0, 3.0, kPi - 1e-3})
    for (int i = 0; i < 50; ++i) {
      const Vec3<T> a = T(size) * this->direction();
      const Vec3<T> d = alula::turn_of_quaternion(alula::quaternion_of_turn(a)) - a;
      EXPECT_LT(std::sqrt(double(dot(d, d))), this->kTolerance * (1.0 + size)) << size;
    }
}

TYPED_TEST(Rotation, BothQuaternionsOfAnAttitudeAreOneTurn) {
  using T = TypeParam;
  for (int i = 0; i < 50; ++i) {
    const Vec3<T> a = T(2.5) * this->direction();
    const Quaternion<T> q = alula::quaternion_of_turn(a);
    const Vec3<T> d = alula::turn_of_quaternion(Quaternion<T>{-q.w, -q.x, -q.y, -q.z}) - a;
    EXPECT_LT(std::sqrt(double(dot(d, d))), this->kTolerance);
    EXPECT_GE(alula::normalized(Quaternion<T>{-q.w, -q.x, -q.y, -q.z}).w, T(0));
  }
}

TYPED_TEST(Rotation, HalfARevolutionIsItsOwnOpposite) {
  using T = TypeParam;
  for (int i = 0; i < 50; ++i) {
    const Vec3<T> a = T(kPi) * this->direction();
    const Quaternion<T> q = alula::quaternion_of_turn(a);
    const Vec3<T> back = alula::turn_of_quaternion(q);
    // length pi; about the axis or its opposite, which is the same attitude
    EXPECT_NEAR(std::sqrt(double(dot(back, back))), kPi, this->kTolerance);
    EXPECT_LT(navigate_case::angle_between(alula::quaternion_of_turn(back), q),
              4.0 * this->kTolerance);
  }
}

TYPED_TEST(Rotation, TwoHalvesMakeAWholeAndOppositesCancel) {
  using T = TypeParam;
  for (const double size : {0.0, 1e-8, 1e-3, 1.0, kPi})
    for (int i = 0; i < 20; ++i) {
      const Vec3<T> a = T(size) * this->direction();
      const auto whole = alula::quaternion_of_turn(a), half = alula::quaternion_of_turn(T(0.5) * a);
      EXPECT_LT(navigate_case::angle_between(half * half, whole), this->kTolerance * 4.0);
      const auto none = alula::turn_of_quaternion(conjugate(whole) * whole);
      EXPECT_LT(std::sqrt(double(dot(none, none))), this->kTolerance);
    }
}

TYPED_TEST(Rotation, MatrixGivesTheQuaternionBack) {
  using T = TypeParam;
  for (const double size : {0.0, 1e-8, 1.0, 2.0, 3.0, kPi})
    for (int i = 0; i < 50; ++i) {
      const auto q = alula::quaternion_of_turn(T(size) * this->direction());
      const auto back = alula::quaternion_from_rotation(alula::earth_to_body(q));
      EXPECT_LT(navigate_case::angle_between(back, q), this->kTolerance * 8.0) << size;
    }
}

TYPED_TEST(Rotation, AngleWraps) {
  using T = TypeParam;
  EXPECT_NEAR(double(alula::wrapped(T(3.5))), 3.5 - 2 * kPi, 1e-6);
  EXPECT_NEAR(double(alula::wrapped(T(-3.5))), 2 * kPi - 3.5, 1e-6);
  EXPECT_NEAR(double(alula::wrapped(T(0.25))), 0.25, 1e-7);
}

TYPED_TEST(Rotation, AttitudeFromGravityAndField) {
  using T = TypeParam;
  const Vec3<T> B = navigate_case::kField<T>;
  for (const double phi : {-3.0, -1.0, 0.0, 0.4, 2.0})
    for (const double theta : {-1.5, -0.3, 0.0, 1.2})
      for (const double psi : {-3.1, -1.0, 0.0, 2.2}) {
        const auto q = alula::quaternion_from_euler(T(phi), T(theta), T(psi));
        const auto R = alula::earth_to_body(q);
        const auto z = alula::measured_attitude(R * Vec3<T>{T(0), T(0), T(kG)}, R * B, B, T(kG));
        ASSERT_TRUE(z.valid && z.heading);
        EXPECT_NEAR(double(z.gain), 1.0, 1e-4);
        const auto found = alula::quaternion_from_euler(z.euler.x, z.euler.y, z.euler.z);
        // near the vertical bank and heading are nearly one: a few more digits go
        EXPECT_LT(navigate_case::angle_between(found, q), 400.0 * this->kTolerance);
      }
}

TYPED_TEST(Rotation, GimbalAttitudeIsStillAnAttitude) {
  using T = TypeParam;
  const Vec3<T> B = navigate_case::kField<T>;
  const auto q = alula::quaternion_from_euler(T(0.3), T(kPi / 2), T(0.7));
  const auto R = alula::earth_to_body(q);
  const auto both = alula::attitude_from_vectors(R * Vec3<T>{T(0), T(0), T(kG)}, R * B, B);
  ASSERT_TRUE(both.valid);
  EXPECT_LT(navigate_case::angle_between(alula::quaternion_from_rotation(both.R_BE), q),
            40.0 * this->kTolerance);
  const auto z = alula::measured_attitude(R * Vec3<T>{T(0), T(0), T(kG)}, R * B, B, T(kG));
  EXPECT_TRUE(alula::finite(z.euler));
}

TYPED_TEST(Rotation, WhatSaysNothingIsSaid) {
  using T = TypeParam;
  const Vec3<T> B = navigate_case::kField<T>, g{T(0), T(0), T(kG)};
  EXPECT_FALSE(alula::attitude_from_vectors(Vec3<T>{}, B, B).valid);  // free fall
  EXPECT_FALSE(alula::attitude_from_vectors(T(2) * B, B, B).valid);   // parallel
  EXPECT_FALSE(alula::measured_attitude(Vec3<T>{}, B, B, T(kG)).valid);
  EXPECT_FALSE(alula::measured_attitude(g, T(1.3) * B, B, T(kG)).heading);  // too strong
  EXPECT_FALSE(alula::measured_attitude(g, Vec3<T>{B.z, B.y, B.x}, B, T(kG)).heading);  // dip
  EXPECT_TRUE(alula::measured_attitude(g, T(1.3) * B, B, T(kG)).valid);  // gravity alone
  EXPECT_EQ(double(alula::acceleration_gain(T(1.2) * g, T(kG))), 0.0);
  EXPECT_NEAR(double(alula::acceleration_gain(T(1.05) * g, T(kG))), 0.5, 1e-5);
}

TYPED_TEST(Rotation, CentripetalPartIsTakenOff) {
  using T = TypeParam;
  const auto now = navigate_case::turn<T>(3.0, 30.0, 0.3);
  const auto R = alula::earth_to_body(now.q);
  const Vec3<T> seen = alula::gravity_seen(now.force, now.rate, R * now.velocity);
  const Vec3<T> d = seen - R * Vec3<T>{T(0), T(0), T(kG)};
  EXPECT_LT(std::sqrt(double(dot(d, d))), 50.0 * this->kTolerance);
}

}  // namespace
