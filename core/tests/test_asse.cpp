// Angles without vanes: closed forms of the affine transition, the three schemes on a made motion,
// bad input, allocations.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "allocations.hpp"
#include "alula/airdata/asse_filter.hpp"
#include "alula/airdata/asse_solve.hpp"
#include "alula/airdata/asse_zero_order.hpp"

namespace {

using alula::Vec3;

// A motion whose velocity is known: V, alpha, beta and rates are given functions of time, and the
// acceleration follows as a = v' + w x v.
template <class T>
struct Motion {
  Vec3<double> v, a, w;
  double V, alpha, beta;

  explicit Motion(double t) {
    V = 35.0 + 4.0 * std::sin(0.7 * t);
    alpha = 0.08 + 0.06 * std::sin(0.9 * t + 0.3);
    beta = 0.10 * std::sin(1.3 * t);
    const double dV = 2.8 * std::cos(0.7 * t), da = 0.054 * std::cos(0.9 * t + 0.3),
                 db = 0.13 * std::cos(1.3 * t);
    w = {0.2 * std::sin(1.1 * t), 0.15 * std::cos(0.8 * t), 0.1 * std::sin(0.5 * t + 1.0)};
    const auto b = alula::flow_basis(alpha, beta);
    v = V * b.along;
    a = dV * b.along + (V * b.cos_beta * da) * b.by_alpha + (V * db) * b.by_beta +
        alula::cross(w, v);
  }
  alula::AsseInput<T> input(double t) const {
    const auto cast = [](const Vec3<double>& x) {
      return Vec3<T>{static_cast<T>(x.x), static_cast<T>(x.y), static_cast<T>(x.z)};
    };
    const Vec3<double> gravity{0.0, 0.0, 9.8};
    return {t, cast(a - gravity), cast(w), cast(gravity), {}};
  }
};

template <class T>
alula::AsseSettings<T> exact_settings() {
  alula::AsseSettings<T> s;
  const bool whole = sizeof(T) == 8;
  s.sigma_V = whole ? T(1e-5) : T(1e-2);
  s.sigma_tilt = s.sigma_w = whole ? T(1e-8) : T(1e-4);
  s.sigma_a = whole ? T(1e-7) : T(1e-3);
  s.density_a = s.density_w = T(0);
  s.block = T(0);
  return s;
}

TEST(AsseTrack, ConstantTurnIsTheMatrixExponential) {
  // Constant rates and acceleration: v(t) = E v0 + (integral of E) a with E the rotation by -w t,
  // both in closed form by Rodrigues' formula.
  const Vec3<double> w{0.3, -0.2, 0.5}, a{1.0, -2.0, 4.0}, v0{30.0, 2.0, 3.0};
  const double t = 2.0, n = std::sqrt(alula::dot(w, w));
  alula::AsseTrack<double> track;
  alula::start(track, 0.0, a, w);
  for (int i = 1; i <= 200; ++i) alula::advance(track, 0.01 * i, a, w);
  const auto E = alula::rotation((-t) * w);
  const auto wa = alula::cross(w, a), wwa = alula::cross(w, wa);
  const Vec3<double> gained = t * a - ((1.0 - std::cos(n * t)) / (n * n)) * wa +
                              ((n * t - std::sin(n * t)) / (n * n * n)) * wwa;
  const Vec3<double> v = E * v0 + gained;
  alula::TrackPoint<double> p;
  ASSERT_TRUE(alula::find(track, 1.5, p));
  const auto back = alula::shift(track, p);
  EXPECT_NEAR(back.lag, 0.5, 1e-12);
  // Half a second back, seen from the body axes of now: exp(-w 0.5) v(1.5) = v + c.
  const double s = 1.5;
  const Vec3<double> gained_s = s * a - ((1.0 - std::cos(n * s)) / (n * n)) * wa +
                                ((n * s - std::sin(n * s)) / (n * n * n)) * wwa;
  const Vec3<double> then = alula::rotation((-s) * w) * v0 + gained_s;
  const Vec3<double> seen = alula::rotation(-0.5 * w) * then;
  // 1e-8: Simpson's rule over steps of 0.01 s at rates of 0.6 rad/s.
  EXPECT_NEAR(seen.x, (v + back.c).x, 1e-8);
  EXPECT_NEAR(seen.y, (v + back.c).y, 1e-8);
  EXPECT_NEAR(seen.z, (v + back.c).z, 1e-8);
}

TEST(AsseTrack, PureRotationShiftsNothing) {
  alula::AsseTrack<double> track;
  const Vec3<double> none{}, w{0.4, 0.7, -0.9};
  alula::start(track, 0.0, none, w);
  for (int i = 1; i <= 50; ++i) alula::advance(track, 0.02 * i, none, w);
  alula::TrackPoint<double> p;
  ASSERT_TRUE(alula::find(track, 0.3, p));
  const auto back = alula::shift(track, p);
  EXPECT_EQ(back.c.x, 0.0);
  EXPECT_EQ(back.c.y, 0.0);
  EXPECT_EQ(back.c.z, 0.0);
  const auto E = alula::rotation(track.here.t * w);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(track.turned.row[i].x, E.row[i].x, 1e-13);
}

TEST(AsseTrack, ChangingRatesToSecondOrder) {
  // Rates and acceleration change; the shift is what the known velocity says. Error by step.
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const int steps = k == 0 ? 30 : 60;
    alula::AsseTrack<double> track;
    const Motion<double> first(0.0);
    alula::start(track, 0.0, first.a, first.w);
    const double h = 1.0 / steps;
    for (int i = 1; i <= steps; ++i) {
      const Motion<double> m(i * h);
      alula::advance(track, i * h, m.a, m.w);
    }
    const auto back = alula::shift(track, track.past[0]);
    const Vec3<double> v0 = first.v, v1 = Motion<double>(1.0).v + back.c;
    error[k] = std::fabs(alula::dot(v1, v1) - alula::dot(v0, v0)) / 35.0;
  }
  // Lines between samples leave an error of the second order.
  EXPECT_LT(error[0], 2e-3);
  EXPECT_LT(error[1], 0.27 * error[0]);
}

