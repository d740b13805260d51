// Navigation filters on exact motions, on bad input, in both scalars, without allocations.
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "allocations.hpp"
#include "alula/navigate/power_train.hpp"
#include "alula/navigate/wind.hpp"
#include "navigate_case.hpp"

namespace {

using namespace alula;
using navigate_case::angle_between;
using navigate_case::kField;
using navigate_case::kG;
using navigate_case::turn;

template <class T>
class Navigate : public ::testing::Test {
 protected:
  static constexpr T kNaN = std::numeric_limits<T>::quiet_NaN();
  static constexpr double kStep = 1.0 / 400.0;
  static JointNoise<T> noise() {
    JointNoise<T> n;
    n.field = kField<T>;
    n.gravity = T(kG);
    return n;
  }

  // Starts on the motion, off by `off` rad in attitude about body x, y, z.
  static void begin(JointFilter<T>& f, double V, double w, T off = T(0)) {
    const auto at = turn<T>(0.0, V, w);
    JointStart<T> sigma;
    sigma.tilt = T(0.2);
    sigma.heading = T(0.5);
    start(f, noise(), 0.0, at.q * quaternion_of_turn(Vec3<T>{off, off, T(-2) * off}), at.velocity,
          at.position, sigma);
  }

  // Flies on from step `from` to `to`, all sensors exact; false in `with` leaves them out.
  static void fly(JointFilter<T>& f, double V, double w, int from, int to, bool with = true) {
    const JointNoise<T> n = noise();
    for (int i = from + 1; i <= to; ++i) {
      const double t = i * kStep;
      const auto at = turn<T>(t, V, w);
      predict(f, n, t, at.rate, at.force);
      if (!with) continue;
      const auto R = earth_to_body(at.q);
      if (i % 8 == 0) {
        update_field(f, n, R * n.field, T(0.5));
        update_airspeed(f, n, T(V), T(0.3));
        update_alpha(f, n, T(0), T(0.01));
        update_beta(f, n, T(0), T(0.01));
        update_height(f, n, T(100), T(0.5));
      }
      if (i % 80 == 0) {  // 0.2 s late
        const auto then = turn<T>(t - 0.2, V, w);
        update_position(f, n, t - 0.2, then.position, {T(1.5), T(1.5), T(1.5)});
        update_velocity(f, n, t - 0.2, then.velocity, {T(0.1), T(0.1), T(0.1)});
      }
    }
  }
};
using Scalars = ::testing::Types<double, float>;
TYPED_TEST_SUITE(Navigate, Scalars);

TYPED_TEST(Navigate, FreeFallFallsFree) {
  using T = TypeParam;
  JointFilter<T> f;
  const JointNoise<T> n = TestFixture::noise();
  start(f, n, 0.0, {T(1), T(0), T(0), T(0)}, {T(10), T(0), T(0)}, {}, JointStart<T>{});
  for (int i = 1; i <= 800; ++i) predict(f, n, i * this->kStep, {}, {});
  // trapezoid is exact here; what is left is rounding over 800 sums
  EXPECT_NEAR(double(f.velocity.z), 2.0 * kG, sizeof(T) == 8 ? 1e-10 : 2e-3);
  EXPECT_NEAR(double(f.position.z), 0.5 * kG * 4.0, sizeof(T) == 8 ? 1e-9 : 5e-3);
  EXPECT_NEAR(double(f.position.x), 20.0, sizeof(T) == 8 ? 1e-9 : 2e-3);
}

TYPED_TEST(Navigate, SpinComesRound) {
  using T = TypeParam;
  AttitudeFilter<T> f;
  const AttitudeNoise<T> n;
  const Quaternion<T> q = quaternion_from_euler(T(0.3), T(-0.2), T(1));
  start(f, 0.0, q, T(0.1), T(0.1), T(0.01));
  const T w = T(2 * navigate_case::kPi);  // one revolution a second about a slanted axis
  for (int i = 1; i <= 800; ++i) predict(f, n, i / 800.0, {T(0.6) * w, T(0), T(0.8) * w});
  // the first step has half its rate: the filter starts at rest
  EXPECT_NEAR(angle_between(f.q, q), 0.5 * double(w) / 800.0, sizeof(T) == 8 ? 1e-10 : 1e-4);
}

TYPED_TEST(Navigate, JointFilterFindsATurnFromAWrongStart) {
  using T = TypeParam;
  auto f = std::make_unique<JointFilter<T>>();
  this->begin(*f, 30.0, 0.2, T(0.05));
  this->fly(*f, 30.0, 0.2, 0, 400 * 30);
  const auto at = turn<T>(30.0, 30.0, 0.2);
  // exact readings: half a milliradian and 5 cm are left of biases that are still being found
  EXPECT_LT(angle_between(f->q, at.q), 2e-3);
  const Vec3<T> d = f->position - at.position;
  EXPECT_LT(std::sqrt(double(dot(d, d))), 0.1);
  EXPECT_LT(std::sqrt(double(dot(f->wind, f->wind))), 0.1);
  EXPECT_EQ(f->tally.of[int(Taken::kGated)], 0u);
}

TYPED_TEST(Navigate, JointFilterFindsAnUnknownHeading) {
  using T = TypeParam;
  for (const double off : {0.5, 2.0, 3.1, -2.5}) {
    auto f = std::make_unique<JointFilter<T>>();
    const auto at = turn<T>(0.0, 30.0, 0.0);
    JointStart<T> sigma;
    sigma.heading = T(1.8);
    start(*f, TestFixture::noise(), 0.0, quaternion_from_euler(T(0), T(0), T(off)), at.velocity,
          at.position, sigma);
    this->fly(*f, 30.0, 0.0, 0, 400 * 10);
    EXPECT_LT(angle_between(f->q, turn<T>(10.0, 30.0, 0.0).q), 0.01) << off;
    // and banked in a turn
    start(*f, TestFixture::noise(), 0.0,
          quaternion_from_euler(T(std::atan(0.2 * 30.0 / kG)), T(0), T(off)), at.velocity,
          turn<T>(0.0, 30.0, 0.2).position, sigma);
    this->fly(*f, 30.0, 0.2, 0, 400 * 20);
    EXPECT_LT(angle_between(f->q, turn<T>(20.0, 30.0, 0.2).q), 0.01) << off;
  }
}

TYPED_TEST(Navigate, PairFindsATurnAndAnUnknownHeading) {
  using T = TypeParam;
  for (const double off : {0.1, 2.0, 3.1}) {
    auto f = std::make_unique<Pair<T>>();
    PairNoise<T> n;
    n.field = kField<T>;
    const auto first = turn<T>(0.0, 30.0, 0.2);
    start(f->attitude, 0.0, first.q * quaternion_of_turn(Vec3<T>{T(0), T(0), T(off)}), T(0.2),
          T(1.8), T(0.01));
    start(f->position, 0.0, first.position, first.velocity, T(1), T(1), T(0.1));
    for (int i = 1; i <= 800 * 30; ++i) {
      const double t = i / 800.0;
      const auto at = turn<T>(t, 30.0, 0.2);
      predict(*f, n, t, at.rate, at.force);
      if (i % 16 == 0) {
        update_airspeed(*f, T(30));
        update_field(*f, n, earth_to_body(at.q) * n.field);
      }
      if (i % 160 == 0) {
        const auto then = turn<T>(t - 0.2, 30.0, 0.2);
        update_position(f->position, n.position, t - 0.2, then.position, {T(1), T(1), T(1)});
        update_velocity(f->position, n.position, t - 0.2, then.velocity, {T(0.1), T(0.1), T(0.1)});
      }
    }
    const auto at = turn<T>(30.0, 30.0, 0.2);
    // readings that weigh as much as 1 rad each: 3 deg are left of a heading that was unknown
    EXPECT_LT(angle_between(f->attitude.q, at.q), 0.05) << off;
    const Vec3<T> d = f->position.position - at.position;
    EXPECT_LT(std::sqrt(double(dot(d, d))), 1.0);
  }
}

TYPED_TEST(Navigate, NothingThatIsNotANumberTouchesTheState) {
  using T = TypeParam;
  JointFilter<T> f;
  const JointNoise<T> n = TestFixture::noise();
  this->begin(f, 30.0, 0.2);
  this->fly(f, 30.0, 0.2, 0, 800);
  const T bad = this->kNaN, inf = std::numeric_limits<T>::infinity();
  const Vec3<T> good{T(1), T(1), T(1)};
  const JointFilter<T> before = f;
  unsigned refused = 0;
  for (const T x : {bad, inf, -inf})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3<T> v{T(0), T(0), T(-9.8)};
      (axis == 0 ? v.x : axis == 1 ? v.y : v.z) = x;
      EXPECT_EQ(predict(f, n, f.t + 0.01, v, good), Taken::kNotFinite);
      EXPECT_EQ(predict(f, n, f.t + 0.01, good, v), Taken::kNotFinite);
      EXPECT_EQ(update_position(f, n, f.t, v, good).taken, Taken::kNotFinite);
      EXPECT_EQ(update_position(f, n, f.t, good, v).taken, Taken::kNotFinite);
      EXPECT_EQ(update_velocity(f, n, f.t, v, good).taken, Taken::kNotFinite);
      EXPECT_EQ(update_field(f, n, v, T(1)).taken, Taken::kNotFinite);
      EXPECT_EQ(update_height(f, n, x, T(1)).taken, Taken::kNotFinite);
      EXPECT_EQ(update_airspeed(f, n, x, T(1)).taken, Taken::kNotFinite);
      EXPECT_EQ(update_alpha(f, n, x, T(1)).taken, Taken::kNotFinite);
      EXPECT_EQ(update_beta(f, n, T(0), x).taken, Taken::kNotFinite);
      refused += 10;
    }
  EXPECT_EQ(predict(f, n, std::nan(""), good, good), Taken::kNotFinite);
  EXPECT_EQ(update_position(f, n, std::nan(""), good, good).taken, Taken::kNotFinite);
  EXPECT_EQ(f.tally.of[int(Taken::kNotFinite)], refused + 2);
  f.tally = before.tally;
  EXPECT_EQ(f.q.w, before.q.w);
  EXPECT_EQ(f.q.x, before.q.x);
  EXPECT_EQ(f.t, before.t);
  for (int i = 0; i < kJointStates; ++i)
    for (int j = 0; j < kJointStates; ++j) EXPECT_EQ(f.P.P[i][j], before.P.P[i][j]);
  EXPECT_EQ(f.position.x, before.position.x);

