// The turning Earth: heights and latitudes to rounding, gravity as published, exact slopes.
#include <gtest/gtest.h>

#include <cmath>

#include "alula/math/dual.hpp"
#include "alula/motion/tumbling.hpp"
#include "alula/motion/wgs84.hpp"

namespace {

using alula::Vec3;

TEST(Wgs84, PlaceComesBackFromItsPosition) {
  for (double latitude = -1.57; latitude < 1.58; latitude += 0.05)
    for (const double height : {-1e3, 0.0, 1e4, 1e5, 1e6, 4e7}) {
      const auto place = alula::geodetic(alula::ecef(latitude, -2.1, height));
      // Rounding of 6400 km and of the sums: some 1e-9 m
      EXPECT_NEAR(place.height, height, 4e-16 * (6.4e6 + height) * 10);
      EXPECT_NEAR(std::atan2(place.sin_latitude, place.cos_latitude), latitude, 1e-14);
      EXPECT_NEAR(std::atan2(place.sin_longitude, place.cos_longitude), -2.1, 1e-14);
    }
}

TEST(Wgs84, PolesAndEquatorAreWhereTheEllipsoidSays) {
  const auto pole = alula::geodetic(Vec3<double>{0, 0, 6356752.314245 + 1000.0});
  EXPECT_NEAR(pole.height, 1000.0, 1e-6);  // the semi-minor axis is published to 1e-6 m
  EXPECT_DOUBLE_EQ(pole.sin_latitude, 1.0);
  EXPECT_DOUBLE_EQ(pole.cos_longitude, 1.0);
  const auto equator = alula::geodetic(Vec3<double>{0, 6378137.0 + 5.0, 0});
  EXPECT_NEAR(equator.height, 5.0, 1e-8);
  EXPECT_NEAR(equator.sin_longitude, 1.0, 1e-15);
}

TEST(Wgs84, AttitudeOfNorthEastDownIsItsAxes) {
  for (const double latitude : {-1.3, 0.0, 0.8}) {
    const auto axes = alula::north_east_down(alula::geodetic(alula::ecef(latitude, 2.5, 100.0)));
    const auto R = alula::earth_to_body(alula::north_east_down_attitude(latitude, 2.5));
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(R.row[i].x, axes.row[i].x, 1e-15);
      EXPECT_NEAR(R.row[i].y, axes.row[i].y, 1e-15);
      EXPECT_NEAR(R.row[i].z, axes.row[i].z, 1e-15);
    }
  }
}

TEST(Wgs84, GravityIsThatOfTheFormula) {
  // Normal gravity of WGS-84 (NIMA TR8350.2, Table 3.4): 9.7803253359 at the equator, 9.8321849379
  // at the poles. J2 alone leaves out J4 = -2.4e-6: 5 |J4| g at the poles.
  const Vec3<double> equator{6378137.0, 0, 0}, pole{0, 0, 6356752.314245};
  const auto at_equator = alula::gravitation_j2(equator) + alula::centrifugal(equator);
  EXPECT_NEAR(-at_equator.x, 9.7803253359, 1.5e-4);
  EXPECT_NEAR(-alula::gravitation_j2(pole).z, 9.8321849379, 1.5e-4);
  // Sum of attraction and centrifugal part is at right angles to the ellipsoid, to the same order.
  const auto r = alula::ecef(0.7, 0.3, 0.0);
  const auto at = alula::geodetic(r);
  const auto g = alula::north_east_down(at) * (alula::gravitation_j2(r) + alula::centrifugal(r));
  EXPECT_NEAR(g.x, 0.0, 1e-4);
  EXPECT_NEAR(g.y, 0.0, 1e-14);
  EXPECT_NEAR(g.z, 9.8, 0.02);
}

TEST(Wgs84, AttractionIsTheSlopeOfItsPotential) {
  // U = GM/r (1 - J2 (a/r)^2 (3 sin^2 - 1)/2), differentiated by dual numbers.
  using D = alula::Dual<double, 4>;
  using namespace alula::wgs84;
  const Vec3<double> at{3.1e6, -4.4e6, 3.6e6};
  const D x = D::variable(at.x, 0), y = D::variable(at.y, 1), z = D::variable(at.z, 2);
  const D r2 = x * x + y * y + z * z, r = sqrt(r2);
  const D U = (kGM / r) * (1.0 - kJ2 * kRadius * kRadius / r2 * ((3.0 * (z * z / r2) - 1.0) * 0.5));
  const auto g = alula::gravitation_j2(at);
  EXPECT_NEAR(g.x, U.slope_of(0), 1e-14);
  EXPECT_NEAR(g.y, U.slope_of(1), 1e-14);
  EXPECT_NEAR(g.z, U.slope_of(2), 1e-14);
}

TEST(Wgs84, SlopesOfHeightAreDown) {
  using D = alula::Dual<double, 4>;
  for (const double latitude : {0.0, 0.4, 1.2, 1.5707}) {
    const auto r = alula::ecef(latitude, 1.0, 8000.0);
    const Vec3<D> rd{D::variable(r.x, 0), D::variable(r.y, 1), D::variable(r.z, 2)};
    const auto height = alula::geodetic(rd).height;
    const auto down = alula::north_east_down(alula::geodetic(r)).row[2];
    EXPECT_NEAR(height.slope_of(0), -down.x, 1e-9) << latitude;
    EXPECT_NEAR(height.slope_of(1), -down.y, 1e-9) << latitude;
    EXPECT_NEAR(height.slope_of(2), -down.z, 1e-9) << latitude;
  }
}

TEST(Tumbling, EnergyAndAngularMomentumStay) {
  const alula::Mat3<double> inertia{{{900, 60, -80}, {60, 1000, 30}, {-80, 30, 1700}}};
  const Vec3<double> rates{1, -2, 1.5};
  const double fast = std::sqrt(alula::dot(rates, rates));
  const auto drift = alula::tumble(inertia, rates, 0.005 / fast, 1000000L);
  // RK4 loses z^6/72 of an amplitude a step: 2e-16 at 0.005, 2e-10 after a million
  EXPECT_LT(drift.energy, 1e-9);
  EXPECT_LT(drift.magnitude, 1e-9);
  EXPECT_LT(drift.direction, 1e-9);
}

}  // namespace
