// Steady wind with shear and profile; the discrete gust.
#include <gtest/gtest.h>

#include <cmath>

#include "alula/motion/wind.hpp"

namespace {

TEST(Wind, IsTheSameEverywhereUnlessToldOtherwise) {
  alula::Wind<double> wind;
  wind.steady = {4, -3, 0.5};
  for (const double h : {-50.0, 0.0, 3000.0}) {
    const auto v = alula::wind_at(wind, h);
    EXPECT_EQ(v.x, 4.0);
    EXPECT_EQ(v.y, -3.0);
    EXPECT_EQ(v.z, 0.5);
  }
}

TEST(Wind, GrowsWithHeight) {
  alula::Wind<double> wind;
  wind.steady = {4, 0, 0};
  wind.shear = {0.01, -0.02, 0};
  wind.reference_height = 100.0;
  const auto v = alula::wind_at(wind, 300.0);
  EXPECT_DOUBLE_EQ(v.x, 6.0);
  EXPECT_DOUBLE_EQ(v.y, -4.0);
}

TEST(Wind, LogarithmicProfileOfTheSpecification) {
  // u = u20 ln(h/z0)/ln(20/z0), feet, z0 = 0.15
  alula::Wind<double> wind;
  wind.steady = {7, 2, 0};
  wind.logarithmic = true;
  wind.ground = 250.0;
  wind.reference_height = 250.0 + 20 * 0.3048;
  wind.roughness = 0.15 * 0.3048;
  for (const double ft : {3.0, 20.0, 200.0, 1000.0}) {
    const auto v = alula::wind_at(wind, 250.0 + ft * 0.3048);
    EXPECT_NEAR(v.x, 7 * std::log(ft / 0.15) / std::log(20 / 0.15), 1e-12);
    EXPECT_NEAR(v.y / v.x, 2.0 / 7.0, 1e-14);
  }
  // held below 3 ft (and underground) and above 1000 ft
  EXPECT_DOUBLE_EQ(alula::wind_at(wind, 0.0).x, alula::wind_at(wind, 250.0 + 3 * 0.3048).x);
  EXPECT_DOUBLE_EQ(alula::wind_at(wind, 5000.0).x, alula::wind_at(wind, 250.0 + 304.8).x);
  using D = alula::Dual<double, 8>;
  const double h = 290.0, step = 1e-4;
  const auto dual = alula::wind_at(wind, D::variable(h, 0));
  EXPECT_NEAR(dual.x.slope_of(0),
              (alula::wind_at(wind, h + step).x - alula::wind_at(wind, h - step).x) / (2 * step),
              1e-9);  // h^2 of the third derivative
}

TEST(Gust, RisesAsOneMinusCosineAndStays) {
  const alula::CosineGust<double> gust{{0, 0, -8}, 2.0, 60.0, 30.0};  // 2 s to the full 8 m/s up
  EXPECT_EQ(alula::gust_at(gust, 1.99).z, 0.0);
  EXPECT_NEAR(alula::gust_at(gust, 3.0).z, -4.0, 1e-12);
  EXPECT_NEAR(alula::gust_at(gust, 2.5).z, -4.0 * (1 - std::cos(0.25 * 3.14159265358979)), 1e-12);
  EXPECT_EQ(alula::gust_at(gust, 4.0).z, -8.0);
  EXPECT_EQ(alula::gust_at(gust, 400.0).z, -8.0);
}

TEST(Gust, ReturnsWhereItShall) {
  const alula::CosineGust<double> gust{{0, 5, 0}, 0.0, 60.0, 30.0, true};
  EXPECT_NEAR(alula::gust_at(gust, 2.0).y, 5.0, 1e-12);
  EXPECT_NEAR(alula::gust_at(gust, 1.3).y, alula::gust_at(gust, 2.7).y, 1e-12);
  EXPECT_EQ(alula::gust_at(gust, 4.0).y, 0.0);
  EXPECT_EQ(alula::gust_at(gust, -1.0).y, 0.0);
}

}  // namespace