  Pair<T> pair;
  PairNoise<T> m;
  m.field = kField<T>;
  start(pair.attitude, 0.0, {T(1), T(0), T(0), T(0)}, T(1), T(1), T(0.1));
  start(pair.position, 0.0, {}, {T(20), T(0), T(0)}, T(1), T(1), T(0.1));
  EXPECT_EQ(predict(pair, m, 0.01, {bad, T(0), T(0)}, good), Taken::kNotFinite);
  EXPECT_EQ(predict(pair, m, 0.01, good, {bad, T(0), T(0)}), Taken::kNotFinite);
  EXPECT_EQ(update_field(pair, m, Vec3<T>{T(0), bad, T(0)}).taken, Taken::kNotFinite);
  EXPECT_EQ(update_airspeed(pair, bad), Taken::kNotFinite);
  EXPECT_EQ(update_height(pair.position, m.position, 0.0, bad, T(1)).taken, Taken::kNotFinite);
  EXPECT_EQ(pair.attitude.t, 0.0);
}

TYPED_TEST(Navigate, TimeGoingBackwardsIsRefused) {
  using T = TypeParam;
  JointFilter<T> f;
  const JointNoise<T> n = TestFixture::noise();
  this->begin(f, 30.0, 0.0);
  this->fly(f, 30.0, 0.0, 0, 400);
  const T before = f.position.x;
  const auto at = turn<T>(0.5, 30.0, 0.0);
  EXPECT_EQ(predict(f, n, 0.5, at.rate, at.force), Taken::kBackwards);
  EXPECT_EQ(predict(f, n, f.t, at.rate, at.force), Taken::kBackwards);  // the same stamp again
  EXPECT_EQ(update_position(f, n, f.t + 1.0, at.position, {T(1), T(1), T(1)}).taken,
            Taken::kBackwards);
  EXPECT_EQ(f.position.x, before);
  EXPECT_EQ(f.tally.of[int(Taken::kBackwards)], 3u);
  this->fly(f, 30.0, 0.0, 400, 800);  // on it goes
  EXPECT_NEAR(double(f.position.x), 60.0, 0.2);
}

