// Pusztai's propeller: its integrals against whole turns of the blades, its balances, its tables.
#include <gtest/gtest.h>

#include <cmath>

#include "allocations.hpp"
#include "alula/propulsion/slipstream.hpp"
#include "propeller_case.hpp"

namespace {

using namespace alula_test;
constexpr double kPi = 3.14159265358979324;

struct Loads {
  double F[3], M[3];
};

// The hub's loads by brute force: every blade element at every azimuth meets the whole velocity,
// nothing is linearized. In units of rho, w', R; U = J1. Midpoints, so no rule is shared.
Loads around(const alula::BladeShape<double>& b, const alula::BladeAerodynamics<double>& a,
             double J1, double v, double w, double q, double r_rate) {
  constexpr int kAzimuths = 72, kRadii = 2000;
  Loads sum{};
  for (int k = 0; k < kAzimuths; ++k) {
    const double theta = 2 * kPi * (k + 0.5) / kAzimuths, s = std::sin(theta), c = std::cos(theta);
    for (int i = 0; i < kRadii; ++i) {
      const double r = b.hub + (1 - b.hub) * (i + 0.5) / kRadii;
      // Velocity of the element: hub (J1, v, w) + rates x r e_r + turning e_theta.
      const double U = J1 + r * (q * s - r_rate * c), W = r - v * s + w * c;
      const double V = std::hypot(U, W), alpha = alula::pitch_at(b, r) - std::atan2(U, W);
      const double limit = alpha > a.alpha_max ? a.alpha_max : alpha;
      const double l = a.c_l_alpha * limit, d = a.c_d_alpha * alpha * alpha;
      const double scale =
          0.5 * V * alula::chord_at(b, r) * b.count * (1 - b.hub) / (kRadii * double(kAzimuths));
      const double Fx = scale * (l * W - d * U), Ft = -scale * (l * U + d * W);
      sum.F[0] += Fx;
      sum.F[1] -= Ft * s;
      sum.F[2] += Ft * c;
      sum.M[0] += r * Ft;
      sum.M[1] += r * Fx * s;
      sum.M[2] -= r * Fx * c;
    }
  }
  return sum;
}

TEST(HubCoefficients, AreSlopesOfTheLoadsOverWholeTurns) {
  const auto b = test_blades<double>();
  const auto a = test_sections<double>();
  for (const double J1 : {0.04, 0.09, 0.17}) {  // half of the blade stalled, a little, none
    const auto c = alula::hub_coefficients(b, a, J1);
    const double h = 1e-3;
    const Loads at = around(b, a, J1, 0, 0, 0, 0);
    const auto slope = [&](int axis, bool moment, double dv, double dw, double dq, double dr) {
      const Loads up = around(b, a, J1, h * dv, h * dw, h * dq, h * dr);
      const Loads down = around(b, a, J1, -h * dv, -h * dw, -h * dq, -h * dr);
      return moment ? (up.M[axis] - down.M[axis]) / (2 * h) : (up.F[axis] - down.F[axis]) / (2 * h);
    };
    // 2000 midpoints across a kink: 1e-6 of values of order 0.05
    const double near = 2e-5;
    EXPECT_NEAR(at.F[0], c.of[alula::kFx], near);
    EXPECT_NEAR(at.M[0], c.of[alula::kMx], near);
    EXPECT_NEAR(at.F[1], 0.0, 1e-12);
    EXPECT_NEAR(slope(1, false, 1, 0, 0, 0), c.of[alula::kFyV], near);
    EXPECT_NEAR(slope(2, false, 0, 1, 0, 0), c.of[alula::kFyV], near);
    EXPECT_NEAR(slope(1, false, 0, 0, 1, 0), c.of[alula::kFyQ], near);
    EXPECT_NEAR(slope(2, false, 0, 0, 0, 1), c.of[alula::kFyQ], near);
    EXPECT_NEAR(slope(1, true, 1, 0, 0, 0), c.of[alula::kMyV], near);
    EXPECT_NEAR(slope(2, true, 0, 1, 0, 0), c.of[alula::kMyV], near);
    EXPECT_NEAR(slope(1, true, 0, 0, 1, 0), c.of[alula::kMyQ], near);
    EXPECT_NEAR(slope(2, true, 0, 0, 0, 1), c.of[alula::kMyQ], near);
    // Pilot's rules: a propeller is a fin, damps pitch, and yaws left at high alpha.
    EXPECT_LT(c.of[alula::kFyV], 0.0);
    EXPECT_LT(c.of[alula::kMyQ], 0.0);
    EXPECT_LT(c.of[alula::kMyV], 0.0);
  }
}

TEST(HubCoefficients, StallBeginsWhereTheClosedFormSays) {
  auto b = test_blades<double>();
  b.hub = 0.0;
  const double alpha_max = 0.25;
  for (const double J1 : {0.02, 0.05, 0.1}) {
    const double r = alula::stall_radius(b.helix, J1, alpha_max);
    ASSERT_GT(r, 0.0);
    EXPECT_NEAR(alula::pitch_at(b, r) - std::atan2(J1, r), alpha_max, 1e-12);
    // The stalled lift ends there: that column is the integral up to r, by itself.
    const auto whole = alula::blade_integrals(b, alpha_max, J1);
    double stalled = 0.0;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
      const double x = r * (i + 0.5) / n;
      if (alula::pitch_at(b, x) - std::atan2(J1, x) > alpha_max)
        stalled += 0.5 * std::hypot(J1, x) * x * alula::chord_at(b, x) * r / n;
    }
    EXPECT_NEAR(whole.part[alula::kFx][0], stalled, 2e-7);  // the sum's own error at the kink
  }
  EXPECT_EQ(alula::stall_radius(1.2, 0.3, 0.25), 0.0);   // no section reaches it
  EXPECT_EQ(alula::stall_radius(9.0, 0.01, 0.02), 1.0);  // all of them do
}