TEST(AsseTrack, FarFromItsOriginIsTheSame) {
  alula::AsseTrack<double> one, other;
  const Motion<double> first(0.0);
  alula::start(one, 0.0, first.a, first.w);
  alula::start(other, 0.0, first.a, first.w);
  for (int i = 1; i <= 60; ++i) {
    const Motion<double> m(0.01 * i);
    alula::advance(one, 0.01 * i, m.a, m.w);
    alula::advance(other, 0.01 * i, m.a, m.w);
    if (i % 7 == 0) alula::put_origin_here(other);
  }
  alula::TrackPoint<double> p, q;
  ASSERT_TRUE(alula::find(one, 0.123, p));
  ASSERT_TRUE(alula::find(other, 0.123, q));
  const auto a = alula::shift(one, p), b = alula::shift(other, q);
  EXPECT_NEAR(a.c.x, b.c.x, 1e-12);
  EXPECT_NEAR(a.c.z, b.c.z, 1e-12);
  EXPECT_FALSE(alula::find(one, 0.7, p));    // not yet
  EXPECT_FALSE(alula::find(one, -0.05, p));  // no more
}

template <class T>
class Asse : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Asse, Scalars);

TYPED_TEST(Asse, WindowIsExactAtAnyLength) {
  using T = TypeParam;
  alula::AsseWindow<T> f;
  f.settings = exact_settings<T>();
  f.settings.first_alpha = T(0.1);
  for (int i = 0; i <= 3000; ++i) {
    const double t = 0.001 * i;
    const Motion<T> m(t);
    ASSERT_TRUE(alula::advance(f, m.input(t)));
    if (i % 100 == 0) { ASSERT_TRUE(alula::add_airspeed(f, t, static_cast<T>(m.V))); }
  }
  const auto e = alula::solve(f);
  const Motion<T> m(3.0);
  ASSERT_TRUE(e.observable_alpha && e.observable_beta);
  EXPECT_EQ(e.samples, 20);
  // Lines between samples of 1 ms: 1e-6 rad; single precision sums 3000 steps of 1e-7 of 40 m/s.
  const double tolerance = sizeof(T) == 8 ? 2e-6 : 3e-3;
  EXPECT_NEAR(static_cast<double>(e.alpha), m.alpha, tolerance);
  EXPECT_NEAR(static_cast<double>(e.beta), m.beta, tolerance);
}

