// Functions of lanes: the errors stated in lanes.hpp, over special and random
// arguments, against the mathematics library in a longer type.
#include <gtest/gtest.h>

#include <alula/math/lanes.hpp>
#include <alula/math/near.hpp>
#include <alula/math/rows.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

namespace {

using alula::Lanes;

template <class T>
constexpr bool kDouble = std::is_same_v<T, double>;

template <class T>
class LaneMathematics : public testing::Test {};
using Scalars = testing::Types<double, float>;
TYPED_TEST_SUITE(LaneMathematics, Scalars);

// Multiples of pi/4 and what lies beside them, tiny, huge and random numbers.
template <class T>
std::vector<T> angles(T largest) {
  std::vector<T> x = {T(0), -T(0), std::numeric_limits<T>::denorm_min(), T(1e-30), T(1e-8)};
  for (int k = -200; k <= 200; ++k) {
    const T a = static_cast<T>(k * 0.78539816339744830962L);
    for (const T b : {a, std::nextafter(a, T(1e6)), std::nextafter(a, T(-1e6))}) x.push_back(b);
  }
  std::mt19937 random(4);
  for (const double size : {1e-3, 1.0, 4.0, 100.0, static_cast<double>(largest)}) {
    std::uniform_real_distribution<double> draw(-size, size);
    for (int i = 0; i < 200000; ++i) x.push_back(static_cast<T>(draw(random)));
  }
  while (x.size() % 4) x.push_back(T(1));
  return x;
}

TYPED_TEST(LaneMathematics, SineAndCosineKeepTheStatedError) {
  using T = TypeParam;
  using L = Lanes<T, 4>;
  const auto x = angles<T>(kDouble<T> ? T(1e5) : T(1e3));
  const long double bound = kDouble<T> ? 2e-16L : 1.2e-7L;  // as stated in lanes.hpp
  long double worst = 0;
  for (std::size_t i = 0; i < x.size(); i += 4) {
    L s, c;
    sincos(L::load(&x[i]), s, c);
    for (int j = 0; j < 4; ++j) {
      const long double a = x[i + j];
      worst = std::max({worst, std::abs(s[j] - std::sin(a)), std::abs(c[j] - std::cos(a))});
    }
  }
  EXPECT_LT(worst, bound);
  EXPECT_GT(worst, 0);  // the comparison compares
}

// From inside the series' range, from beyond it, and from lanes of both kinds.
TYPED_TEST(LaneMathematics, SineAndCosineNearAKnownAngle) {
  using T = TypeParam;
  using L = Lanes<T, 4>;
  const long double bound = 4 * std::numeric_limits<T>::epsilon();  // known angle, products, sum
  std::mt19937 random(6);
  std::uniform_real_distribution<double> angle(-3, 3), step(-1, 1);
  long double worst = 0;
  for (const double size : {0.0, 1e-9, 1e-3, 1.0 / 32, 0.05, 2.0})
    for (int i = 0; i < 20000; ++i) {
      const L x = L::from([&](int) { return static_cast<T>(angle(random)); });
      const L d = L::from([&](int) { return static_cast<T>(size * step(random)); });
      L sine, cosine, s, c;
      sincos(x, sine, cosine);
      alula::sincos_near(sine, cosine, x, d, s, c);
      T one_s, one_c;
      alula::sincos_near(sine[0], cosine[0], x[0], d[0], one_s, one_c);
      for (int j = 0; j < 4; ++j) {
        const long double a = static_cast<long double>(x[j]) + d[j];
        // Beyond the range x + d is rounded before its sine is taken.
        const long double rounding = std::abs(a) * std::numeric_limits<T>::epsilon() / 2;
        worst = std::max({worst, std::abs(s[j] - std::sin(a)) - rounding,
                          std::abs(c[j] - std::cos(a)) - rounding});
        if (j == 0) {
          worst = std::max({worst, std::abs(one_s - std::sin(a)) - rounding,
                            std::abs(one_c - std::cos(a)) - rounding});
        }
      }
    }
  EXPECT_LT(worst, bound);
  EXPECT_GT(worst, 0);
}

TYPED_TEST(LaneMathematics, ArctangentKeepsTheStatedError) {
  using T = TypeParam;
  using L = Lanes<T, 4>;
  std::vector<T> y, x;
  const T far = kDouble<T> ? T(1e150) : T(1e15);
  const T special[] = {T(0), T(1), T(-1),         T(1e-20),     T(-1e-20),
                       far,  -far, T(0.41421356), T(2.41421356)};
  for (const T a : special)
    for (const T b : special) {
      y.push_back(a);
      x.push_back(b);
    }
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const double ratio : {1e-6, 0.4142, 1.0, 100.0})
    for (int i = 0; i < 100000; ++i) {
      y.push_back(static_cast<T>(ratio * normal(random)));
      x.push_back(static_cast<T>(normal(random)));
    }
  while (x.size() % 4) {
    x.push_back(T(1));
    y.push_back(T(1));
  }
  const long double bound = kDouble<T> ? 5e-16L : 3e-7L;  // as stated in lanes.hpp
  long double worst = 0;
  for (std::size_t i = 0; i < x.size(); i += 4) {
    const L a = atan2(L::load(&y[i]), L::load(&x[i]));
    for (int j = 0; j < 4; ++j) {
      const long double exact =
          std::atan2(static_cast<long double>(y[i + j]), static_cast<long double>(x[i + j]));
      worst = std::max(worst, std::abs(a[j] - exact));
    }
  }
  EXPECT_LT(worst, bound);
  EXPECT_GT(worst, 0);
}