TYPED_TEST(Navigate, OldMeasurementsAreForgottenAndLateOnesTaken) {
  using T = TypeParam;
  JointFilter<T> f;
  const JointNoise<T> n = TestFixture::noise();
  this->begin(f, 30.0, 0.0);
  this->fly(f, 30.0, 0.0, 0, 1200);
  const Vec3<T> sigma{T(1), T(1), T(1)};
  EXPECT_EQ(update_position(f, n, 0.5, turn<T>(0.5, 30.0, 0.0).position, sigma).taken,
            Taken::kTooOld);
  for (const double late : {0.0, 0.1, 0.5, 1.0}) {
    const auto judged =
        update_position(f, n, f.t - late, turn<T>(f.t - late, 30.0, 0.0).position, sigma);
    EXPECT_EQ(judged.taken, Taken::kYes) << late;
    EXPECT_LT(double(judged.nis), 0.1) << late;  // exact readings: no surprise whenever they come
  }
}

TYPED_TEST(Navigate, JumpOfAKilometerIsRefusedAndALastingOneBelieved) {
  using T = TypeParam;
  JointFilter<T> f;
  const JointNoise<T> n = TestFixture::noise();
  this->begin(f, 30.0, 0.0);
  this->fly(f, 30.0, 0.0, 0, 4000);
  const Vec3<T> sigma{T(1.5), T(1.5), T(1.5)}, jump{T(1000), T(0), T(0)};
  int step = 4000;
  const auto satellite = [&](double seconds, const Vec3<T>& off) {
    const int end = step + int(400 * seconds);
    for (; step < end; step += 80) {
      this->fly(f, 30.0, 0.0, step, step + 80, false);
      update_position(f, n, f.t, turn<T>(f.t, 30.0, 0.0).position + off, sigma);
    }
  };
  satellite(3.0, jump);  // 3 s of it: an outlier
  EXPECT_EQ(f.tally.of[int(Taken::kGated)], 15u);
  EXPECT_NEAR(double(f.position.x), 30.0 * f.t, 1.0);
  satellite(2.0, {});
  EXPECT_NEAR(double(f.position.x), 30.0 * f.t, 1.0);
  satellite(10.0, jump);  // longer than the filter's patience: it is where it is
  EXPECT_NEAR(double(f.position.x), 1000.0 + 30.0 * f.t, 5.0);
}

