// Dryden turbulence against the spectra of MIL-F-8785C.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <ostream>
#include <random>
#include <vector>

#include "alula/motion/dryden.hpp"

namespace {

constexpr double kPi = 3.14159265358979324;

struct Case {
  double V, height, dt;
  alula::Dryden<double> setting;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.V << " m/s, " << c.height << " m, " << 1 / c.dt << " Hz";
}
// Low and high form and between, fast and slow, small and large, 100 and 10 Hz.
const Case kCases[] = {
    {50.0, 60.0, 0.01, {8.65, 7.7, 0.0}},    {25.0, 150.0, 0.1, {8.65, 15.0, 0.0}},
    {200.0, 3000.0, 0.01, {30.0, 0.0, 1.5}}, {100.0, 9000.0, 0.1, {60.0, 0.0, 3.0}},
    {18.0, 15.0, 0.01, {2.1, 5.0, 0.0}},     {60.0, 450.0, 0.1, {15.0, 10.0, 2.0}},
};

// The specification's spectra, one-sided over angular frequency (rad/s): Phi(Omega)/V at
// Omega = omega/V; u v w (m2/s2 per rad/s), p q r (rad2/s2 per rad/s).
void specification(const Case& c, double omega, double (&S)[6]) {
  const auto scale = alula::dryden_scale(c.setting, c.height);
  const double k = omega / c.V, b = c.setting.span;
  const double Lu = scale.length_u, Lw = scale.length_w;
  const double su = scale.sigma_u * scale.sigma_u, sw = scale.sigma_w * scale.sigma_w;
  const auto transverse = [k](double s, double L) {
    const double x = L * k * L * k;
    return s * L / kPi * (1 + 3 * x) / ((1 + x) * (1 + x));
  };
  const double pitch = 4 * b * k / kPi, yaw = 3 * b * k / kPi;
  S[0] = su * 2 * Lu / kPi / (1 + Lu * k * Lu * k);
  S[1] = transverse(su, Lu);
  S[2] = transverse(sw, Lw);
  S[3] = sw / Lw * 0.8 * std::cbrt(kPi * Lw / (4 * b)) / (1 + pitch * pitch);
  S[4] = k * k / (1 + pitch * pitch) * S[2];
  S[5] = k * k / (1 + yaw * yaw) * S[1];
  for (double& s : S) s /= c.V;
}

// As sampling shows it: what lies above half the sampling rate is folded down.
void folded(const Case& c, double omega, double (&S)[6]) {
  specification(c, omega, S);
  const double rate = 2 * kPi / c.dt;
  for (int k = 1; k <= 60; ++k)
    for (const double at : {k * rate - omega, k * rate + omega}) {
      double more[6];
      specification(c, at, more);
      for (int i = 0; i < 6; ++i) S[i] += more[i];
    }
}

void to_array(const alula::Turbulence<double>& g, double (&out)[6]) {
  const double all[] = {g.velocity.x, g.velocity.y, g.velocity.z, g.rates.x, g.rates.y, g.rates.z};
  std::copy(all, all + 6, out);
}

// Radix-2 transform in place; n a power of two.
void transform(std::vector<std::complex<double>>& a) {
  const std::size_t n = a.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n / 2;
    for (; j & bit; bit /= 2) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(a[i], a[j]);
  }
  for (std::size_t size = 2; size <= n; size *= 2) {
    const std::complex<double> turn = std::polar(1.0, -2 * kPi / static_cast<double>(size));
    for (std::size_t first = 0; first < n; first += size) {
      std::complex<double> w = 1.0;
      for (std::size_t k = 0; k < size / 2; ++k, w *= turn) {
        const auto even = a[first + k], odd = w * a[first + k + size / 2];
        a[first + k] = even + odd;
        a[first + k + size / 2] = even - odd;
      }
    }
  }
}

class DrydenSpectra : public testing::TestWithParam<Case> {};