TYPED_TEST(LaneMathematics, ArctangentOfNothingIsZero) {
  using L = Lanes<TypeParam, 4>;
  const L a = atan2(L(TypeParam(0)), L(TypeParam(0)));
  for (int j = 0; j < 4; ++j) EXPECT_EQ(a[j], TypeParam(0));
}

TYPED_TEST(LaneMathematics, ExponentialKeepsTheStatedError) {
  using T = TypeParam;
  using L = Lanes<T, 4>;
  const T end = kDouble<T> ? T(708) : T(87);
  std::vector<T> x = {T(0), -T(0), T(1), T(-1), end, -end, T(1e-30), T(-1e-9)};
  std::mt19937 random(6);
  for (const double size : {1e-6, 0.34, 1.0, 30.0, static_cast<double>(end)}) {
    std::uniform_real_distribution<double> draw(-size, size);
    for (int i = 0; i < 100000; ++i) x.push_back(static_cast<T>(draw(random)));
  }
  const long double bound = kDouble<T> ? 3e-16L : 2e-7L;  // as stated in lanes.hpp
  long double worst = 0;
  for (std::size_t i = 0; i < x.size(); i += 4) {
    const L e = exp(L::load(&x[i]));
    for (int j = 0; j < 4; ++j) {
      const long double exact = std::exp(static_cast<long double>(x[i + j]));
      worst = std::max(worst, std::abs(e[j] - exact) / exact);
    }
  }
  EXPECT_LT(worst, bound);
  EXPECT_GT(worst, 0);
  const L beyond = exp(L(T(1e4))), held = exp(L(end));
  EXPECT_EQ(beyond[0], held[0]);
}

TYPED_TEST(LaneMathematics, LogarithmKeepsTheStatedError) {
  using T = TypeParam;
  using L = Lanes<T, 4>;
  using Limits = std::numeric_limits<T>;
  std::vector<T> x = {T(1),          T(0.5),        T(2),          Limits::min(),
                      Limits::max(), T(0.70710678), T(1.41421356), T(10)};
  std::mt19937 random(7);
  for (const double size : {1e-6, 0.3, 1.0, 30.0, kDouble<T> ? 700.0 : 80.0}) {
    std::uniform_real_distribution<double> draw(-size, size);
    for (int i = 0; i < 100000; ++i) x.push_back(static_cast<T>(std::exp(draw(random))));
  }
  const long double absolute = kDouble<T> ? 2e-16L : 1e-7L;  // as stated in lanes.hpp
  const long double relative = kDouble<T> ? 3e-16L : 1e-7L;
  long double worst = 0;
  for (std::size_t i = 0; i < x.size(); i += 4) {
    const L l = log(L::load(&x[i]));
    for (int j = 0; j < 4; ++j) {
      const long double exact = std::log(static_cast<long double>(x[i + j]));
      worst = std::max(worst, std::abs(l[j] - exact) / (absolute + relative * std::abs(exact)));
    }
  }
  EXPECT_LT(worst, 1);
  EXPECT_GT(worst, 0);
  const T none[] = {T(0), T(-1), Limits::infinity(), Limits::quiet_NaN()};
  const L l = log(L::load(none));
  for (int j = 0; j < 4; ++j) EXPECT_TRUE(std::isnan(l[j])) << j;
}