TYPED_TEST(Navigate, TenSecondsWithoutAnythingAndBack) {
  using T = TypeParam;
  JointFilter<T> f;
  this->begin(f, 30.0, 0.2);
  this->fly(f, 30.0, 0.2, 0, 400 * 20);
  const T known = f.P.P[kPosition][kPosition];
  this->fly(f, 30.0, 0.2, 400 * 20, 400 * 30, false);  // inertial samples alone
  const T lost = f.P.P[kPosition][kPosition];
  EXPECT_GT(double(lost), 4.0 * double(known));
  this->fly(f, 30.0, 0.2, 400 * 30, 400 * 40);
  EXPECT_LT(double(f.P.P[kPosition][kPosition]), 1.2 * double(known));
  // and a hole in the inertial samples themselves: nothing is known of it but that it was
  this->fly(f, 30.0, 0.2, 400 * 50, 400 * 50 + 1, false);
  EXPECT_EQ(f.tally.of[int(Taken::kGap)], 1u);
  EXPECT_GT(double(f.P.P[kPosition][kPosition]), 1e4);
  this->fly(f, 30.0, 0.2, 400 * 50 + 1, 400 * 80);
  const auto at = turn<T>(80.0, 30.0, 0.2);
  EXPECT_LT(angle_between(f.q, at.q), 0.01);
  const Vec3<T> d = f.position - at.position;
  EXPECT_LT(std::sqrt(double(dot(d, d))), 1.0);
}

