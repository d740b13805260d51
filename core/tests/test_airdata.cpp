// Conversions, five-hole probe, vanes and static port, in double and float.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "allocations.hpp"
#include "alula/airdata/conversions.hpp"
#include "alula/airdata/probe_table.hpp"
#include "alula/airdata/static_port.hpp"
#include "alula/airdata/vane.hpp"

namespace {

using namespace alula::airdata;
using alula::Vec3;

template <class S>
class Airdata : public ::testing::Test {};
using Scalars = ::testing::Types<double, float>;
TYPED_TEST_SUITE(Airdata, Scalars);

constexpr double kDeg = 0.017453292519943295;
template <class S>
constexpr double tolerance(double in_double, double in_float) {
  return sizeof(S) == 4 ? in_float : in_double;
}

// Pusztai's three terms as fitted to his CFD points, the free phase taken as a turned port.
template <class S>
Probe<S> armhawk() {
  Probe<S> probe;
  probe.side = three_terms(S(0), S(1.19497), S(-0.18477));
  probe.center = probe.side;
  probe.port_angle = S(40.95 * kDeg);
  EXPECT_TRUE(prepare(probe));
  return probe;
}

TEST(Conversions, PublishedValues) {
  // Compressible flow tables, NACA Report 1135 (gamma 1.4), p/pt at Mach 0.2, 0.5, 0.8, 1.
  const double mach[] = {0.2, 0.5, 0.8, 1.0}, p_over_pt[] = {0.9725, 0.8430, 0.6560, 0.5283};
  for (int i = 0; i < 4; ++i)  // four digits are printed
    EXPECT_NEAR(1.0 / (1.0 + impact_ratio(mach[i])), p_over_pt[i], 5e-5);
  // U.S. Standard Atmosphere 1976, Table I, geopotential heights of the layers' bases.
  EXPECT_NEAR(pressure_altitude(22632.06), 11000.0, 0.01);
  EXPECT_NEAR(pressure_altitude(5474.889), 20000.0, 0.01);
  EXPECT_NEAR(pressure_altitude(101325.0), 0.0, 1e-9);
  EXPECT_NEAR(density_altitude(1.2250), 0.0, 0.5);  // half a unit of the last digit is 0.4 m
  EXPECT_NEAR(density_altitude(0.36391), 11000.0, 1.0);
  EXPECT_NEAR(kSeaLevelSound,
              std::sqrt(1.4 * alula::standard_atmosphere_1976::kGasConstant * 288.15), 1e-9);
}

TYPED_TEST(Airdata, ConversionsReturn) {
  using S = TypeParam;
  const double rel = tolerance<S>(1e-12, 4e-6);
  for (double h : {-400.0, 0.0, 3000.0, 10999.0, 11001.0, 16000.0, 19000.0}) {
    const S p = pressure_at(S(h));
    EXPECT_NEAR(pressure_altitude(p), h, tolerance<S>(1e-6, 0.5));
    const auto air = alula::standard_atmosphere(geometric_height(S(h)));
    EXPECT_NEAR(density_altitude(air.density), h, tolerance<S>(1e-6, 0.5));
    for (double cas : {5.0, 20.0, 80.0, 140.0}) {
      const S tas = tas_of_cas(S(cas), p, air.temperature);
      if (h > 15000.0 && cas > 100.0) continue;  // supersonic up there
      EXPECT_NEAR(cas_of_tas(tas, p, air.temperature), cas, rel * cas) << h;
      const S eas = eas_of_tas(tas, p, air.temperature);
      EXPECT_NEAR(tas_of_eas(eas, p, air.temperature), tas, rel * tas);
      EXPECT_LE(eas, S(cas) * S(1 + 1e-6) + S(h < 0.0 ? 1.0 : 0.0));  // compressibility lowers it
      EXPECT_NEAR(ias_of_cas(cas_of_ias(S(cas), S(30)), S(30)), cas, tolerance<S>(1e-9, 0.02));
    }
  }
}

TYPED_TEST(Airdata, ConversionsOutsideTheirDomainAreNaN) {
  using S = TypeParam;
  const S nan = std::numeric_limits<S>::quiet_NaN();
  EXPECT_TRUE(std::isnan(mach_of(S(-1e-3))));
  EXPECT_TRUE(std::isnan(mach_of(S(1))));
  EXPECT_TRUE(std::isnan(impact_ratio(S(1.1))));
  EXPECT_TRUE(std::isnan(impact_ratio(S(-0.1))));
  EXPECT_TRUE(std::isnan(pressure_altitude(S(0))));
  EXPECT_TRUE(std::isnan(pressure_altitude(nan)));
  EXPECT_TRUE(std::isnan(density_altitude(S(-1))));
  EXPECT_TRUE(std::isnan(tas_of_cas(nan, S(1e5), S(288))));
  EXPECT_TRUE(std::isnan(tas_of_cas(S(50), S(0), S(288))));
  EXPECT_TRUE(std::isnan(speed_of_sound(S(0))));
  EXPECT_TRUE(std::isnan(cas_of_ias(S(5), S(-1000))));  // a port that reads that low
}

TYPED_TEST(Airdata, ProbeInverseAfterForward) {
  using S = TypeParam;
  const Probe<S> probe = armhawk<S>();
  int most = 0;
  for (double a = -35; a <= 35; a += 2.5)
    for (double b = -35; b <= 35; b += 2.5)
      for (double q : {30.0, 600.0, 5000.0}) {
        const auto p = probe_pressures(probe, S(q), S(a * kDeg), S(b * kDeg));
        ProbeFlow<S> flow;
        ASSERT_EQ(probe_flow(probe, p, flow), ProbeStatus::ok) << a << " " << b;
        // Float: rounding of 1e-7 times the sensitivity in the corners, about 5.
        EXPECT_NEAR(flow.alpha, a * kDeg, tolerance<S>(1e-9, 5e-6)) << a << " " << b;
        EXPECT_NEAR(flow.beta, b * kDeg, tolerance<S>(1e-9, 5e-6)) << a << " " << b;
        EXPECT_NEAR(flow.q, q, q * tolerance<S>(1e-9, 1e-5));
        most = std::max(most, flow.iterations);
      }
  EXPECT_LE(most, kProbeIterations);
}

// A fit with its sine left in, and a center port of its own with higher harmonics.
TYPED_TEST(Airdata, ProbeTakesAnyFit) {
  using S = TypeParam;
  Probe<S> probe;
  probe.side = three_terms(S(0.16835), S(1.18306), S(-0.18477));
  for (double k : {-1.35, 0.02, 2.5, -0.1, -0.05}) probe.center.power.push(S(k));
  probe.port_angle = S(45 * kDeg);
  ASSERT_TRUE(prepare(probe));
  for (double a = -34; a <= 34; a += 4)
    for (double b = -34; b <= 34; b += 4) {
      const auto p = probe_pressures(probe, S(400), S(a * kDeg), S(b * kDeg));
      ProbeFlow<S> flow;
      ASSERT_EQ(probe_flow(probe, p, flow), ProbeStatus::ok) << a << " " << b;
      EXPECT_NEAR(flow.alpha, a * kDeg, tolerance<S>(1e-8, 1e-5)) << a << " " << b;
      EXPECT_NEAR(flow.beta, b * kDeg, tolerance<S>(1e-8, 1e-5)) << a << " " << b;
    }
}

// Pusztai (3.7) with his printed c_p, written out.
TEST(Probe, IsThePublishedOneForItsCp) {
  Probe<double> probe;
  probe.side = three_terms(0.0, 1.2, -0.2);  // 2.4 cos^2 - 1.4
  probe.center = probe.side;
  probe.port_angle = 45 * kDeg;
  ASSERT_TRUE(prepare(probe));
  const double a = 0.2, b = -0.1, q = 551;
  const auto p = probe_pressures(probe, q, a, b);
  EXPECT_NEAR(p.vertical, 4.8 * std::sin(a) * std::cos(a) * std::pow(std::cos(b), 2) * q, 1e-9);
  EXPECT_NEAR(p.lateral, 4.8 * std::cos(a) * std::sin(b) * std::cos(b) * q, 1e-9);
  EXPECT_NEAR(p.center, 2.4 * std::pow(std::cos(a) * std::cos(b), 2) * q - 1.4 * q, 1e-9);
  ProbeFlow<double> flow;
  ASSERT_EQ(probe_flow(probe, p, flow), ProbeStatus::ok);
  EXPECT_EQ(flow.iterations, 1);  // the start is exact for two terms
}

TEST(Probe, SensitivityIsTheDifferenceQuotient) {
  const Probe<double> probe = armhawk<double>();
  for (auto [a, b] : {std::pair{0.0, 0.0}, {0.3, -0.2}, {-0.5, 0.5}}) {
    alula::Mat3<double> s;
    ASSERT_TRUE(probe_sensitivity(probe, 500.0, a, b, s));
    const auto p = probe_pressures(probe, 500.0, a, b);
    for (int k = 0; k < 3; ++k) {
      ProbeFlow<double> more, less;
      auto up = p, down = p;
      (k == 0 ? up.center : k == 1 ? up.vertical : up.lateral) += 0.01;
      (k == 0 ? down.center : k == 1 ? down.vertical : down.lateral) -= 0.01;
      ASSERT_EQ(probe_flow(probe, up, more), ProbeStatus::ok);
      ASSERT_EQ(probe_flow(probe, down, less), ProbeStatus::ok);
      const auto at = [k](const Vec3<double>& v) { return k == 0 ? v.x : k == 1 ? v.y : v.z; };
      EXPECT_NEAR(at(s.row[0]), (more.alpha - less.alpha) / 0.02, 1e-8);
      EXPECT_NEAR(at(s.row[1]), (more.beta - less.beta) / 0.02, 1e-8);
      EXPECT_NEAR(at(s.row[2]), (more.q - less.q) / 0.02, 1e-5);
    }
  }
}

TYPED_TEST(Airdata, ProbeRefusesWhatIsNoFlow) {
  using S = TypeParam;
  const Probe<S> probe = armhawk<S>();
  const S nan = std::numeric_limits<S>::quiet_NaN(), inf = std::numeric_limits<S>::infinity();
  ProbeFlow<S> flow{S(7), S(8), S(9), 5};
  using P = ProbePressures<S>;
  EXPECT_EQ(probe_flow(probe, P{nan, 0, 0}, flow), ProbeStatus::not_finite);
  EXPECT_EQ(probe_flow(probe, P{100, inf, 0}, flow), ProbeStatus::not_finite);
  EXPECT_EQ(probe_flow(probe, P{0, 0, 0}, flow), ProbeStatus::no_flow);
  EXPECT_EQ(probe_flow(probe, P{-500, 0, 0}, flow), ProbeStatus::from_behind);
  EXPECT_EQ(probe_flow(probe, P{-500, 20, 10}, flow), ProbeStatus::from_behind);
  const auto wide = probe_pressures(probe, S(500), S(45 * kDeg), S(0));
  EXPECT_EQ(probe_flow(probe, wide, flow), ProbeStatus::outside_domain);
  EXPECT_EQ(flow.q, S(7));
  EXPECT_EQ(flow.iterations, 5);
  Probe<S> blind;  // c_p that does not depend on the angle
  blind.side.power.push(S(0.5));
  blind.center = blind.side;
  blind.port_angle = S(45 * kDeg);
  EXPECT_FALSE(prepare(blind));
}

TYPED_TEST(Airdata, ProbeStepCountsAndKeepsItsState) {
  using S = TypeParam;
  const Probe<S> probe = armhawk<S>();
  const PressureLimits<S> limits{S(-2000), S(2000), 5};
  ProbeState<S> state;
  const auto p = probe_pressures(probe, S(500), S(0.1), S(0.05));
  ASSERT_EQ(probe_step(probe, limits, p, state), ProbeStatus::ok);
  const S alpha = state.flow.alpha;
  const S nan = std::numeric_limits<S>::quiet_NaN();
  EXPECT_EQ(probe_step(probe, limits, {nan, p.vertical, p.lateral}, state),
            ProbeStatus::not_finite);
  EXPECT_EQ(probe_step(probe, limits, {S(2000), p.vertical + 1, p.lateral + 1}, state),
            ProbeStatus::saturated);
  EXPECT_EQ(state.flow.alpha, alpha);
  EXPECT_EQ(state.age, 2);
  EXPECT_EQ(state.rejected[ProbeStatus::not_finite], 1);
  EXPECT_EQ(state.rejected[ProbeStatus::saturated], 1);
  int ok = 0;
  ProbeStatus::Value last = ProbeStatus::ok;
  for (int i = 0; i < 10; ++i) {  // the lateral sensor hangs, the others live
    last = probe_step(probe, limits, {p.center + S(i), p.vertical - S(i), p.lateral}, state);
    ok += last == ProbeStatus::ok;
  }
  EXPECT_EQ(last, ProbeStatus::stuck);
  EXPECT_EQ(ok, 5);
  EXPECT_TRUE(state.valid);
}

TYPED_TEST(Airdata, TableOfTheProbe) {
  using S = TypeParam;
  const Probe<S> probe = armhawk<S>();
  const int n = 17;
  std::vector<float> data;
  for (int i = 0; i < n; ++i)  // two terms: what is looked up is the start itself
    for (int j = 0; j < n; ++j)
      for (double x : {-1.2 + 0.15 * i, -1.2 + 0.15 * j, 1.0})
        data.push_back(static_cast<float>(x));
  ProbeTable<S> table{data.data(), n, S(1.2), probe.A, probe.B, probe.K, S(1), S(35 * kDeg)};
  for (double a : {-30.0, 0.0, 12.5})
    for (double b : {-20.0, 0.0, 33.0}) {
      ProbeFlow<S> flow;
      const auto p = probe_pressures(probe, S(500), S(a * kDeg), S(b * kDeg));
      ASSERT_EQ(probe_lookup(table, p, flow), ProbeStatus::ok);
      EXPECT_NEAR(flow.alpha, a * kDeg, 2e-6);  // the table is float
      EXPECT_NEAR(flow.beta, b * kDeg, 2e-6);
      EXPECT_NEAR(flow.q, 500.0, 2e-2);
    }
  ProbeFlow<S> flow;
  using P = ProbePressures<S>;
  const S nan = std::numeric_limits<S>::quiet_NaN();
  EXPECT_EQ(probe_lookup(table, P{nan, 0, 0}, flow), ProbeStatus::not_finite);
  EXPECT_EQ(probe_lookup(table, P{0, 0, 0}, flow), ProbeStatus::no_flow);
  EXPECT_EQ(probe_lookup(table, P{-500, 0, 0}, flow), ProbeStatus::from_behind);
  EXPECT_EQ(probe_lookup(table, probe_pressures(probe, S(500), S(0.65), S(0)), flow),
            ProbeStatus::outside_domain);
  data[0] = data[3] = data[3 * n] = data[3 * n + 3] = std::nanf("");
  EXPECT_EQ(probe_lookup(table, probe_pressures(probe, S(500), S(-0.86), S(-0.66)), flow),
            ProbeStatus::outside_domain);
}

TYPED_TEST(Airdata, VanesReturn) {
  using S = TypeParam;
  const Vane<S> alpha{S(0.2), S(0.01), {S(3), S(-0.5), S(0.1)}};
  const Vane<S> beta{S(0.05), S(-0.02), {S(3.5), S(0), S(-0.3)}};
  const Vec3<S> pitot{S(1), S(4), S(0.2)};
  for (double a : {-0.3, 0.0, 0.25})
    for (double b : {-0.2, 0.0, 0.3})
      for (double rate : {0.0, 0.5}) {
        const Vec3<S> rates{S(rate), S(-0.4 * rate), S(0.3 * rate)};
        const auto v = velocity_of(FlowAngles<S>{S(40), S(a), S(b)});
        const auto there = alula::velocity_at(v, rates, pitot);
        FlowAngles<S> flow;
        ASSERT_TRUE(flow_from_vanes(alpha, beta, pitot, alpha_vane_reading(alpha, v, rates),
                                    beta_vane_reading(beta, v, rates),
                                    std::sqrt(alula::dot(there, there)), rates, flow));
        EXPECT_NEAR(flow.V, 40.0, tolerance<S>(1e-12, 2e-5) * 40);
        EXPECT_NEAR(flow.alpha, a, tolerance<S>(1e-12, 2e-6));
        EXPECT_NEAR(flow.beta, b, tolerance<S>(1e-12, 2e-6));
        EXPECT_NEAR(beta_of_flank(flank_of_beta(S(b), S(a)), S(a)), b, tolerance<S>(1e-12, 1e-6));
        EXPECT_NEAR(flank_of_beta(S(b), S(a)), std::atan2(v.y, v.x), tolerance<S>(1e-12, 1e-6));
      }
  FlowAngles<S> flow{S(1), S(2), S(3)};
  const Vec3<S> still{}, wild{S(0), S(0), S(500)};
  const S nan = std::numeric_limits<S>::quiet_NaN();
  EXPECT_FALSE(flow_from_vanes(alpha, beta, pitot, nan, S(0), S(40), still, flow));
  EXPECT_FALSE(flow_from_vanes(alpha, beta, pitot, S(0), S(0), S(0), still, flow));
  EXPECT_FALSE(flow_from_vanes(alpha, beta, pitot, S(0), S(0), S(-40), still, flow));
  EXPECT_FALSE(flow_from_vanes(alpha, beta, pitot, S(1.9), S(0), S(40), still, flow));
  EXPECT_FALSE(flow_from_vanes(alpha, beta, pitot, S(0), S(0), S(40), wild, flow));
  EXPECT_EQ(flow.V, S(1));
}

TYPED_TEST(Airdata, StaticPort) {
  using S = TypeParam;
  const StaticPort<S> port{S(-0.819), S(0.579), S(1.225), S(40)};
  // Pusztai (3.11) at 30 m/s, and twice the air twice the correction.
  EXPECT_NEAR(static_pressure_correction(port, S(30), S(1.225)), 0.579 * 900 - 0.819 * 30, 1e-3);
  EXPECT_NEAR(static_pressure_correction(port, S(30), S(2.45)), 2 * (0.579 * 900 - 24.57), 1e-3);
  // Beyond the calibration the pressure coefficient stays.
  EXPECT_NEAR(static_pressure_correction(port, S(80), S(1.225)),
              4 * static_pressure_correction(port, S(40), S(1.225)), 1e-2);
  EXPECT_EQ(static_pressure_correction(port, S(-5), S(1.225)), S(0));
  EXPECT_TRUE(
      std::isnan(static_pressure_correction(port, std::numeric_limits<S>::quiet_NaN(), S(1.225))));
}

TYPED_TEST(Airdata, AllocatesNothing) {
  using S = TypeParam;
  const Probe<S> probe = armhawk<S>();
  const PressureLimits<S> limits{S(-2000), S(2000), 5};
  ProbeState<S> state;
  FlowAngles<S> flow;
  const Vane<S> vane{S(0.1), S(0), {S(1), S(0), S(0)}};
  long before = alula_test::allocations();
  {
    std::vector<double> control(10);
    EXPECT_GT(alula_test::allocations(), before);  // the counter counts
  }
  before = alula_test::allocations();
  S sum{};
  for (int i = 0; i < 1000; ++i) {
    const S a = S(0.0005) * S(i);
    probe_step(probe, limits, probe_pressures(probe, S(500), a, -a), state);
    flow_from_vanes(vane, vane, {}, a, a, S(40), {}, flow);
    sum += tas_of_cas(S(30), pressure_at(S(i)), S(280)) + pressure_altitude(S(9e4));
  }
  EXPECT_EQ(alula_test::allocations(), before);
  EXPECT_GT(sum, S(0));
}

}  // namespace