TYPED_TEST(Asse, FilterFindsTheAnglesAndCarriesThem) {
  using T = TypeParam;
  alula::AsseFilter<T> f;
  f.settings.first_alpha = T(0.15);  // true: 0.098
  f.settings.first_beta = T(-0.04);
  alula::start(f);
  double last = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.01 * i;
    const Motion<T> m(t);
    ASSERT_TRUE(alula::advance(f, m.input(t)));
    ASSERT_TRUE(alula::add_airspeed(f, t, static_cast<T>(m.V)));
    last = t;
  }
  const Motion<T> m(last);
  // Exact inputs; the filter allows for sensor errors and ends within what it claims.
  EXPECT_TRUE(f.reported_alpha.observable);
  EXPECT_NEAR(static_cast<double>(f.alpha), m.alpha, 2.0 * std::sqrt(double(f.P[1][1])));
  EXPECT_NEAR(static_cast<double>(f.alpha), m.alpha, 0.01);
  EXPECT_NEAR(static_cast<double>(f.beta), m.beta, 0.01);
  // From here level flight: the variance grows, the angle stays, in the end it is not observable.
  const double before = static_cast<double>(f.P[1][1]);
  const T V = f.V, alpha = f.alpha, beta = f.beta;
  const auto b = alula::flow_basis(alpha, beta);
  double t = last;
  T variance = f.P[1][1];
  bool grows = true, lost = false;
  for (int i = 0; i < 6000; ++i) {
    t += 0.01;
    alula::AsseInput<T> u{t, {T(0), T(0), T(-9.8)}, {}, {T(0), T(0), T(9.8)}, {}};
    ASSERT_TRUE(alula::advance(f, u));
    alula::add_airspeed(f, t, V);
    if (i % 500 == 499) {
      grows &= f.P[1][1] > variance || !(f.P[1][1] < T(8.9) * T(0.09 * 0.09));
      variance = f.P[1][1];
    }
    lost |= !f.reported_alpha.observable;
  }
  EXPECT_TRUE(grows);
  EXPECT_TRUE(lost);
  EXPECT_GT(f.reported_alpha.age, T(10));
  EXPECT_GT(static_cast<double>(f.P[1][1]), 4.0 * before);
  EXPECT_NEAR(static_cast<double>(b.along.x), std::cos(double(alpha)) * std::cos(double(beta)),
              1e-6);
}