TYPED_TEST(Navigate, DisturbedFieldIsRefused) {
  using T = TypeParam;
  JointFilter<T> f;
  const JointNoise<T> n = TestFixture::noise();
  this->begin(f, 30.0, 0.2);
  this->fly(f, 30.0, 0.2, 0, 400 * 20);
  for (int i = 400 * 20; i < 400 * 30; i += 8) {
    this->fly(f, 30.0, 0.2, i, i + 8, false);
    const auto R = earth_to_body(turn<T>((i + 8) * this->kStep, 30.0, 0.2).q);
    update_field(f, n, R * n.field + Vec3<T>{T(0), T(20), T(0)}, T(0.5));
  }
  EXPECT_EQ(f.tally.of[int(Taken::kGated)], 500u);
  EXPECT_LT(angle_between(f.q, turn<T>(30.0, 30.0, 0.2).q), 0.01);
}

TYPED_TEST(Navigate, NoAirspeedSaysNothing) {
  using T = TypeParam;
  JointFilter<T> f;
  const JointNoise<T> n = TestFixture::noise();
  EXPECT_EQ(update_airspeed(f, n, T(20), T(1)).taken, Taken::kUnusable);  // not started
  EXPECT_EQ(predict(f, n, 0.0, {}, {}), Taken::kUnusable);
  start(f, n, 0.0, {T(1), T(0), T(0), T(0)}, {}, {}, JointStart<T>{});
  EXPECT_EQ(update_airspeed(f, n, T(20), T(1)).taken, Taken::kUnusable);  // stands still
  EXPECT_EQ(update_alpha(f, n, T(0.1), T(0.01)).taken, Taken::kUnusable);
  EXPECT_EQ(update_beta(f, n, T(0.1), T(0.01)).taken, Taken::kUnusable);
  this->begin(f, 30.0, 0.0);
  EXPECT_EQ(update_airspeed(f, n, T(0), T(1)).taken, Taken::kUnusable);  // a port that is shut
  EXPECT_EQ(update_airspeed(f, n, T(-5), T(1)).taken, Taken::kUnusable);
}

TYPED_TEST(Navigate, VerticalAttitudeHasNoGimbal) {
  using T = TypeParam;
  // Straight up, spinning about the vertical: the angle between roll and heading has no meaning.
  JointFilter<T> f;
  const JointNoise<T> n = TestFixture::noise();
  const auto up = quaternion_from_euler(T(0), T(navigate_case::kPi / 2), T(0));
  start(f, n, 0.0, up, {T(0), T(0), T(-30)}, {}, JointStart<T>{});
  for (int i = 1; i <= 4000; ++i) {
    predict(f, n, i * this->kStep, {T(0.5), T(0), T(0)}, {T(kG), T(0), T(0)});
    const auto q = up * quaternion_of_turn(Vec3<T>{T(0.5 * i * this->kStep), T(0), T(0)});
    if (i % 8 == 0) update_field(f, n, earth_to_body(q) * n.field, T(0.5));
  }
  const auto q = up * quaternion_of_turn(Vec3<T>{T(5), T(0), T(0)});
  EXPECT_LT(angle_between(f.q, q), 0.01);
  EXPECT_EQ(f.tally.of[int(Taken::kGated)], 0u);
}