TEST_P(DrydenSpectra, AreThoseOfTheSpecification) {
  const Case c = GetParam();
  constexpr std::size_t n = 8192;
  constexpr int segments = 96;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const auto draw = [&](double* z) {
    for (int i = 0; i < alula::kDrydenNormals; ++i) z[i] = normal(random);
  };
  double z[alula::kDrydenNormals];
  draw(z);
  auto x = alula::dryden_start(c.setting, c.V, c.height, z);
  const auto filter = alula::dryden_filter(c.setting, c.V, c.height, c.dt);
  std::vector<std::array<double, 6>> power(n / 2);
  std::vector<std::complex<double>> series[6];
  for (auto& s : series) s.resize(n);
  double window_power = 0.0;
  for (int segment = 0; segment < segments; ++segment) {
    for (std::size_t i = 0; i < n; ++i) {
      draw(z);
      alula::dryden_step(filter, z, x);
      double out[6];
      to_array(alula::turbulence(filter, x), out);
      // Hann's window: what leaks from the steep low end stays below what is there
      const double window = 0.5 - 0.5 * std::cos(2 * kPi * static_cast<double>(i) / n);
      if (segment == 0) window_power += window * window;
      for (int k = 0; k < 6; ++k) series[k][i] = window * out[k];
    }
    for (int k = 0; k < 6; ++k) {
      transform(series[k]);
      for (std::size_t f = 0; f < n / 2; ++f)
        power[f][static_cast<unsigned>(k)] += std::norm(series[k][f]) / segments;
    }
  }
  // One-sided density over rad/s: 2 |X|^2 dt/(sum of window^2) per Hz, over 2 pi.
  for (auto& p : power)
    for (double& s : p) s *= c.dt / (kPi * window_power);

  // Bands from line 6 up, each an octave; the first has 6 lines, 576 values: 5 % by chance with
  // Hann's overlap of lines, the others less. Up to a fifth of the sampling rate the series agrees
  // with the folded specification; up to a tenth of it with the specification itself, where
  // folding adds at most 6 % (at a fifth: 14 %, for any exactly sampled process of this form).
  for (std::size_t first = 6; first < n / 5; first *= 2) {
    const std::size_t end = std::min(2 * first, n / 5 + 1);
    double sampled[6] = {}, plain[6] = {};
    for (std::size_t f = first; f < end; ++f) {
      const double omega = 2 * kPi * static_cast<double>(f) / (static_cast<double>(n) * c.dt);
      double S[6];
      folded(c, omega, S);
      for (unsigned k = 0; k < 6; ++k) sampled[k] += power[f][k] / S[k];
      specification(c, omega, S);
      for (unsigned k = 0; k < 6; ++k) plain[k] += power[f][k] / S[k];
    }
    const double lines = static_cast<double>(end - first);
    for (unsigned k = 0; k < 6; ++k) {
      EXPECT_NEAR(sampled[k] / lines, 1.0, first == 6 ? 0.2 : 0.1)
          << "uvwpqr"[k] << " line " << first;
      if (end <= n / 10 && first > 6) {
        EXPECT_NEAR(plain[k] / lines, 1.0, 0.1) << "uvwpqr"[k] << " line " << first;
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Conditions, DrydenSpectra, testing::ValuesIn(kCases));

// The covariance that one long step drives into the states is the stationary one.
template <class Matrix>
void covariance(const Matrix& drive, double (&P)[3][3]) {
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned j = 0; j < 3; ++j) {
      P[i][j] = 0.0;
      for (unsigned k = 0; k < 3; ++k) P[i][j] += drive[i][k] * drive[j][k];
    }
}

TEST(Dryden, StandardDeviationsAreTheIntegralsOfTheSpectra) {
  for (const Case& c : kCases) {
    // Integral over rad/s by the substitution omega = tan(t), midpoints; smooth at both ends.
    double integral[6] = {};
    const double scale = c.V / c.setting.span;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
      const double t = (i + 0.5) * 0.5 * kPi / n, tangent = std::tan(t);
      double S[6];
      specification(c, scale * tangent, S);
      for (int k = 0; k < 6; ++k)
        integral[k] += S[k] * scale * (1 + tangent * tangent) * 0.5 * kPi / n;
    }
    const auto f = alula::dryden_filter(c.setting, c.V, c.height, 1e4);  // hundreds of L/V
    const double root3 = std::sqrt(3.0);
    const auto transverse = [&](const auto& drive, double sigma, double rate, double& velocity,
                                double& turn) {
      double P[3][3];
      covariance(drive, P);
      const double a[] = {root3 / std::sqrt(2.0), (1 - root3) / std::sqrt(2.0), 0.0};
      const double b[] = {a[0], a[1], -1.0};
      velocity = turn = 0.0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          velocity += sigma * sigma * a[i] * P[i][j] * a[j];
          turn += sigma * sigma * rate * rate * b[i] * P[i][j] * b[j];
        }
    };
    double variance[6];
    variance[0] = std::pow(f.sigma_u * f.drive_u, 2);
    variance[3] = std::pow(f.sigma_p * f.drive_p, 2);
    transverse(f.drive_v, f.sigma_u, f.rate_r, variance[1], variance[5]);
    transverse(f.drive_w, f.sigma_w, f.rate_q, variance[2], variance[4]);
    for (int k = 0; k < 6; ++k)  // quadrature, and differences of nearly equal states for q and r
      EXPECT_NEAR(variance[k] / integral[k], 1.0, 1e-6) << "uvwpqr"[k] << " at " << c.height;
    const auto s = alula::dryden_scale(c.setting, c.height);
    EXPECT_NEAR(std::sqrt(variance[1]), s.sigma_u, 1e-9);
    EXPECT_NEAR(std::sqrt(variance[2]), s.sigma_w, 1e-9);
  }
}