TEST(MomentumPropeller, BalancesMomentumAngularMomentumAndEnergy) {
  const auto b = test_blades<double>();
  const auto a = test_sections<double>();
  const double omega = 600.0, rho = 1.1, R = b.radius;
  const double last = alula::windmill_J(b, a);
  ASSERT_GT(last, 0.5);
  for (const double part : {0.0, 0.2, 0.5, 0.9}) {
    const double J = part * last, V = J * omega * R / kPi;
    const auto s = alula::disk_of(b, a, J);
    ASSERT_EQ(s.regime, alula::PropellerRegime::inside);
    const double relative = s.ratio * omega;
    const double T = rho * s.c.of[alula::kFx] * relative * relative * std::pow(R, 4);
    const double Q = -rho * s.c.of[alula::kMx] * relative * relative * std::pow(R, 5);
    const auto wake = alula::slipstream(V, T, Q, rho, R, 1.0);
    ASSERT_TRUE(wake.inside);
    EXPECT_NEAR(wake.u1, s.J1 * relative * R, 1e-9);  // the blades meet that air
    EXPECT_NEAR(omega - wake.Omega_1, relative, 1e-9);
    const double flow = rho * kPi * R * R * wake.u1;  // kg/s
    EXPECT_NEAR(T, flow * (wake.U_i - V), 1e-10 * T + 1e-12);
    EXPECT_NEAR(wake.R_i * wake.R_i * wake.U_i, R * R * wake.u1, 1e-12);
    EXPECT_NEAR(Q, 0.5 * flow * wake.Omega_i * wake.R_i * wake.R_i, 1e-10 * Q);
    // At the disk, thrust and torque work on the air they meet: P = T u1 + Q Omega_1 + what the
    // sections' drag turns into heat. The heat is not below zero.
    const double power = Q * omega, useful = T * wake.u1, swirl = Q * wake.Omega_1;
    EXPECT_GT(power - useful - swirl, 0.0);
    EXPECT_LT(T * V / power, V / wake.u1 + 1e-12);  // Froude's limit
  }
}

TEST(MomentumPropeller, IsFroudesDiskWithoutDragOrSwirl) {
  // Vanishing drag: all of the shaft's power in the turning frame is the thrust's, dP = U dT.
  const auto b = test_blades<double>();
  const alula::BladeAerodynamics<double> ideal{5.2, 1.5, 0.0};
  for (const double J : {0.1, 0.3, 0.5}) {  // pitch over diameter is 0.6
    const auto s = alula::disk_of(b, ideal, J);
    ASSERT_EQ(s.regime, alula::PropellerRegime::inside);
    // per rho w'^3 R^5: power against the air at the disk -C_Mx, thrust's work C_Fx J1
    EXPECT_NEAR(-s.c.of[alula::kMx], s.c.of[alula::kFx] * s.J1, 1e-12);
    const double eta = s.J0 * s.ratio * s.c.of[alula::kFx] / -s.c.of[alula::kMx];
    EXPECT_NEAR(eta, s.ratio * s.J0 / s.J1, 1e-12);  // axial and swirl losses, nothing else
  }
}

