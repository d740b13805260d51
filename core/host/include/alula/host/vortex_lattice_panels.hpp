#pragma once
// What a vortex lattice is made of, and the same seen along the stream. Host only: it uses the
// heap.
//
// Positions in m, body axes (x forward, y right, z down). Airspeed 1; velocities are of the air
// relative to the aircraft. Rates are the hats: p b/2V, q c/2V, r b/2V.
#include <cmath>
#include <vector>

#include "alula/math/vec3.hpp"

namespace alula::lattice {

using Point = Vec3<double>;
using Points = std::vector<Point>;
using Values = std::vector<double>;   // one per panel, vertex or strip
using Columns = std::vector<Values>;  // of a matrix

// Matrices of this order still fit a small machine: 1.8 GB without symmetry, half of it with.
inline constexpr int kMaxPanels = 15000;

// Horseshoes in rows: the bound vortices of a row join end to end, so neighbors share a trailing
// leg: along the surface to the trailing edge, then along the stream. A row has one vertex and one
// trailing point more than panels, each counted on from its first; panels and vertices are counted
// along the rows. Circulation is positive from a vertex to the next.
struct Row {
  int panels, panel, vertex, trailing;
  int surface;  // for the vortex core between surfaces
};

// Order of the panels: the right half, then what lies in the plane of symmetry, then the left half.
// right = 0: no use is made of symmetry, all panels are in the second group.
struct Lattice {
  std::vector<Row> rows;
  Points vertices;
  Points trailing;                  // where legs leave the trailing edge
  Points control, normal;           // one per panel
  Points middle;                    // of the bound vortices, where the velocity makes force
  std::vector<Points> normal_rate;  // per control: d normal / d deflection
  std::vector<int> parity;          // per control: 1 symmetric, -1 antisymmetric
  std::vector<int> mirror;          // per panel of the right half: its image
  int right = 0, center = 0;
  std::vector<int> strip;  // per panel
  // Per strip: ends of its trailing edge, and the point between them where its wash is taken.
  Points strip_first, strip_last, strip_middle;

  int panels() const { return static_cast<int>(control.size()); }
  int solved() const { return right + center; }  // panels whose circulation is solved for
};

struct Condition {
  double alpha = 0.0, beta = 0.0, mach = 0.0;
  Point rate;   // hats, body axes
  Point point;  // moments and rotations are about it
  double S = 1.0, b = 1.0, c = 1.0;
  double core = 0.0;    // radius of the vortex core between different surfaces, m; 0: none
  bool turning = true;  // the wake turns with alpha and beta; false: derivatives at a held wake
};

// The lattice in wind axes: x along the stream (aft), y to the right, z up; x of vertices and
// points divided by B = sqrt(1 - mach^2) (Prandtl-Glauert by Goethert's rule).
struct WindLattice {
  Mat3<double> to_wind, to_body;  // from body axes, and back
  double B = 1.0, cos_beta = 1.0, core2 = 0.0;
  Points vertices, trailing, control, middle;  // scaled; middle: of the bound vortices
  Points bound, arm;   // not scaled: bound vortex; its middle from the reference point
  Points control_arm;  // not scaled
  Points normal;
  Values surface;  // of each panel
};

// Rows: unit vectors along the stream, to the right and up. The stream is
// -(cos a cos b, sin b, sin a cos b); d/d alpha of it is cos b times the third row, d/d beta the
// negative second row.
inline Mat3<double> wind_axes(double alpha, double beta) {
  const double ca = std::cos(alpha), sa = std::sin(alpha), cb = std::cos(beta), sb = std::sin(beta);
  return {{{-ca * cb, -sb, -sa * cb}, {-ca * sb, cb, -sa * sb}, {sa, 0.0, -ca}}};
}

// Seen from `origin` in other axes.
inline Points rotated(const Mat3<double>& by, Points points, const Point& origin = {}) {
  for (Point& p : points) p = by * (p - origin);
  return points;
}

inline WindLattice along_the_wind(const Lattice& lattice, const Condition& at) {
  WindLattice w;
  const auto [x, y, z] = (w.to_wind = wind_axes(at.alpha, at.beta)).row;
  w.to_body = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
  w.B = std::sqrt(1.0 - at.mach * at.mach);
  w.cos_beta = std::cos(at.beta);
  w.core2 = at.core * at.core;
  // About the reference point, so that a far origin costs no digits.
  const auto arms = [&](const Points& points) { return rotated(w.to_wind, points, at.point); };
  w.vertices = arms(lattice.vertices);
  w.trailing = arms(lattice.trailing);
  w.control = w.control_arm = arms(lattice.control);
  w.middle = w.arm = arms(lattice.middle);
  w.normal = rotated(w.to_wind, lattice.normal);
  w.bound.resize(lattice.panels()), w.surface.resize(lattice.panels());
  for (const Row& row : lattice.rows)
    for (int k = 0; k < row.panels; ++k) {
      w.bound[row.panel + k] = w.vertices[row.vertex + k + 1] - w.vertices[row.vertex + k];
      w.surface[row.panel + k] = row.surface;
    }
  for (Points* points : {&w.vertices, &w.trailing, &w.control, &w.middle})
    for (Point& p : *points) p.x /= w.B;
  return w;
}

}  // namespace alula::lattice
