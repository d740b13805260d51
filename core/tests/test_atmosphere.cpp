// Published values: U.S. Standard Atmosphere 1976 (NOAA-S/T 76-1562), Table I, geometric height.
#include <gtest/gtest.h>

#include "alula/motion/atmosphere.hpp"

namespace {

struct Row {
  double h, temperature, pressure, density, speed_of_sound;
};
constexpr Row kPublished[] = {
    {0, 288.150, 1.01325e5, 1.2250, 340.29},       {1000, 281.651, 8.9876e4, 1.1117, 336.43},
    {5000, 255.676, 5.4048e4, 7.3643e-1, 320.55},  {10000, 223.252, 2.6500e4, 4.1351e-1, 299.53},
    {15000, 216.650, 1.2111e4, 1.9476e-1, 295.07}, {20000, 216.650, 5.5293e3, 8.8910e-2, 295.07},
    {30000, 226.509, 1.1970e3, 1.8410e-2, 301.71}, {40000, 250.350, 2.8714e2, 3.9957e-3, 317.19},
    {50000, 270.650, 7.9779e1, 1.0269e-3, 329.80}, {60000, 247.021, 2.1958e1, 3.0968e-4, 315.07},
    {70000, 219.585, 5.2209e0, 8.2829e-5, 297.06},
};

TEST(Atmosphere, MatchesThePublishedTable) {
  for (const Row& row : kPublished) {
    const auto air = alula::standard_atmosphere(row.h);
    // Half a unit of the table's last digit: 3 decimals of K, 5 digits elsewhere; the table
    // rounds, or in places cuts, so one unit is allowed.
    EXPECT_NEAR(air.temperature, row.temperature, 1e-3) << row.h;
    EXPECT_NEAR(air.pressure, row.pressure, 1e-4 * row.pressure) << row.h;
    EXPECT_NEAR(air.density, row.density, 1e-4 * row.density) << row.h;
    EXPECT_NEAR(air.speed_of_sound, row.speed_of_sound, 1e-2) << row.h;
  }
}

TEST(Atmosphere, IsContinuousBetweenLayers) {
  using namespace alula::standard_atmosphere_1976;
  for (int i = 1; i < kLayers; ++i) {
    const double H = kLayer[i].base, h = H * kEarthRadius / (kEarthRadius - H);
    const auto below = alula::standard_atmosphere(h - 1e-4);
    const auto above = alula::standard_atmosphere(h + 1e-4);
    // Over 0.2 mm the air itself changes by less than 1e-7 of its pressure.
    EXPECT_NEAR(above.pressure / below.pressure, 1.0, 1e-7) << i;
    EXPECT_NEAR(above.temperature, below.temperature, 1e-5) << i;
  }
}

}  // namespace