TEST(Asse, FilterCovarianceMovesAsItsState) {
  // One step with a variance along one state at a time, against differences of the step itself.
  const double size[] = {1e-2, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3, 1e-4, 1e-4, 1e-4};
  const auto after = [](int state, double change, bool with_P, double P[3][3]) {
    alula::AsseFilter<double> f;
    f.settings = exact_settings<double>();
    alula::start(f);
    for (auto& row : f.P)
      for (double& p : row) p = 0.0;
    f.V = 30.0;
    f.alpha = 0.3;
    f.beta = -0.2;
    double* x[] = {&f.V,         &f.alpha,     &f.beta,      &f.tilt.x,
                   &f.tilt.y,    &f.tilt.z,    &f.error_a.x, &f.error_a.y,
                   &f.error_a.z, &f.error_w.x, &f.error_w.y, &f.error_w.z};
    *x[state] += with_P ? 0.0 : change;
    if (with_P) f.P[state][state] = change * change;
    f.settings.sigma_tilt = 0.0;
    f.settings.tilt_time = 1e9;
    // A long step, in which the airspeed changes by a fifth.
    alula::asse_detail::propagate(f, 0.2, Vec3<double>{-30.0, 2.0, 1.0},
                                  Vec3<double>{-3.0, 1.0, 9.0}, Vec3<double>{0.2, 0.3, -0.1});
    for (int i = 0; with_P && i < 3; ++i)
      for (int j = 0; j < 3; ++j) P[i][j] = f.P[i][j];
    return Vec3<double>{f.V, f.alpha, f.beta};
  };
  for (int state = 0; state < 12; ++state) {
    const double h = size[state];
    double P[3][3];
    after(state, h, true, P);
    const auto up = after(state, h, false, P), down = after(state, -h, false, P);
    const double d[] = {0.5 * (up.x - down.x), 0.5 * (up.y - down.y), 0.5 * (up.z - down.z)};
    const double of[] = {d[0] / h, d[1] / h, d[2] / h};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        // 3 %: 0.06 rad turned in the step, half of it between an error's middle and its end.
        EXPECT_NEAR(P[i][j] / (h * h), of[i] * of[j],
                    0.03 * (1.0 + std::fabs(of[i])) * (1.0 + std::fabs(of[j])))
            << state << i << j;
  }
}

TEST(Asse, FilterTakesLateAirspeedsExactly) {
  // The same airspeeds a quarter of a second late, known as such: the same angles.
  double found[2];
  for (const int late : {0, 25}) {
    alula::AsseFilter<double> f;
    f.settings = exact_settings<double>();
    f.settings.sigma_V = 1e-3;
    f.settings.delay = 0.01 * late;
    f.settings.first_alpha = 0.098;
    alula::start(f);
    for (int i = 0; i <= 800; ++i) {
      const double t = 0.01 * i;
      ASSERT_TRUE(alula::advance(f, Motion<double>(t).input(t)));
      if (i >= late) alula::add_airspeed(f, t, Motion<double>(t - 0.01 * late).V);
    }
    EXPECT_EQ(f.rejected.outlying, 0);
    found[late ? 1 : 0] = f.alpha;
  }
  EXPECT_NEAR(found[0], Motion<double>(8.0).alpha, 1e-3);
  EXPECT_NEAR(found[1], found[0], 5e-4);
}

template <class T>
alula::ZeroOrderSample<T> zero_order_sample(double t, double tau) {
  const Motion<T> m(tau);
  const double h = 1e-5;
  const int steps = 200;
  Vec3<double> gained{};
  for (int i = 0; i < steps; ++i)
    gained = gained + ((t - tau) / steps) * Motion<T>(tau + (i + 0.5) / steps * (t - tau)).a;
  const auto cast = [](const Vec3<double>& x) {
    return Vec3<T>{static_cast<T>(x.x), static_cast<T>(x.y), static_cast<T>(x.z)};
  };
  const double slope = (Motion<T>(tau + h).V - Motion<T>(tau - h).V) / (2.0 * h);
  return {static_cast<T>(t - tau),
          static_cast<T>(m.V),
          static_cast<T>(slope),
          cast(m.a),
          cast(gained),
          cast(m.w)};
}

