// Kinematics of a point: rates against the closed form of a motion, Jacobians of step and outputs
// against central differences for every quantity, lever arm, wind and scale error.
#include <gtest/gtest.h>

#include <alula/filters/path_jacobians.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "path_case.hpp"

namespace {

using namespace alula;
using alula_test::kGravity;

TEST(PointKinematics, StepFollowsAMotionInClosedForm) {
  // One step of 0.01 s each from the exact state; inputs are linear between samples, the motion
  // is not: an error of a''dt^3/12, with a'' below 1e3 m/s4 about 1e-4 m/s, rates likewise.
  for (double t = 0; t < 60; t += 0.37) {
    auto from = alula_test::motion_at(t);
    const auto to = alula_test::motion_at(t + 0.01);
    point_step<7>(from.y, from.m, to.m, kGravity, 0.01);
    for (int i = 1; i < 7; ++i) EXPECT_NEAR(from.y[i], to.y[i], i < 4 ? 1e-4 : 1e-6) << t;
  }
}

TEST(PointKinematics, PositionIsVelocityInEarthAxes) {
  // Straight flight: north and east grow by the distance along the heading, height by the climb.
  const double theta = 0.1, psi = 2.0, speed = 50, dt = 0.1;
  double y[9] = {0, speed, 0, 0, 0, theta, psi, 0, 0};
  const double m[6] = {kGravity * std::sin(theta), 0, -kGravity * std::cos(theta), 0, 0, 0};
  point_step<9>(y, m, m, kGravity, dt);
  const double along = speed * dt;  // exact: every rate is constant, only rounding is left
  EXPECT_NEAR(y[kHeight], along * std::sin(theta), 1e-13);
  EXPECT_NEAR(y[kNorth], along * std::cos(theta) * std::cos(psi), 1e-13);
  EXPECT_NEAR(y[kEast], along * std::cos(theta) * std::sin(psi), 1e-13);
}

struct State {
  double y[9], m0[6], m1[6];
};

State random_state(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  State s{};
  const double center[9] = {500, 60, 0, 4, 0, 0, 0, 100, -50};
  const double range[9] = {400, 30, 8, 6, 1.5, 1.0, 3, 100, 100};
  for (int i = 0; i < 9; ++i) s.y[i] = center[i] + range[i] * unit(random);
  for (int i = 0; i < 6; ++i) {
    s.m0[i] = (i < 3 ? 8.0 : 0.8) * unit(random) - (i == 2 ? 9.8 : 0.0);
    s.m1[i] = s.m0[i] + (i < 3 ? 0.5 : 0.05) * unit(random);
  }
  return s;
}

// Central difference of f along direction j of x.
template <class F>
void difference(F&& f, double* x, int j, double h, int count, double* out) {
  double up[kMaxStates], down[kMaxStates];
  const double keep = x[j];
  x[j] = keep + h;
  f(x, up);
  x[j] = keep - h;
  f(x, down);
  x[j] = keep;
  for (int i = 0; i < count; ++i) out[i] = (up[i] - down[i]) / (2 * h);
}

template <int N>
void check_point_step() {
  std::mt19937 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    State s = random_state(random);
    double y[N], A[N][N], B[N][6], column[kMaxStates];
    std::copy(s.y, s.y + N, y);
    point_step_jacobian<N>(y, s.m0, s.m1, kGravity, 0.02, A, B);
    double plain[N];
    std::copy(s.y, s.y + N, plain);
    point_step<N>(plain, s.m0, s.m1, kGravity, 0.02);
    for (int i = 0; i < N; ++i) EXPECT_NEAR(y[i], plain[i], 1e-12 * (1 + std::abs(plain[i])));
    const auto by_state = [&](const double* x, double* out) {
      std::copy(x, x + N, out);
      point_step<N>(out, s.m0, s.m1, kGravity, 0.02);
    };
    for (int j = 0; j < N; ++j) {
      difference(by_state, s.y, j, 1e-4, N, column);
      // Rounding of values of 1e3 by 1e-4 is 1e-9, truncation 1e-8 of third derivatives below 10.
      for (int i = 0; i < N; ++i) EXPECT_NEAR(A[i][j], column[i], 1e-7) << i << ' ' << j;
    }
    for (int j = 0; j < 6; ++j) {
      double change[1] = {0};
      difference(
          [&](const double* x, double* out) {
            double a[6], b[6];
            for (int k = 0; k < 6; ++k) {
              a[k] = s.m0[k] + (k == j ? x[0] : 0);
              b[k] = s.m1[k] + (k == j ? x[0] : 0);
            }
            std::copy(s.y, s.y + N, out);
            point_step<N>(out, a, b, kGravity, 0.02);
          },
          change, 0, 1e-4, N, column);
      for (int i = 0; i < N; ++i) EXPECT_NEAR(B[i][j], column[i], 1e-7) << i << ' ' << j;
    }
    // The gain of input noise is the derivative of the rates.
    double G[7][6];
    point_input_gain(s.y, G);
    for (int j = 0; j < 6; ++j) {
      difference(
          [&](const double* x, double* out) {
            point_derivative<7>(s.y, RollPitch<double>(s.y), x, kGravity, out);
          },
          s.m0, j, 1e-4, 7, column);
      for (int i = 0; i < 7; ++i) EXPECT_NEAR(G[i][j], column[i], 1e-7) << i << ' ' << j;
    }
  }
}

