#pragma once
// The turning Earth: WGS-84 ellipsoid, gravity with its second zonal harmonic J2, Earth-centered
// Earth-fixed axes (ECEF: x to latitude and longitude zero, z to the north pole).
// Constants: NIMA TR8350.2, 3rd ed., Tables 3.1 and 3.3; J2 as in NASA/TM-2015-218675.
#include <cmath>

#include "alula/math/dual.hpp"
#include "alula/math/quaternion.hpp"

namespace alula {

namespace wgs84 {
inline constexpr double kRadius = 6378137.0;                      // m, equatorial
inline constexpr double kFlattening = 1.0 / 298.257223563;        // of the ellipsoid
inline constexpr double kGM = 3.986004418e14;                     // m3/s2
inline constexpr double kJ2 = 1.08262982e-3;                      // second zonal harmonic
inline constexpr double kRate = 7.292115e-5;                      // rad/s, about +z
inline constexpr double kPolar = kRadius * (1.0 - kFlattening);   // m
inline constexpr double kE2 = kFlattening * (2.0 - kFlattening);  // eccentricity squared
inline constexpr double kSecondE2 = kE2 / (1.0 - kE2);            // second one, squared
}  // namespace wgs84

// A place over the ellipsoid: height along its normal (m), sine and cosine of geodetic latitude and
// of longitude. All that the equations of motion need comes without an angle.
template <class S>
struct Geodetic {
  S height, sin_latitude, cos_latitude, sin_longitude, cos_longitude;
};

// Bowring's formula, repeated once: rounding is all that remains (below 1e-8 m) from 1000 km under
// the surface to beyond the geostationary height (B. R. Bowring, Survey Review 23, 1976). On the
// axis, where longitude has no value, it is taken as zero.
template <class S>
Geodetic<S> geodetic(const Vec3<S>& r) {
  using namespace wgs84;
  using std::sqrt;
  const S p = sqrt(r.x * r.x + r.y * r.y + S(1e-12));
  const S distance = sqrt(p * p + r.z * r.z);
  // Tangent of the parametric latitude as a ratio up / out.
  S up = S(kPolar) * r.z * (S(1) + S(kSecondE2 * kPolar) / distance), out = S(kRadius) * p;
  S sine, cosine;
  for (int i = 0; i < 2; ++i) {
    const S k = S(1) / sqrt(up * up + out * out);
    const S s = k * up, c = k * out;
    sine = r.z + S(kSecondE2 * kPolar) * (s * s * s);
    cosine = p - S(kE2 * kRadius) * (c * c * c);
    up = S(1.0 - kFlattening) * sine;
    out = cosine;
  }
  const S k = S(1) / sqrt(sine * sine + cosine * cosine);
  sine = k * sine;
  cosine = k * cosine;
  Geodetic<S> place;
  place.height = p * cosine + r.z * sine - S(kRadius) * sqrt(S(1) - S(kE2) * (sine * sine));
  place.sin_latitude = sine;
  place.cos_latitude = cosine;
  const auto off_axis = p > S(2e-6);
  const S inverse = S(1) / p;
  place.sin_longitude = select(off_axis, S(inverse * r.y), S(0));
  place.cos_longitude = select(off_axis, S(inverse * r.x), S(1));
  return place;
}

// Position (m, ECEF) of latitude, longitude (rad) and height (m).
template <class T>
Vec3<T> ecef(const T& latitude, const T& longitude, const T& height) {
  using namespace wgs84;
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T s = sin(latitude), c = cos(latitude);
  const T normal = T(kRadius) / sqrt(T(1) - T(kE2) * s * s);
  const T out = (normal + height) * c;
  return {out * cos(longitude), out * sin(longitude), (normal * T(1.0 - kE2) + height) * s};
}

// Rows: north, east and down at a place, in ECEF axes; so v_N = R_NE v_E.
template <class S>
constexpr Mat3<S> north_east_down(const Geodetic<S>& at) {
  const S &s = at.sin_latitude, &c = at.cos_latitude;
  const S &sl = at.sin_longitude, &cl = at.cos_longitude;
  return {{{-(s * cl), -(s * sl), c}, {-sl, cl, S(0)}, {-(c * cl), -(c * sl), -s}}};
}

// The turn from ECEF axes to north, east, down at latitude and longitude (rad).
template <class T>
Quaternion<T> north_east_down_attitude(const T& latitude, const T& longitude) {
  using std::cos;
  using std::sin;
  const T half_pitch = T(-0.5) * (latitude + T(1.57079632679489661923L));
  const Quaternion<T> east{cos(T(0.5) * longitude), T(0), T(0), sin(T(0.5) * longitude)};
  return east * Quaternion<T>{cos(half_pitch), T(0), sin(half_pitch), T(0)};
}

// Attraction, m/s2, ECEF axes, without the centrifugal part (Stevens and Lewis, 2nd ed., 1.4-16).
template <class S>
Vec3<S> gravitation_j2(const Vec3<S>& r) {
  using namespace wgs84;
  using std::sqrt;
  const S squared = dot(r, r), inverse = S(1) / squared;
  const S k = S(-kGM) * (inverse * sqrt(inverse));
  const S bulge = S(1.5 * kJ2 * kRadius * kRadius) * inverse;
  const S five = S(5) * (r.z * r.z) * inverse;
  const S side = k * (S(1) + bulge * (S(1) - five));
  return {side * r.x, side * r.y, k * (S(1) + bulge * (S(3) - five)) * r.z};
}

// What a body that rides on the turning Earth feels of it besides, for unit mass: -W x (W x r).
template <class S>
constexpr Vec3<S> centrifugal(const Vec3<S>& r) {
  const S k(wgs84::kRate * wgs84::kRate);
  return {k * r.x, k * r.y, S(0)};
}

}  // namespace alula