TYPED_TEST(LaneMathematics, MasksChooseLaneByLane) {
  using T = TypeParam;
  using L = Lanes<T, 4>;
  using alula::all;
  using alula::any;
  const T values[] = {T(-1), T(0), T(2), std::numeric_limits<T>::quiet_NaN()};
  const L x = L::load(values);
  EXPECT_TRUE(any(x < L(T(0))));
  EXPECT_FALSE(all(x < L(T(0))));
  EXPECT_FALSE(any(x > L(T(2))));
  EXPECT_TRUE(all((x == x) | (L(T(0)) == L(T(0)))));
  EXPECT_FALSE(all(x == x));  // not where there is no number
  EXPECT_TRUE(any((x >= L(T(0))) & (x > L(T(1)))));
  const L chosen = select(x >= L(T(0)), x, L(T(7)));
  const T expected[] = {T(7), T(0), T(2), T(7)};
  for (int j = 0; j < 4; ++j) EXPECT_EQ(chosen[j], expected[j]);
  const L counted = L::from([](int i) { return T(i * i); });
  for (int j = 0; j < 4; ++j) EXPECT_EQ(counted[j], T(j * j));
}

TYPED_TEST(LaneMathematics, ANumberThatIsNoneStaysInItsLane) {
  using T = TypeParam;
  using L = Lanes<T, 4>;
  L x(T(0.5)), s, c;
  x.set(2, std::numeric_limits<T>::quiet_NaN());
  sincos(x, s, c);
  const L a = atan2(x, L(T(1)));
  for (int j = 0; j < 4; ++j) {
    EXPECT_EQ(std::isnan(s[j]), j == 2);
    EXPECT_EQ(std::isnan(c[j]), j == 2);
    EXPECT_EQ(std::isnan(a[j]), j == 2);
  }
}

TYPED_TEST(LaneMathematics, ArithmeticIsThatOfItsLanes) {
  using T = TypeParam;
  using L = Lanes<T, 4>;
  const T a[] = {T(1.5), T(-2), T(0.25), T(9)}, b[] = {T(3), T(0.5), T(-4), T(2)};
  const L x = L::load(a), y = L::load(b);
  for (int j = 0; j < 4; ++j) {
    EXPECT_EQ((x + y)[j], a[j] + b[j]);
    EXPECT_EQ((x - y)[j], a[j] - b[j]);
    EXPECT_EQ((x * y)[j], a[j] * b[j]);
    EXPECT_EQ((x / y)[j], a[j] / b[j]);
    EXPECT_EQ((-x)[j], -a[j]);
    EXPECT_EQ(sqrt(x * x)[j], std::abs(a[j]));
    EXPECT_EQ(select(x < y, x, y)[j], std::min(a[j], b[j]));
  }
  EXPECT_EQ(sum(x), T(8.75));  // exact in binary, whatever the order
}

TYPED_TEST(LaneMathematics, RowsAddScaleAndMultiply) {
  using T = TypeParam;
  constexpr int R = 16;
  T x[R], y[R], z[R];
  for (int i = 0; i < R; ++i) {
    x[i] = T(i);
    y[i] = T(2 * i + 1);
  }
  alula::scale<R>(z, T(3), x);
  alula::add_scaled<R>(z, T(-2), y);
  for (int i = 0; i < R; ++i) EXPECT_EQ(z[i], T(-i - 2));
  T s[4];
  alula::dot4<R>(x, x, y, z, x, s);  // small integers: exact in every order
  EXPECT_EQ(s[0], T(1240));          // sum of i^2 to 15
  EXPECT_EQ(s[1], T(2 * 1240 + 120));
  EXPECT_EQ(s[2], T(-1240 - 2 * 120));
  EXPECT_EQ(s[3], s[0]);
  alula::clear<R>(z);
  for (const T v : z) EXPECT_EQ(v, T(0));
}

}  // namespace