TEST(PointKinematics, StepJacobianIsThatOfCentralDifferences) { check_point_step<7>(); }
TEST(PointKinematics, StepJacobianWithPositionLikewise) { check_point_step<9>(); }

// Motion with position, every inertial error, wind, scale and bias of the sensor: 9 + 12 + 3 = 24.
struct Everything {
  PathModel<double> model;
  double x[kMaxStates] = {};
  State s;
};

Everything everything(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Everything e;
  e.s = random_state(random);
  e.model.motion = 9;
  e.model.dynamic = 21;
  e.model.states = 24;
  e.model.wind = true;
  std::copy(e.s.y, e.s.y + 9, e.x);
  for (int k = 0; k < kPathUnknowns; ++k) {
    e.model.slot[k] = 9 + k;
    e.x[9 + k] = k < 3    ? 0.1 * unit(random)
                 : k < 6  ? 0.01 * unit(random)
                 : k < 12 ? 0.05 * unit(random)
                          : 6 * unit(random);
  }
  return e;
}

TEST(PathModel, StepJacobianHoldsBiasesAndScaleErrors) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 50; ++trial) {
    Everything e = everything(random);
    double y[kMaxStates], F[9][kMaxStates], column[kMaxStates];
    std::copy(e.x, e.x + 24, y);
    path_step_jacobian<9, kMaxStates>(e.model, y, e.s.m0, e.s.m1, 0.02, F);
    const auto step = [&](const double* x, double* out) {
      double m0[6], m1[6];
      true_inputs(e.model, x, e.s.m0, m0);
      true_inputs(e.model, x, e.s.m1, m1);
      std::copy(x, x + 9, out);
      point_step<9>(out, m0, m1, kGravity, 0.02);
    };
    for (int j = 0; j < 24; ++j) {
      const double h = j < 9 ? 1e-4 : 1e-5;
      difference(step, e.x, j, h, 9, column);
      for (int i = 0; i < 9; ++i) {
        // A scale error acts on readings that differ between the ends; their mean is taken, which
        // leaves (m1 - m0) dt^2/12 times the second derivative (100 m/s, 20 m/s2): below 1e-3.
        const bool scale = j >= 15 && j < 21;
        EXPECT_NEAR(F[i][j], column[i], scale ? 1e-3 : 2e-7) << i << ' ' << j;
      }
    }
  }
}

TEST(PathModel, OutputJacobianIsThatOfCentralDifferencesForEveryQuantity) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 30; ++trial)
    for (int quantity = 0; quantity <= static_cast<int>(Quantity::east); ++quantity)
      for (const bool lever : {false, true})
        for (const bool errors : {false, true}) {
          Everything e = everything(random);
          PathSensor<double> sensor;
          sensor.quantity = static_cast<Quantity>(quantity);
          if (lever) {
            sensor.position[0] = 8;
            sensor.position[1] = -3;
            sensor.position[2] = 1.5;
          }
          sensor.scale = 0.1;
          sensor.bias = 0.3;
          sensor.reference = 0.02;
          if (errors) {  // in the place of the wind's first two components
            e.model.slot[kWindNorth] = e.model.slot[kWindEast] = -1;
            e.model.fixed[kWindNorth] = 4;
            e.model.fixed[kWindEast] = -2;
            sensor.scale_slot = 21;
            sensor.bias_slot = 22;
            e.x[21] = -0.2;
            e.x[22] = 0.7;
          }
          e.model.sensors.push(sensor);
          double z[kMaxOutputs], H[1][kMaxStates], column[kMaxStates];
          path_outputs_jacobian<kMaxStates>(e.model, e.x, e.s.m0, z, H);
          const auto output = [&](const double* x, double* out) {
            double m[6], wind[3];
            true_inputs(e.model, x, e.s.m0, m);
            for (int i = 0; i < 3; ++i) wind[i] = unknown(e.model, x, kWindNorth + i);
            out[0] = path_output(e.model.sensors[0], x, path_air(e.model, x, wind, m));
          };
          double plain;
          output(e.x, &plain);
          EXPECT_NEAR(z[0], plain, 1e-12 * (1 + std::abs(plain))) << quantity;
          for (int j = 0; j < 24; ++j) {
            difference(output, e.x, j, 1e-5, 1, column);
            // Rounding of values of 1e3 by 1e-5: 1e-8; slopes reach 100.
            EXPECT_NEAR(H[0][j], column[0], 1e-7 * (1 + std::abs(column[0])))
                << "quantity " << quantity << " lever " << lever << " errors " << errors
                << " state " << j;
          }
        }
}

TEST(PathModel, AttitudeInnovationsAreTakenTheShortWay) {
  constexpr double turn = 6.283185307179586;
  EXPECT_NEAR(wrapped(Quantity::psi, turn - 0.1), -0.1, 1e-15);
  EXPECT_NEAR(wrapped(Quantity::phi, -3 * turn + 0.2), 0.2, 1e-14);
  EXPECT_EQ(wrapped(Quantity::theta, 7.0), 7.0);
  EXPECT_EQ(wrapped(Quantity::height, 7.0), 7.0);
}

}  // namespace
