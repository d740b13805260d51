// Slopes of the joint filter against differences of what they are slopes of.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "navigate_case.hpp"

namespace {

using namespace alula;
using navigate_case::kField;

// Slope of each reading by each error state, against central differences of the reading itself.
TEST(NavigateJacobians, AreTheDifferencesOfTheReadings) {
  using F = JointFilter<double>;
  F f;
  JointNoise<double> n;
  n.field = kField<double>;
  n.air_sensor = {1.0, 0.5, -0.3};
  start(f, n, 0.0, quaternion_from_euler(0.4, -0.3, 2.0), {20.0, -15.0, 3.0}, {1.0, 2.0, -100.0},
        JointStart<double>{});
  f.wind = {3.0, -2.0, 0.5};
  f.gust = {0.5, 0.3, -0.4};
  f.rate = {0.2, -0.1, 0.3};
  const auto moved = [&](int i, double h) {
    F g = f;
    double dx[kJointStates] = {};
    dx[i] = h;
    const auto at = [&dx](int k) { return Vec3<double>{dx[k], dx[k + 1], dx[k + 2]}; };
    g.q = g.q * quaternion_of_turn(at(kTurn));
    g.velocity = g.velocity + at(kVelocity);
    g.rate = g.rate - at(kGyroBias);
    g.wind = g.wind + at(kWind);
    g.gust = g.gust + at(kGust);
    return g;
  };
  const auto readings = [&n](const F& g) {
    const Vec3<double> v = air_velocity_at_sensor(g, n);
    const auto flow = flow_angles(v);
    const Vec3<double> h = earth_to_body(g.q) * n.field;
    return std::array<double, 6>{flow.V, flow.alpha, flow.beta, h.x, h.y, h.z};
  };
  // the analytic rows, asked of the update by its effect: H P of a unit covariance
  const auto row = [&](int reading) {
    std::array<double, kJointStates> H{};
    const Vec3<double> v = air_velocity_at_sensor(f, n);
    const double plane = v.x * v.x + v.z * v.z, root = std::sqrt(plane), V2 = plane + v.y * v.y;
    const Vec3<double> g[3] = {(1.0 / std::sqrt(V2)) * v,
                               {-v.z / plane, 0.0, v.x / plane},
                               {-v.x * v.y / (V2 * root), root / V2, -v.z * v.y / (V2 * root)}};
    const auto in = joint_filter_detail::of_the_air(f, n, g[reading], 0.0, 1.0);
    for (int k = 0; k < 15; ++k) H[std::size_t(in.column[k])] = in.H[0][k];
    return H;
  };
  const double h = 1e-6;
  const Vec3<double> field = earth_to_body(f.q) * n.field;
  for (int i = 0; i < kJointStates; ++i) {
    if (i >= kPosition && i < kGyroBias) continue;
    const auto up = readings(moved(i, h)), down = readings(moved(i, -h));
    for (int r = 0; r < 3; ++r)  // differences: 1e-16 V / h, and h^2
      EXPECT_NEAR(row(r)[std::size_t(i)], (up[std::size_t(r)] - down[std::size_t(r)]) / (2 * h),
                  1e-7)
          << "reading " << r << " state " << i;
    if (i < 3) {
      const Vec3<double> axis{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
      const Vec3<double> s = cross(field, axis);
      EXPECT_NEAR(s.x, (up[3] - down[3]) / (2 * h), 1e-6);
      EXPECT_NEAR(s.y, (up[4] - down[4]) / (2 * h), 1e-6);
      EXPECT_NEAR(s.z, (up[5] - down[5]) / (2 * h), 1e-6);
    }
  }
}

// The covariance's transition against differences of the motion itself, column by column: a start
// with one state uncertain spreads along that column.
TEST(NavigateJacobians, TransitionIsTheDifferenceOfTheMotion) {
  using F = JointFilter<double>;
  JointNoise<double> n;
  n.gyro = n.accelerometer = n.gyro_walk = n.accelerometer_walk = n.wind_walk = n.height_walk = 0;
  n.gust = {0.0, 0.0, 0.0};
  const Vec3<double> w{0.3, -0.2, 0.4}, force{0.5, 1.0, -12.0};
  const double dt = 2.5e-3, h = 1e-5;
  F base;
  start(base, n, 0.0, quaternion_from_euler(0.4, -0.3, 2.0), {20.0, -15.0, 3.0}, {}, {});
  base.rate = w;
  {
    const auto R = earth_to_body(base.q);
    base.acceleration = transposed_times(R, force);
    base.acceleration.z += n.gravity;
  }
  F nominal = base;
  predict(nominal, n, dt, w, force);
  for (int i = 0; i < kJointStates; ++i) {
    if (i >= kWind) continue;
    F off = base;
    double dx[kJointStates] = {};
    dx[i] = h;
    const auto at = [&dx](int k) { return Vec3<double>{dx[k], dx[k + 1], dx[k + 2]}; };
    off.q = off.q * quaternion_of_turn(at(kTurn));
    off.velocity = off.velocity + at(kVelocity);
    off.position = off.position + at(kPosition);
    off.gyro_bias = at(kGyroBias);
    off.force_bias = at(kForceBias);
    off.rate = w - off.gyro_bias;
    off.acceleration = transposed_times(earth_to_body(off.q), force - off.force_bias);
    off.acceleration.z += n.gravity;
    predict(off, n, dt, w, force);
    F spread = base;
    spread.P = {};
    spread.P.P[i][i] = 1.0;
    predict(spread, n, dt, w, force);
    const Vec3<double> turn = turn_of_quaternion(conjugate(nominal.q) * off.q);
    const Vec3<double> v = off.velocity - nominal.velocity, p = off.position - nominal.position;
    const double found[9] = {turn.x, turn.y, turn.z, v.x, v.y, v.z, p.x, p.y, p.z};
    // P = F e e' F': its column i over F_ii (states i keep themselves to first order)
    const double own = std::sqrt(spread.P.P[i][i]);
    for (int j = 0; j < 9; ++j)  // second order in dt is left out of F: (dt)^2 times 12 m/s2
      EXPECT_NEAR(spread.P.P[j][i] / own, found[j] / h, 1.5e-4) << j << " by " << i;
  }
}

TEST(NavigateJacobians, LatePositionIsTheErrorCarriedBack) {
  // Two motions that differ by a small error of each state now: how they differed 0.4 s before.
  JointFilter<double> f;
  const JointNoise<double> n;
  start(f, n, 0.0, quaternion_from_euler(0.2, 0.1, 1.0), {20.0, 5.0, 0.0}, {}, {});
  const double age = 0.4;
  const auto R = earth_to_body(f.q);
  const Vec3<double> force{0.0, 0.0, -15.0};  // constant, no rotation: exact integrals
  Vec3<double> a = transposed_times(R, force);
  a.z += n.gravity;
  const Place3<double> then{f.position - age * f.velocity + (0.5 * age * age) * a,
                            f.velocity - age * a};
  for (const bool position : {true, false}) {
    const auto in = joint_filter_detail::of_the_past(f, n, age, then, position);
    for (int k = 0; k < 12; ++k) {
      const double h = 1e-6;
      double dx[kJointStates] = {};
      dx[in.column[k]] = h;
      const Vec3<double> turn{dx[0], dx[1], dx[2]}, bias{dx[12], dx[13], dx[14]};
      // attitude and bias were the same then; acceleration differs all the way
      const auto Rt = earth_to_body(f.q * quaternion_of_turn(turn));
      Vec3<double> b = transposed_times(Rt, force - bias);
      b.z += n.gravity;
      const Vec3<double> v{f.velocity.x + dx[3], f.velocity.y + dx[4], f.velocity.z + dx[5]};
      const Vec3<double> p{f.position.x + dx[6], f.position.y + dx[7], f.position.z + dx[8]};
      const Vec3<double> past_v = v - age * b, past_p = p - age * v + (0.5 * age * age) * b;
      const Vec3<double> d = position ? past_p - then.position : past_v - then.velocity;
      EXPECT_NEAR(in.H[0][k], d.x / h, 1e-5) << k;
      EXPECT_NEAR(in.H[1][k], d.y / h, 1e-5) << k;
      EXPECT_NEAR(in.H[2][k], d.z / h, 1e-5) << k;
    }
  }
}

}  // namespace
