// Dual numbers: slopes against closed forms and, for compositions, against central differences.
#include <gtest/gtest.h>

#include <alula/math/dual.hpp>
#include <cmath>
#include <random>

namespace {

using alula::Dual;

// Every width: whole registers of four (4, 8, 12) and plain numbers (1, 3).
template <class N>
class DualNumbers : public testing::Test {};
template <int N>
struct Width {
  static constexpr int value = N;
};
using Widths = testing::Types<Width<1>, Width<3>, Width<4>, Width<8>, Width<12>>;
TYPED_TEST_SUITE(DualNumbers, Widths);

// A relative tolerance of a few roundings; the closed forms are computed in another order.
constexpr double kRounding = 8 * 2.3e-16;

template <class D>
void expect_slope(const D& y, double value, double slope, int direction, int n) {
  EXPECT_NEAR(y.value, value, kRounding * (1 + std::abs(value)));
  for (int j = 0; j < n; ++j)
    EXPECT_NEAR(y.slope_of(j), j == direction ? slope : 0.0, kRounding * (1 + std::abs(slope)));
}

TYPED_TEST(DualNumbers, FunctionsOfOneVariableHaveTheirClosedFormSlopes) {
  constexpr int n = TypeParam::value;
  using D = Dual<double, n>;
  for (const double a : {-0.93, -0.2, -1e-8, 1e-8, 0.3, 0.77}) {
    const int k = n - 1;
    const D x = D::variable(a, k);
    const double b = std::abs(a);
    const D y = D::variable(b, k);
    expect_slope(sin(x), std::sin(a), std::cos(a), k, n);
    expect_slope(cos(x), std::cos(a), -std::sin(a), k, n);
    expect_slope(exp(x), std::exp(a), std::exp(a), k, n);
    expect_slope(log(y), std::log(b), 1 / b, k, n);
    expect_slope(sqrt(y), std::sqrt(b), 0.5 / std::sqrt(b), k, n);
    expect_slope(asin(x), std::asin(a), 1 / std::sqrt(1 - a * a), k, n);
    expect_slope(-x, -a, -1, k, n);
    expect_slope(1.0 / x, 1 / a, -1 / (a * a), k, n);
    expect_slope(x / 2.0, a / 2, 0.5, k, n);
    expect_slope(2.0 - x, 2 - a, -1, k, n);
    expect_slope(x - 2.0, a - 2, 1, k, n);
    expect_slope(2.0 + x, 2 + a, 1, k, n);
    expect_slope(3.0 * x + 1.0, 3 * a + 1, 3, k, n);
    expect_slope(x * x * x, a * a * a, 3 * a * a, k, n);
    D s, c;
    sincos(x, s, c);
    expect_slope(s, std::sin(a), std::cos(a), k, n);
    expect_slope(c, std::cos(a), -std::sin(a), k, n);
    D z = x;
    z += x;
    z -= D(0.5);
    z *= x;
    expect_slope(z, (2 * a - 0.5) * a, 4 * a - 0.5, k, n);
  }
}

TYPED_TEST(DualNumbers, ArctangentHasItsSlopesInEveryQuadrant) {
  constexpr int n = TypeParam::value;
  using D = Dual<double, n>;
  for (double angle = -3.1; angle < 3.14; angle += 0.31) {
    const double x = 2 * std::cos(angle), y = 2 * std::sin(angle);
    expect_slope(atan2(D::variable(y, 0), D(x)), angle, x / 4, 0, n);
    expect_slope(atan2(D(y), D::variable(x, 0)), angle, -y / 4, 0, n);
  }
}

TEST(Dual, ComparesByValue) {
  const auto x = Dual<double, 4>::variable(1.0, 0), y = Dual<double, 4>::variable(2.0, 1);
  EXPECT_TRUE(x < y);
  EXPECT_TRUE(y > x);
  EXPECT_FALSE(x > y);
  EXPECT_EQ(alula::value_of(y), 2.0);
}

// A function that uses everything, of four variables.
template <class S>
S everything(const S* x) {
  S s, c;
  sincos(x[0] * x[1], s, c);
  const S root = sqrt(x[2] * x[2] + x[3] * x[3] + S(1.0));
  return exp(s / root) * atan2(x[2] - c, x[3] + S(2.0)) + log(root) * asin(S(0.3) * s) -
         x[1] / root;
}

// Plain numbers under the same names.
struct Plain {
  double v;
  Plain(double x = 0) : v(x) {}
  friend Plain operator+(Plain a, Plain b) { return a.v + b.v; }
  friend Plain operator-(Plain a, Plain b) { return a.v - b.v; }
  friend Plain operator*(Plain a, Plain b) { return a.v * b.v; }
  friend Plain operator/(Plain a, Plain b) { return a.v / b.v; }
  friend Plain sqrt(Plain a) { return std::sqrt(a.v); }
  friend Plain exp(Plain a) { return std::exp(a.v); }
  friend Plain log(Plain a) { return std::log(a.v); }
  friend Plain asin(Plain a) { return std::asin(a.v); }
  friend Plain atan2(Plain a, Plain b) { return std::atan2(a.v, b.v); }
  friend void sincos(Plain a, Plain& s, Plain& c) {
    s = std::sin(a.v);
    c = std::cos(a.v);
  }
};

TEST(Dual, CompositionsAgreeWithCentralDifferences) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.5, 1.5);
  for (int trial = 0; trial < 200; ++trial) {
    double at[4];
    Dual<double, 4> x[4];
    for (int i = 0; i < 4; ++i) {
      at[i] = unit(random);
      x[i] = Dual<double, 4>::variable(at[i], i);
    }
    const auto y = everything(x);
    for (int i = 0; i < 4; ++i) {
      const double h = 1e-5;
      Plain up[4], down[4];
      for (int j = 0; j < 4; ++j) {
        up[j] = at[j] + (i == j ? h : 0);
        down[j] = at[j] - (i == j ? h : 0);
      }
      const double difference = (everything(up).v - everything(down).v) / (2 * h);
      // Truncation h^2/6 times a third derivative of up to about 30; rounding 1e-16/h.
      EXPECT_NEAR(y.slope_of(i), difference, 3e-9 * (1 + std::abs(difference)));
    }
  }
}

}  // namespace