TEST(Dryden, TwoStepsAreOneOfTwiceTheLength) {
  // Exact in the step (1e-12: roundings of up to 11 doublings), also where the two break
  // frequencies meet (a = c) and far apart.
  for (const double a : {0.01, 1.0, 5.0, 40.0})
    for (const double c : {0.01, 1.0, 5.0, 40.0})
      for (const double dt : {1e-3, 0.1, 2.0}) {
        alula::detail::Square<double> T1, L1, T2, L2;
        alula::detail::transverse_filter(a, c, dt, T1, L1);
        alula::detail::transverse_filter(a, c, 2 * dt, T2, L2);
        double P1[3][3], P2[3][3];
        covariance(L1, P1);
        covariance(L2, P2);
        for (unsigned i = 0; i < 3; ++i)
          for (unsigned j = 0; j < 3; ++j) {
            double transition = 0.0, moved = P1[i][j];
            for (unsigned k = 0; k < 3; ++k) {
              transition += T1[i][k] * T1[k][j];
              for (unsigned m = 0; m < 3; ++m) moved += T1[i][k] * P1[k][m] * T1[j][m];
            }
            EXPECT_NEAR(T2[i][j], transition, 1e-12);
            EXPECT_NEAR(P2[i][j], moved, 1e-12);
          }
        // Known in closed form: the first state is an exponential correlation of unit variance,
        // the transition of the second one (a double pole) is a dt exp(-a dt).
        EXPECT_NEAR(P1[0][0], 1 - std::exp(-2 * a * dt), 1e-12);
        EXPECT_NEAR(T1[1][0], a * dt * std::exp(-a * dt), 1e-12);
        EXPECT_NEAR(T1[2][2], std::exp(-c * dt), 1e-12);
      }
}

TEST(Dryden, LengthsAndIntensitiesOfTheSpecification) {
  const alula::Dryden<double> d{10.0, 15.0, 2.0};
  const auto low = alula::dryden_scale(d, 500 * 0.3048);
  EXPECT_NEAR(low.length_w, 500 * 0.3048, 1e-9);
  EXPECT_NEAR(low.length_u, 500 * 0.3048 / std::pow(0.177 + 0.000823 * 500, 1.2), 1e-9);
  EXPECT_NEAR(low.sigma_w, 1.5, 1e-12);
  EXPECT_NEAR(low.sigma_u, 1.5 / std::pow(0.177 + 0.000823 * 500, 0.4), 1e-12);
  const auto border = alula::dryden_scale(d, 1000 * 0.3048);
  EXPECT_NEAR(border.length_u, border.length_w, 1e-9);  // isotropic there: 0.177 + 0.823 = 1
  EXPECT_NEAR(border.sigma_u, border.sigma_w, 1e-12);
  const auto between = alula::dryden_scale(d, 1500 * 0.3048);
  EXPECT_NEAR(between.length_u, 1375 * 0.3048, 1e-6);
  EXPECT_NEAR(between.sigma_w, 1.75, 1e-9);
  const auto high = alula::dryden_scale(d, 5000.0);
  EXPECT_NEAR(high.length_w, 1750 * 0.3048, 1e-9);
  EXPECT_NEAR(high.sigma_u, 2.0, 1e-12);
  EXPECT_NEAR(alula::dryden_scale(d, -5.0).length_w, 10 * 0.3048, 1e-9);
}