TYPED_TEST(Asse, ZeroOrderErrorIsTheOneItExpects) {
  using T = TypeParam;
  // Backward, forward, uneven; 2 to 4 equations: errors of the size the existence number says.
  const double spacings[][3] = {{0.01, 0, 0}, {-0.01, 0, 0}, {0.01, 0.025, 0}, {0.01, 0.02, 0.035}};
  const int counts[] = {2, 2, 3, 4};
  for (int k = 0; k < 4; ++k) {
    int taken = 0;
    for (const double t : {0.5, 1.1, 1.7, 2.6, 3.3}) {
      alula::ZeroOrderSample<T> s[4];
      s[0] = zero_order_sample<T>(t, t);
      for (int i = 1; i < counts[k]; ++i) s[i] = zero_order_sample<T>(t, t - spacings[k][i - 1]);
      alula::ZeroOrderSettings<T> settings;
      settings.equation_error = sizeof(T) == 4 ? T(2e-5) : T(1e-9);
      const Motion<T> m(t);
      const auto e = alula::zero_order(s, counts[k], static_cast<T>(m.alpha + 0.02),
                                       static_cast<T>(m.beta - 0.02), settings);
      if (!e.converged || !(e.existence_beta > T(50)) || !(e.existence_alpha > T(50))) continue;
      ++taken;
      EXPECT_LT(std::fabs(double(e.alpha) - m.alpha), 2.0 / double(e.existence_alpha)) << k << t;
      EXPECT_LT(std::fabs(double(e.beta) - m.beta), 2.0 / double(e.existence_beta)) << k << t;
    }
    EXPECT_GE(taken, 2) << k;
  }
}

TYPED_TEST(Asse, TrimIsNotObservable) {
  using T = TypeParam;
  alula::ZeroOrderScheme<T> scheme;
  alula::ZeroOrderSample<T> s[2]{};
  s[0].V = s[1].V = T(35);
  s[1].lag = T(0.01);
  alula::ZeroOrderSolution<T> e;
  ASSERT_TRUE(alula::update(scheme, 0.0, s, 2, e));
  EXPECT_EQ(e.existence_alpha, T(0));
  EXPECT_FALSE(scheme.alpha.observable);
  ASSERT_TRUE(alula::update(scheme, 0.5, s, 2, e));
  EXPECT_NEAR(static_cast<double>(scheme.alpha.age), 0.5, 1e-6);

  alula::AsseWindow<T> f;
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.01 * i;
    ASSERT_TRUE(alula::advance(
        f, alula::AsseInput<T>{t, {T(0.5), T(0), T(-9.79)}, {}, {T(-0.5), T(0), T(9.79)}, {}}));
    ASSERT_TRUE(alula::add_airspeed(f, t, T(35)));
    const auto w = alula::solve(f);
    ASSERT_FALSE(w.observable_alpha || w.observable_beta) << t;
  }
  EXPECT_EQ(f.count, 20);
}

TYPED_TEST(Asse, BadInputIsCountedAndChangesNothing) {
  using T = TypeParam;
  const T nan = static_cast<T>(std::nan(""));
  alula::AsseFilter<T> f;
  alula::start(f);
  alula::AsseWindow<T> w;
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.01 * i;
    const Motion<T> m(t);
    alula::advance(f, m.input(t));
    alula::advance(w, m.input(t));
    alula::add_airspeed(f, t, static_cast<T>(m.V));
    alula::add_airspeed(w, t, static_cast<T>(m.V));
  }
  const auto P = f.P[1][1];
  const auto alpha = f.alpha, V = f.V;
  const int count = w.count;
  auto bad = Motion<T>(2.01).input(2.01);
  bad.w.y = nan;
  EXPECT_FALSE(alula::advance(f, bad));
  EXPECT_FALSE(alula::advance(w, bad));
  const auto before = Motion<T>(1.5).input(1.5);
  EXPECT_FALSE(alula::advance(f, before));
  EXPECT_FALSE(alula::advance(w, before));
  EXPECT_FALSE(alula::add_airspeed(f, 2.0, nan));
  EXPECT_FALSE(alula::add_airspeed(f, 2.0 + 1e-9, T(0)));
  EXPECT_FALSE(alula::add_airspeed(w, 2.0 + 1e-9, T(0)));
  EXPECT_FALSE(alula::add_airspeed(f, 1.0, T(35)));
  EXPECT_FALSE(alula::add_airspeed(f, 2.0 + 1e-9, T(200)));
  EXPECT_FALSE(alula::add_alpha(f, nan, T(0.01)));
  EXPECT_EQ(f.rejected.not_finite, 3);
  EXPECT_EQ(f.rejected.backward, 2);
  EXPECT_EQ(f.rejected.slow, 1);
  EXPECT_EQ(f.rejected.outlying, 1);
  EXPECT_EQ(w.rejected.not_finite, 1);
  EXPECT_EQ(w.rejected.backward, 1);
  EXPECT_EQ(w.rejected.slow, 1);
  EXPECT_EQ(f.P[1][1], P);
  EXPECT_EQ(f.alpha, alpha);
  EXPECT_EQ(f.V, V);
  EXPECT_EQ(w.count, count);
  // Ten seconds of nothing: both start over and say so.
  EXPECT_TRUE(alula::advance(f, Motion<T>(12.0).input(12.0)));
  EXPECT_TRUE(alula::advance(w, Motion<T>(12.0).input(12.0)));
  EXPECT_EQ(f.rejected.gaps, 1);
  EXPECT_EQ(w.rejected.gaps, 1);
  EXPECT_EQ(w.count, 0);
  EXPECT_FALSE(f.reported_alpha.observable);
  EXPECT_GE(f.reported_alpha.age, T(9.9));
  EXPECT_NEAR(static_cast<double>(f.P[1][1]), 0.0081, 1e-6);
}