TYPED_TEST(Navigate, WindComesBackWithItsErrors) {
  using T = TypeParam;
  const Quaternion<T> q = quaternion_from_euler(T(0.3), T(0.1), T(2));
  const Vec3<T> wind{T(5), T(-7), T(1)};
  const T V(25), alpha(0.08), beta(-0.05);
  const Vec3<T> v_B = V * Vec3<T>{std::cos(alpha) * std::cos(beta), std::sin(beta),
                                  std::sin(alpha) * std::cos(beta)};
  const Vec3<T> velocity = transposed_times(earth_to_body(q), v_B) + wind;
  const Vec3<T> s{T(0.1), T(0.1), T(0.2)}, turn{T(0.01), T(0.01), T(0.02)};
  const auto found = wind_from(velocity, s, q, turn, {V, alpha, beta, T(0.3), T(0.01), T(0.01)});
  ASSERT_TRUE(found.valid);
  const Vec3<T> d = found.wind - wind;
  EXPECT_LT(std::sqrt(double(dot(d, d))), 1e-5);
  EXPECT_GT(double(determinant(found.covariance)), 0.0);
  // along the nose: airspeed and velocity count, a turn about x does not
  const Vec3<T> ahead = (T(1) / V) * transposed_times(earth_to_body(q), v_B);
  EXPECT_NEAR(double(dot(ahead, found.covariance * ahead)), 0.3 * 0.3 + 0.01, 0.01);
  const auto back = air_from_wind(velocity, s, q, turn, wind, found.covariance);
  ASSERT_TRUE(back.valid);
  EXPECT_NEAR(double(back.flow.V), 25.0, 1e-4);
  EXPECT_NEAR(double(back.flow.alpha), 0.08, 1e-5);
  EXPECT_NEAR(double(back.flow.beta), -0.05, 1e-5);
  EXPECT_FALSE(wind_from(velocity, s, q, turn, {T(0), alpha, beta, T(1), T(1), T(1)}).valid);
  EXPECT_FALSE(wind_from(velocity, s, q, turn, {this->kNaN, alpha, beta, T(1), T(1), T(1)}).valid);
  EXPECT_FALSE(air_from_wind(wind, s, q, turn, wind, found.covariance).valid);  // no airspeed
}

TYPED_TEST(Navigate, PowerTrainFollowsTheMotor) {
  using T = TypeParam;
  Electric<T> e;
  e.k_V = T(30);
  e.k_T = T(1.0 / 30);
  e.resistance = T(0.1);
  e.full_voltage = T(42);
  e.empty_voltage = T(36);
  e.capacity = T(3600);
  const PowerTrainNoise<T> n;
  PowerTrain<T> f;
  double charge = 0.0, left = 42.0;
  const double omega = 800.0;
  for (int i = 0; i <= 50 * 60; ++i) {
    // a missed pulse now and then
    const bool missed = i % 97 == 50;
    step(f, e, n, i / 50.0, T(0.8), T(missed ? 0.5 * omega : omega));
    left = 36.0 + 6.0 * (1.0 - charge / 3600.0);
    if (i < 50 * 60) charge += 0.8 * (0.8 * left - omega / 30.0) / 0.1 / 50.0;
  }
  EXPECT_EQ(f.tally.of[int(Taken::kGated)], 31u);
  EXPECT_NEAR(double(f.omega), omega, 0.5);
  EXPECT_NEAR(double(f.charge), charge, 0.002 * charge);  // Euler here, trapezoid there
  EXPECT_NEAR(double(f.voltage), left, 0.02);
  EXPECT_EQ(step(f, e, n, 10.0, T(0.8), T(800)), Taken::kBackwards);
  EXPECT_EQ(step(f, e, n, 100.0, this->kNaN, T(800)), Taken::kNotFinite);
  EXPECT_EQ(step(f, e, n, 100.0, T(0.8), this->kNaN), Taken::kNotFinite);
  EXPECT_NEAR(f.t, 60.0, 1e-9);
}

TYPED_TEST(Navigate, AllocatesNothing) {
  using T = TypeParam;
  auto f = std::make_unique<JointFilter<T>>();
  auto pair = std::make_unique<Pair<T>>();
  PairNoise<T> m;
  m.field = kField<T>;
  PowerTrain<T> train;
  const long before = alula_test::allocations();
  this->begin(*f, 30.0, 0.2);
  this->fly(*f, 30.0, 0.2, 0, 4000);
  start(pair->attitude, 0.0, {T(1), T(0), T(0), T(0)}, T(1), T(1), T(0.1));
  start(pair->position, 0.0, {}, {T(20), T(0), T(0)}, T(1), T(1), T(0.1));
  for (int i = 1; i < 800; ++i) {
    predict(*pair, m, i / 800.0, {}, {T(0), T(0), T(-9.8)});
    if (i % 16 == 0) update_field(*pair, m, kField<T>);
    step(train, Electric<T>{}, PowerTrainNoise<T>{}, i / 800.0, T(0.5), T(100));
  }
  EXPECT_EQ(alula_test::allocations(), before);
  ::operator delete(::operator new(1));  // the counter counts
  EXPECT_GT(alula_test::allocations(), before);
}

}  // namespace