TEST(Dryden, RatesFollowTheFieldThatTheVelocitiesShow) {
  // Flying into air that goes down ever faster, dw/dx > 0: the air turns with q = -dw/dx; into air
  // that goes right ever faster, dv/dx > 0: it turns with r = +dv/dx. Correlation of the rates with
  // the velocities' changes, over their own filters of a tenth of a second.
  const Case c{50.0, 3000.0, 0.01, {8.65, 0.0, 1.0}};
  const auto f = alula::dryden_filter(c.setting, c.V, c.height, c.dt);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double z[8] = {};
  auto x = alula::dryden_start(c.setting, c.V, c.height, z);
  double with_q = 0.0, with_r = 0.0, ww = 0.0, vv = 0.0, qq = 0.0, rr = 0.0;
  auto before = alula::turbulence(f, x);
  for (int i = 0; i < 200000; ++i) {
    for (double& v : z) v = normal(random);
    alula::dryden_step(f, z, x);
    const auto now = alula::turbulence(f, x);
    const double dw = now.velocity.z - before.velocity.z, dv = now.velocity.y - before.velocity.y;
    with_q += dw * now.rates.y;
    with_r += dv * now.rates.z;
    ww += dw * dw;
    vv += dv * dv;
    qq += now.rates.y * now.rates.y;
    rr += now.rates.z * now.rates.z;
    before = now;
  }
  EXPECT_LT(with_q / std::sqrt(ww * qq), -0.1);  // chance: 0.005
  EXPECT_GT(with_r / std::sqrt(vv * rr), 0.1);
}

TEST(Dryden, LowTurbulenceLiesAlongTheHorizontalAirVelocity) {
  const alula::Turbulence<double> gust{{1, 2, 3}, {0.1, 0.2, 0.3}};
  // Wings level, nose up by 0.3, flying level to the north-east, so alpha is 0.3.
  const auto R = alula::earth_to_body(alula::quaternion_from_euler(0.0, 0.3, 0.8));
  const alula::Vec3<double> v{40 * std::cos(0.3), 0.0, 40 * std::sin(0.3)};
  const auto low = alula::turbulence_in_body(gust, R, v, 50.0);
  EXPECT_NEAR(low.velocity.x, std::cos(0.3) * 1 - std::sin(0.3) * 3, 1e-12);
  EXPECT_NEAR(low.velocity.y, 2.0, 1e-12);
  EXPECT_NEAR(low.velocity.z, std::sin(0.3) * 1 + std::cos(0.3) * 3, 1e-12);
  EXPECT_NEAR(low.rates.y, 0.2, 1e-12);
  EXPECT_EQ(alula::turbulence_in_body(gust, R, v, 700.0).velocity.x, 1.0);
  const auto middle = alula::turbulence_in_body(gust, R, v, 1500 * 0.3048);
  EXPECT_NEAR(middle.velocity.x, 0.5 * (low.velocity.x + 1.0), 1e-12);
}

TEST(Dryden, RefreshesOnlyWhereItMatters) {
  const alula::Dryden<double> d{10.0, 15.0, 2.0};
  auto f = alula::dryden_filter(d, 50.0, 100.0, 0.01);
  alula::dryden_refresh(d, 50.1, 100.2, 0.01, f);
  EXPECT_EQ(f.V, 50.0);
  alula::dryden_refresh(d, 50.4, 100.2, 0.01, f);
  EXPECT_EQ(f.V, 50.4);
  alula::dryden_refresh(d, 50.4, 101.0, 0.01, f);
  EXPECT_EQ(f.height, 101.0);
  alula::dryden_refresh(d, 50.4, 101.0, 0.02, f);
  EXPECT_EQ(f.dt, 0.02);
}

TEST(Dryden, SinglePrecisionIsAsGoodAsItIs) {
  const alula::Dryden<float> d{8.65f, 7.7f, 0.0f};
  const auto f = alula::dryden_filter(d, 50.0f, 60.0f, 0.01f);
  const auto g = alula::dryden_filter(alula::Dryden<double>{8.65, 7.7, 0.0}, 50.0, 60.0, 0.01);
  EXPECT_NEAR(f.decay_u, g.decay_u, 1e-6);
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned j = 0; j <= i; ++j) {
      EXPECT_NEAR(f.transition_v[i][j], g.transition_v[i][j], 1e-6);
      // The smallest part of the covariance, the third column, is lost first: a few 1e-4 of one.
      EXPECT_NEAR(f.drive_v[i][j], g.drive_v[i][j], 1e-3);
    }
}

}  // namespace