TYPED_TEST(Asse, AllocatesNothing) {
  using T = TypeParam;
  static alula::AsseFilter<T> f;
  static alula::AsseWindow<T> w;
  long before = alula_test::allocations();
  {
    std::vector<double> control(10);
    EXPECT_GT(alula_test::allocations(), before);
  }
  before = alula_test::allocations();
  alula::start(f);
  T sum = T(0);
  for (int i = 0; i <= 500; ++i) {
    const double t = 0.01 * i;
    const Motion<T> m(t);
    alula::advance(f, m.input(t));
    alula::advance(w, m.input(t));
    alula::add_airspeed(f, t, static_cast<T>(m.V));
    alula::add_airspeed(w, t, static_cast<T>(m.V));
    sum += alula::solve(w).V + f.V;
  }
  alula::ZeroOrderSample<T> s[2] = {zero_order_sample<T>(1.0, 1.0),
                                    zero_order_sample<T>(1.0, 0.98)};
  sum += alula::zero_order(s, 2, T(0.1), T(0)).alpha;
  EXPECT_EQ(alula_test::allocations(), before);
  EXPECT_TRUE(std::isfinite(sum));
}

TEST(Asse, WindowCovarianceIsTheScatter) {
  // Noise on the airspeed alone, known sensors: the scatter of 400 solutions is the covariance.
  auto settings = exact_settings<double>();
  settings.sigma_V = 0.05;
  settings.first_alpha = 0.1;
  settings.limit = 1.0;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  double sum = 0.0, sum_b = 0.0, P = 0.0, Pb = 0.0;
  const int runs = 400;
  for (int run = 0; run < runs; ++run) {
    alula::AsseWindow<double> f;
    f.settings = settings;
    for (int i = 0; i <= 400; ++i) {
      const double t = 0.01 * i;
      const Motion<double> m(t);
      alula::advance(f, m.input(t));
      if (i % 20 == 0) alula::add_airspeed(f, t, m.V + 0.05 * normal(random));
    }
    const auto e = alula::solve(f);
    const Motion<double> m(4.0);
    sum += (e.alpha - m.alpha) * (e.alpha - m.alpha) / runs;
    sum_b += (e.beta - m.beta) * (e.beta - m.beta) / runs;
    P += e.P[1][1] / runs;
    Pb += e.P[2][2] / runs;
  }
  // The variance of 400 draws is known to 7 %: three of them.
  EXPECT_NEAR(sum / P, 1.0, 0.21);
  EXPECT_NEAR(sum_b / Pb, 1.0, 0.21);
}

}  // namespace
