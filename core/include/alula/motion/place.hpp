#pragma once
// Where the aircraft is on its Earth: attitude against north, east, down; height; what pulls on it.
#include "alula/math/quaternion.hpp"
#include "alula/motion/flat_earth.hpp"
#include "alula/motion/state_layout.hpp"
#include "alula/motion/wgs84.hpp"

namespace alula {

enum class Earth : unsigned char { flat, wgs84 };

template <class S>
struct Place {
  Mat3<S> R_BE;        // from the axes of the position (NED, or ECEF) to body axes
  Mat3<S> R_BN;        // from north, east, down to body axes; the same on a flat Earth
  S height;            // m; over the ellipsoid where there is one
  Vec3<S> gravity;     // body axes, m/s2, centrifugal part included
  Vec3<S> earth_rate;  // the Earth's rotation in body axes, rad/s; zero where it is flat
};

template <class S, class T>
Place<S> place(const FlightState<S>& x, Earth earth, T flat_gravity) {
  const Quaternion<S> q{x[3], x[4], x[5], x[6]};
  if (earth == Earth::flat)  // in place: to set it to zero and to copy the matrix takes longer
    return {earth_to_body(q),
            earth_to_body(q),
            -x[2],
            gravity_in_body(earth_to_body(q), S(flat_gravity)),
            {S(0), S(0), S(0)}};
  Place<S> at;
  at.R_BE = earth_to_body(q);
  const Vec3<S> r{x[0], x[1], x[2]};
  const Geodetic<S> over = geodetic(r);
  const Mat3<S> R_NE = north_east_down(over);
  for (int i = 0; i < 3; ++i) {
    const Vec3<S>& row = at.R_BE.row[i];
    at.R_BN.row[i] = {dot(row, R_NE.row[0]), dot(row, R_NE.row[1]), dot(row, R_NE.row[2])};
    const S turn = S(wgs84::kRate) * row.z;
    (i == 0 ? at.earth_rate.x : i == 1 ? at.earth_rate.y : at.earth_rate.z) = turn;
  }
  at.height = over.height;
  at.gravity = at.R_BE * (gravitation_j2(r) + centrifugal(r));
  return at;
}

}  // namespace alula
