// Strip theory against closed forms: plates of constant slope, symmetry, momentum.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "allocations.hpp"
#include "alula/aero/strip_theory.hpp"
#include "alula/propulsion/slipstream.hpp"

namespace {

using alula::StripAircraft;
using alula::StripFlow;
constexpr double kPi = 3.14159265358979323846;
constexpr int kSteps = 721;

// Sections of slope a for all angles within a quarter turn, drag and moment constant.
struct Sections {
  std::vector<double> c_l, c_d, c_m;
  explicit Sections(double a, double cd = 0.0) : c_l(kSteps), c_d(kSteps, cd), c_m(kSteps, 0.0) {
    for (int i = 0; i < kSteps; ++i)
      c_l[static_cast<unsigned>(i)] = a * (-kPi + 2 * kPi * i / (kSteps - 1));
  }
  alula::SectionTable<double> view() const { return {c_l.data(), c_d.data(), c_m.data(), kSteps}; }
};

// A flat rectangular wing of span b, chord c, quarter chord at x; n strips a half.
void add_wing(StripAircraft<double>& a, const Sections& sections, double x, double b, double c,
              int n, double induced, double downwash, bool wing) {
  alula::StripSurface<double> s;
  s.sections = sections.view();
  s.first = a.strips.size();
  s.count = 2 * n;
  s.induced = induced;
  s.lift_slope = sections.c_l[kSteps - 1] / kPi;
  s.downwash = downwash;
  s.wing = wing;
  a.surfaces.push(s);
  const double width = 0.5 * b / n;
  for (int i = 0; i < n; ++i)
    for (const double side : {1.0, -1.0}) {
      alula::Strip<double> strip{};
      strip.point = {x, side * (i + 0.5) * width, 0};
      strip.chord = {1, 0, 0};
      strip.normal = {0, 0, -1};
      strip.length = c;
      strip.area = c * width;
      strip.half_width = 0.5 * width;
      strip.flap = {0, 0, 5};
      a.strips.push(strip);
    }
}

// Upright at x, height h above the plane of the wing; its upper side is the right one.
void add_fin(StripAircraft<double>& a, const Sections& sections, double x, double h, double c,
             int n) {
  alula::StripSurface<double> s;
  s.sections = sections.view();
  s.first = a.strips.size();
  s.count = n;
  s.lift_slope = sections.c_l[kSteps - 1] / kPi;
  a.surfaces.push(s);
  for (int i = 0; i < n; ++i) {
    alula::Strip<double> strip{};
    strip.point = {x, 0, -(i + 0.5) * h / n};
    strip.chord = {1, 0, 0};
    strip.normal = {0, 1, 0};
    strip.length = c;
    strip.area = c * h / n;
    strip.half_width = 0.5 * h / n;
    strip.flap = {3, -0.5, 5};
    strip.gain[2] = 1;
    a.strips.push(strip);
  }
}

StripAircraft<double> bare() {
  StripAircraft<double> a;
  a.S = 3.0, a.b = 6.0, a.c = 0.5;
  return a;
}

StripFlow<double> flow(double alpha, double beta = 0) {
  return {alpha, beta, {0, 0, 0}, {0, 0, 0, 0}, 0, 0, 0};
}

double lift_of(const std::array<double, 6>& C, double alpha) {
  return C[0] * std::sin(alpha) - C[2] * std::cos(alpha);
}
double drag_of(const std::array<double, 6>& C, double alpha) {
  return -C[0] * std::cos(alpha) - C[2] * std::sin(alpha);
}

TEST(StripTheory, UniformWingGivesItsSectionsLiftAndInducedDrag) {
  const Sections sections(4.0, 0.01);
  auto a = bare();
  const double induced = 1 / (kPi * 0.9 * 12);
  add_wing(a, sections, 0, 6, 0.5, 10, induced, 0, true);
  for (const double alpha : {-0.2, 0.05, 0.3}) {
    const auto C = alula::strip_coefficients(a, flow(alpha));
    // The table is linear between its steps, so the line is met to rounding.
    EXPECT_NEAR(lift_of(C, alpha), 4 * alpha, 1e-12);
    EXPECT_NEAR(drag_of(C, alpha), 0.01 + induced * 16 * alpha * alpha, 1e-12);
    EXPECT_NEAR(C[1], 0, 1e-15);
    EXPECT_NEAR(C[3], 0, 1e-15);
    EXPECT_NEAR(C[5], 0, 1e-15);
  }
}

TEST(StripTheory, RollDampingAndPitchDamping) {
  const Sections sections(4.0);
  auto a = bare();
  const int n = 50;
  add_wing(a, sections, -2.0, 6, 0.5, n, 0, 0, true);
  const double step = 1e-5;
  auto f = flow(0);
  f.rates.x = step * 2 / a.b;
  // Cl_p = -a/6 of a rectangle; mid-strips fall short by 1/(4 n^2) of it.
  EXPECT_NEAR(alula::strip_coefficients(a, f)[3] / step, -4.0 / 6, 4.0 / 6 / (3.9 * n * n));
  f = flow(0);
  f.rates.y = step * 2 / a.c;
  // q lowers a point behind the center: alpha grows by q l/V, l = 2 m; qhat = q c/2V.
  const double angle = 2.0 * 2 / a.c;
  EXPECT_NEAR(-alula::strip_coefficients(a, f)[2] / step, 4 * angle, 1e-6);
  EXPECT_NEAR(alula::strip_coefficients(a, f)[4] / step, -4 * angle * 2.0 / a.c, 1e-5);
  a.center.x = -2.0;  // turning about the surface itself
  EXPECT_NEAR(alula::strip_coefficients(a, f)[2], 0, 1e-12);
}

TEST(StripTheory, DownwashTakesItsPartOfTheAngle) {
  const Sections wing(4.0), tail(3.0);
  for (const bool by_angle : {false, true}) {
    auto a = bare();
    a.downwash_by_angle = by_angle;
    add_wing(a, wing, 0, 6, 0.5, 6, 0, 0, true);
    const auto without = alula::strip_coefficients(a, flow(0.1));
    add_wing(a, tail, -3, 2, 0.3, 4, 0, 0.4, false);
    const auto with = alula::strip_coefficients(a, flow(0.1));
    // Attached flow: by lift and by angle are the same. Lift is normal to the turned flow.
    const double own = 3.0 * 0.1 * 0.6 * 0.6 / 3.0;
    EXPECT_NEAR(without[2] - with[2], own * std::cos(0.1 * 0.6), 1e-12);
  }
}

TEST(StripTheory, PlateAcrossTheFlowHasTheDragOfItsTable) {
  const Sections sections(0.0, 1.2);
  auto a = bare();
  add_wing(a, sections, 0, 6, 0.5, 4, 0, 0, true);
  const auto up = alula::strip_coefficients(a, flow(0.5 * kPi));
  EXPECT_NEAR(drag_of(up, 0.5 * kPi), 1.2, 1e-12);
  // From the side the flow runs along the span: nothing.
  EXPECT_NEAR(alula::strip_coefficients(a, flow(0, 0.5 * kPi))[0], 0, 1e-12);
}

TEST(StripTheory, WholeWingInTheSlipstreamIsAWingInFasterAir) {
  const Sections sections(4.0, 0.02);
  auto a = bare();
  add_wing(a, sections, 0, 6, 0.5, 10, 0.03, 0, true);
  auto f = flow(0.1);
  f.wash = 0.7;
  f.radius = 10;
  const double u = std::cos(0.1) + 0.7, w = std::sin(0.1);
  const double local = std::atan2(w, u), pressure = u * u + w * w;
  const double lift = 4 * local, drag = 0.02 + 0.03 * lift * lift;
  const auto C = alula::strip_coefficients(a, f);
  EXPECT_NEAR(C[0], pressure * (lift * std::sin(local) - drag * std::cos(local)), 1e-12);
  EXPECT_NEAR(C[2], -pressure * (lift * std::cos(local) + drag * std::sin(local)), 1e-12);
  EXPECT_NEAR(C[3], 0, 1e-14);  // no swirl, no roll
}

// Everything mirrored, the propeller's sense too: forces and moments are mirror images.
TEST(StripTheory, MirroredFlightGivesMirroredLoads) {
  const Sections wing(4.5, 0.015), fin(3.5, 0.012);
  auto a = bare();
  a.center = {-0.1, 0, 0.05};
  a.CD_body = 0.02;
  add_wing(a, wing, 0, 6, 0.5, 9, 0.03, 0, true);
  add_wing(a, wing, -3, 2, 0.3, 5, 0.04, 0.4, false);
  add_fin(a, fin, -3.1, 0.8, 0.4, 5);
  const StripFlow<double> f{0.12, 0.2, {0.05, 0.02, -0.04}, {0, 0, 0.3, 0}, 0.8, 0.9, 0.6};
  StripFlow<double> m = f;
  m.beta = -f.beta;
  m.rates.x = -f.rates.x;
  m.rates.z = -f.rates.z;
  m.controls[2] = -f.controls[2];
  m.swirl = -f.swirl;
  const auto C = alula::strip_coefficients(a, f), D = alula::strip_coefficients(a, m);
  for (const int i : {0, 2, 4}) EXPECT_NEAR(C[i], D[i], 1e-12) << i;
  for (const int i : {1, 3, 5}) {
    EXPECT_NEAR(C[i], -D[i], 1e-12) << i;
    EXPECT_GT(std::abs(C[i]), 1e-3) << i;
  }
}

// A right-hand propeller's swirl meets the right wing from above and the fin above it from the
// left: it rolls the aircraft to the right, against the engine's torque, and yaws it to the left.
TEST(StripTheory, SwirlRollsRightAndYawsLeft) {
  const Sections wing(4.5), fin(3.5);
  auto a = bare();
  add_wing(a, wing, 0, 6, 0.5, 90, 0, 0, true);
  add_fin(a, fin, -3, 0.5, 0.4, 4);
  auto f = flow(0);
  f.wash = 1e-9;
  f.swirl = 0.02;
  f.radius = 0.6;
  const auto C = alula::strip_coefficients(a, f);
  // Lift 4.5 Omega y c dy over -R..R by 18 strips: mid-strips fall short by 1/(4 18^2); the squares
  // of the angles, up to 0.012, are less. The fin stands in the slipstream too and is left out
  // here.
  const auto alone = alula::surface_loads(a, 0, f, 0.0).moment.x;
  EXPECT_NEAR(alone, 4.5 * 0.02 * 0.5 * 2 * 0.6 * 0.6 * 0.6 / 3, 1.5e-3 * alone);
  EXPECT_GT(C[3], 0);
  EXPECT_GT(C[1], 0);
  EXPECT_NEAR(C[5] * a.b, -3 * C[1], 1e-12);
}

TEST(StripTheory, NothingJumpsAsTheSlipstreamGrows) {
  const Sections sections(4.5, 0.01);
  auto a = bare();
  add_wing(a, sections, 0, 6, 0.5, 10, 0.03, 0, true);
  auto f = flow(0.1);
  f.wash = 1;
  double before = 0;
  for (double R = 0.001; R < 3.5; R += 0.001) {
    f.radius = R;
    const double lift = -alula::strip_coefficients(a, f)[2];
    // The whole wing gains less than the pressure's (1 + wash)^2 times its lift over 3 m of radius.
    if (R > 0.0015) { EXPECT_LT(std::abs(lift - before), 4.0 * 0.5 * 0.001 / 3 * 2) << R; }
    before = lift;
  }
}

TEST(StripTheory, FlapLiftIsLargestAtEightTenths) {
  const alula::Flap<double> flap{4.0, -0.6, 5.9};
  const double at = 1.6 / 4.0;
  EXPECT_NEAR(alula::flap_effect(flap, at).lift, 0.8, 1e-12);
  EXPECT_LT(alula::flap_effect(flap, at + 0.01).lift, 0.8);
  EXPECT_LT(alula::flap_effect(flap, at - 0.01).lift, 0.8);
  for (const double delta : {-0.5, -0.1, 0.2, 0.6}) {
    const auto e = alula::flap_effect(flap, delta);
    // Attached flow keeps the flap's whole slope: what lift lacks, the shift gives (Eq. 2.32).
    EXPECT_NEAR(e.lift + 5.9 * e.shift, 4.0 * delta, 1e-12);
  }
}

TEST(StripTheory, SlipstreamKeepsMomentumEnergyAndAngularMomentum) {
  const double rho = 1.2, R = 0.25, V = 12, thrust = 60, torque = 2.4;
  const auto s = alula::slipstream(V, thrust, torque, rho, R, 1.0);
  const double flux = rho * kPi * R * R * s.u1;
  EXPECT_NEAR(flux * (s.U_i - V), thrust, 1e-9);                           // (2.4)
  EXPECT_NEAR(0.5 * flux * s.Omega_i * s.R_i * s.R_i, torque, 1e-9);       // (2.5)
  EXPECT_NEAR(kPi * s.R_i * s.R_i * s.U_i, kPi * R * R * s.u1, 1e-9);      // continuity
  EXPECT_NEAR(0.5 * flux * (s.U_i * s.U_i - V * V), thrust * s.u1, 1e-8);  // (2.7)
}

TEST(StripTheory, SlopesAreThoseOfDifferences) {
  using D = alula::Dual<double, 4>;
  const Sections wing(4.5, 0.015), fin(3.5, 0.012);
  auto a = bare();
  add_wing(a, wing, 0, 6, 0.5, 9, 0.03, 0, true);
  add_wing(a, wing, -3, 2, 0.3, 5, 0.04, 0.4, false);
  add_fin(a, fin, -3.1, 0.8, 0.4, 5);
  const double at[4] = {0.11, 0.07, 0.6, 0.45};  // alpha, beta, wash, radius
  const auto dual = [&](int i) { return D::variable(at[i], i); };
  const StripFlow<D> f{
      dual(0), dual(1), {D(0.0), D(0.0), D(0.0)}, {D(0.0), D(0.0), D(0.1), D(0.0)}, dual(2),
      D(0.5),  dual(3)};
  const auto C = alula::strip_coefficients(a, f);
  for (int k = 0; k < 4; ++k) {
    const double h = 1e-6;
    double x[2][4];
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < 4; ++i) x[side][i] = at[i] + (i == k ? (side ? h : -h) : 0.0);
    std::array<double, 6> y[2];
    for (int side = 0; side < 2; ++side)
      y[side] = alula::strip_coefficients(
          a, StripFlow<double>{
                 x[side][0], x[side][1], {0, 0, 0}, {0, 0, 0.1, 0}, x[side][2], 0.5, x[side][3]});
    for (unsigned j = 0; j < 6; ++j)
      EXPECT_NEAR(C[j].slope_of(k), (y[1][j] - y[0][j]) / (2 * h), 1e-7) << k << j;
  }
}

TEST(StripTheory, AllocatesNothing) {
  const Sections sections(4.5, 0.015);
  auto a = bare();
  add_wing(a, sections, 0, 6, 0.5, 9, 0.03, 0, true);
  const auto count = alula_test::allocations();
  double sum = 0;
  for (int i = 0; i < 100; ++i) sum += alula::strip_coefficients(a, flow(0.001 * i))[2];
  EXPECT_EQ(alula_test::allocations(), count);
  EXPECT_LT(sum, 0);
}

}  // namespace
