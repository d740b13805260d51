// Factor of a covariance: products come back, equations are solved, hopeless pivots are raised.
#include <gtest/gtest.h>

#include <alula/math/cholesky.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>

namespace {

constexpr int R = alula::kLongRow;

template <class T>
struct Matrix {
  alignas(64) T m[R][R] = {};
};

// B'B + 0.1 I of random B, with rows and columns scaled over `decades`.
template <class T>
Matrix<T> random_covariance(int n, double decades, std::mt19937& random) {
  std::normal_distribution<double> normal;
  double b[R][R], size[R];
  for (int i = 0; i < n; ++i) {
    size[i] = std::pow(10.0, decades * (i % 5) / 4.0 - decades / 2);
    for (int j = 0; j < n; ++j) b[i][j] = normal(random);
  }
  Matrix<T> a;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      double s = i == j ? 0.1 : 0.0;
      for (int k = 0; k < n; ++k) s += b[k][i] * b[k][j];
      a.m[i][j] = static_cast<T>(s * size[i] * size[j]);
    }
  return a;
}

template <class T>
class Cholesky : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(Cholesky, Scalars);

TYPED_TEST(Cholesky, FactorTimesItselfComesBackAndSolves) {
  using T = TypeParam;
  const double eps = std::numeric_limits<T>::epsilon();
  std::mt19937 random(6);
  for (int n = 1; n <= alula::kMaxStates; ++n)
    for (const double decades : {0.0, 8.0}) {
      const auto a = random_covariance<T>(n, decades, random);
      Matrix<T> u, back;
      ASSERT_EQ(alula::cholesky<R>(a.m, u.m, n), 0);
      alula::multiply_back<R>(u.m, back.m, n);
      double x[R], residual = 0;
      T b[R] = {};
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          if (j < i) { EXPECT_EQ(u.m[i][j], T(0)); }
          // Rounding of n products, relative to the diagonal (Higham 2002, Theorem 10.3).
          const double size = std::sqrt(double(a.m[i][i]) * double(a.m[j][j]));
          EXPECT_NEAR(back.m[i][j], a.m[i][j], 2 * (n + 1) * eps * size);
        }
        x[i] = (i % 3 - 1.0) / std::sqrt(double(a.m[i][i]));
      }
      for (int i = 0; i < n; ++i) {
        double s = 0;
        for (int j = 0; j < n; ++j) s += double(a.m[i][j]) * x[j];
        b[i] = static_cast<T>(s);
      }
      alula::solve<R>(u.m, b, n);
      for (int i = 0; i < n; ++i)
        residual = std::max(residual, std::abs(b[i] - x[i]) * std::sqrt(double(a.m[i][i])));
      // The scaled matrix has a condition below about 1e4 (0.1 on the diagonal of B'B).
      EXPECT_LT(residual, 1e4 * n * eps) << n;
    }
}

TYPED_TEST(Cholesky, RaisesAPivotThatRoundingHasEaten) {
  using T = TypeParam;
  // The third row is the sum of the first two: rank 2.
  Matrix<T> a, u;
  const T rows[3][3] = {{4, 1, 5}, {1, 3, 4}, {5, 4, 9}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a.m[i][j] = rows[i][j];
  a.m[2][2] -= T(1e-5);  // and slightly indefinite
  EXPECT_EQ(alula::cholesky<R>(a.m, u.m, 3), 1);
  EXPECT_GT(u.m[2][2], T(0));
  Matrix<T> back, again;
  alula::multiply_back<R>(u.m, back.m, 3);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(back.m[i][j], a.m[i][j], 2e-5);  // what was taken off
  EXPECT_GE(alula::cholesky<R>(back.m, again.m, 3), 0);
}

TYPED_TEST(Cholesky, RefusesADiagonalThatIsNoVariance) {
  using T = TypeParam;
  for (const T bad :
       {T(0), T(-1), std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity()}) {
    Matrix<T> a, u;
    for (int i = 0; i < 3; ++i) a.m[i][i] = T(1);
    a.m[1][1] = bad;
    EXPECT_EQ(alula::cholesky<R>(a.m, u.m, 3), -1) << bad;
  }
}

}  // namespace