TEST(MomentumPropeller, SaysWhereItEnds) {
  const auto b = test_blades<double>();
  const auto a = test_sections<double>();
  const double last = alula::windmill_J(b, a);
  EXPECT_EQ(alula::disk_of(b, a, -0.01).regime, alula::PropellerRegime::reverse);
  EXPECT_EQ(alula::disk_of(b, a, last * 0.999).regime, alula::PropellerRegime::inside);
  EXPECT_EQ(alula::disk_of(b, a, last * 1.001).regime, alula::PropellerRegime::windmill);
  EXPECT_EQ(alula::disk_of(b, a, 50.0).regime, alula::PropellerRegime::windmill);
  alula::MomentumTable<double> table;
  ASSERT_TRUE(alula::make_momentum_table(b, a, 1.0, table));
  const double rho = 1.2, omega = 500.0, tip = omega * b.radius / kPi;  // V at J = 1
  const auto at = [&](double J) {
    return alula::hub_loads(table, omega, alula::Vec3<double>{J * tip, 0, 0}, alula::Vec3<double>{},
                            rho);
  };
  EXPECT_EQ(at(-0.1).regime, alula::PropellerRegime::reverse);
  EXPECT_EQ(at(last + 0.01).regime, alula::PropellerRegime::windmill);
  const auto standing =
      alula::hub_loads(table, 0.0, alula::Vec3<double>{20, 1, 0}, alula::Vec3<double>{}, rho);
  EXPECT_EQ(standing.regime, alula::PropellerRegime::standing);
  EXPECT_EQ(standing.force.x, 0.0);
  auto flat = b;
  flat.helix = 0.0;
  for (double& angle : flat.pitch) angle = 0.0;
  EXPECT_FALSE(alula::make_momentum_table(flat, a, 1.0, table));  // no static thrust
  EXPECT_EQ(alula::disk_of(flat, a, 0.3).regime, alula::PropellerRegime::unsolved);
}

TEST(MomentumPropeller, TableIsTheSolution) {
  const auto b = test_blades<double>();
  const auto a = test_sections<double>();
  alula::MomentumTable<double> table;
  ASSERT_TRUE(alula::make_momentum_table(b, a, 1.0, table));
  const double rho = 1.2, omega = 500.0, R = b.radius;
  double most = 0.0;
  for (double part = 0.003; part < 1.0; part += 0.0171) {
    const double J = part * table.last;
    const auto s = alula::disk_of(b, a, J);
    const double scale = rho * std::pow(s.ratio * omega, 2) * std::pow(R, 4);
    const auto l = alula::hub_loads(table, omega, alula::Vec3<double>{J * omega * R / kPi, 2, 0},
                                    alula::Vec3<double>{0, 0.5, 0}, rho);
    const double thrust = scale * s.c.of[alula::kFx];
    most = std::max(most, thrust);
    // cubics between 49 knots: the coefficients' third derivatives leave some 1e-4 of the largest
    EXPECT_NEAR(l.force.x, thrust, 3e-4 * std::max(most, 1.0));
    const double side = rho * s.ratio * omega * std::pow(R, 3) *
                        (s.c.of[alula::kFyV] * 2 + s.c.of[alula::kFyQ] * R * 0.5);
    // The attached lift's share jumps where stall ends on the blade: a kink of F_y over J, which no
    // smooth curve follows between two knots.
    EXPECT_NEAR(l.force.y, side, 0.02 * std::abs(side));
  }
}

TEST(MomentumPropeller, LeftHandIsTheMirrorImage) {
  const auto b = test_blades<double>();
  const auto a = test_sections<double>();
  alula::MomentumTable<double> right, left;
  ASSERT_TRUE(alula::make_momentum_table(b, a, 1.0, right));
  ASSERT_TRUE(alula::make_momentum_table(b, a, -1.0, left));
  const alula::Vec3<double> v{15, 2, -1}, w{0.3, 0.2, -0.4};
  const auto r = alula::hub_loads(right, 500.0, v, w, 1.2);
  const auto l = alula::hub_loads(left, 500.0, alula::Vec3<double>{v.x, -v.y, v.z},
                                  alula::Vec3<double>{-w.x, w.y, -w.z}, 1.2);
  EXPECT_DOUBLE_EQ(l.force.x, r.force.x);
  EXPECT_DOUBLE_EQ(l.force.y, -r.force.y);
  EXPECT_DOUBLE_EQ(l.force.z, r.force.z);
  EXPECT_DOUBLE_EQ(l.moment.x, -r.moment.x);
  EXPECT_DOUBLE_EQ(l.moment.y, r.moment.y);
  EXPECT_DOUBLE_EQ(l.moment.z, -r.moment.z);
  EXPECT_LT(r.moment.x, 0.0);  // a right-hand propeller rolls its aircraft left
}

TEST(MomentumPropeller, HasExactSlopesAndAFloatForm) {
  alula::MomentumTable<double> table;
  alula::MomentumTable<float> small;
  ASSERT_TRUE(
      alula::make_momentum_table(test_blades<double>(), test_sections<double>(), 1.0, table));
  ASSERT_TRUE(
      alula::make_momentum_table(test_blades<float>(), test_sections<float>(), 1.0f, small));
  using D = alula::Dual<double, 4>;
  const double omega = 520.0, V = 17.3, h = 1e-4;
  const alula::Vec3<D> v{D::variable(V, 1), D(1.5), D(-0.5)}, w{D(0.1), D(0.2), D(0.3)};
  const auto x = alula::hub_loads(table, D::variable(omega, 0), v, w, D(1.2));
  const auto at = [&](double o, double u) {
    return alula::hub_loads(table, o, alula::Vec3<double>{u, 1.5, -0.5},
                            alula::Vec3<double>{0.1, 0.2, 0.3}, 1.2);
  };
  const auto up = at(omega + h, V), down = at(omega - h, V);
  const auto fast = at(omega, V + h), slow = at(omega, V - h);
  EXPECT_NEAR(x.force.x.slope_of(0), (up.force.x - down.force.x) / (2 * h), 1e-7);
  EXPECT_NEAR(x.torque.slope_of(1), (fast.torque - slow.torque) / (2 * h), 1e-7);
  EXPECT_NEAR(x.moment.z.slope_of(1), (fast.moment.z - slow.moment.z) / (2 * h), 1e-7);
  const auto f = alula::hub_loads(small, 520.0f, alula::Vec3<float>{17.3f, 1.5f, -0.5f},
                                  alula::Vec3<float>{0.1f, 0.2f, 0.3f}, 1.2f);
  const auto d = at(omega, V);
  EXPECT_NEAR(f.force.x, d.force.x, 1e-3 * std::abs(d.force.x));
  EXPECT_NEAR(f.torque, d.torque, 1e-3 * d.torque);
  EXPECT_NEAR(f.force.y, d.force.y, 2e-3 * std::abs(d.force.y));
}

TEST(Slipstream, IsQuietAtRestAndRefusesReverse) {
  const auto none = alula::slipstream(0.0, 0.0, 0.0, 1.2, 0.25, 1.0);
  EXPECT_TRUE(none.inside);
  EXPECT_EQ(none.U_i, 0.0);
  EXPECT_FALSE(alula::slipstream(-1.0, 10.0, 0.1, 1.2, 0.25, 1.0).inside);
  EXPECT_FALSE(alula::slipstream(5.0, -100.0, -0.1, 1.2, 0.25, 1.0).inside);
  EXPECT_LT(alula::slipstream(5.0, 10.0, 0.1, 1.2, 0.25, -1.0).Omega_i, 0.0);
}

TEST(MomentumPropeller, AllocatesNothing) {
  const long before = alula_test::allocations();
  alula::MomentumTable<double> table;
  bool made =
      alula::make_momentum_table(test_blades<double>(), test_sections<double>(), 1.0, table);
  const auto l = alula::hub_loads(table, 500.0, alula::Vec3<double>{10, 1, 0},
                                  alula::Vec3<double>{0, 0.1, 0}, 1.2);
  const auto wake = alula::slipstream(10.0, l.force.x, l.torque, 1.2, table.radius, 1.0);
  EXPECT_EQ(alula_test::allocations(), before);
  EXPECT_TRUE(made && wake.inside);
}

}  // namespace
