#pragma once
// What a vortex lattice is made of, and the same seen along the stream. Host only: Eigen and heap.
//
// Positions in m, body axes (x forward, y right, z down). Airspeed 1; velocities are of the air
// relative to the aircraft. Rates are the hats: p b/2V, q c/2V, r b/2V.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace alula::lattice {

using Points = Eigen::Matrix<double, 3, Eigen::Dynamic>;
using Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

// Matrices of this order still fit a small machine: 1.8 GB without symmetry, half of it with.
inline constexpr int kMaxPanels = 15000;

// Horseshoes in rows: the bound vortices of a row join end to end, so neighbors share a trailing
// leg: along the surface to the trailing edge, then along the stream. Row r has the vertices
// row_start[r] ... row_start[r + 1] - 1, one more than panels; panels are counted along the rows.
// Circulation is positive from a vertex to the next.
//
// Order of the panels: the right half, then what lies in the plane of symmetry, then the left half.
// right = 0: no use is made of symmetry, all panels are in the second group.
struct Lattice {
  Points vertices;
  std::vector<int> row_start;       // rows + 1
  Points trailing;                  // where legs leave the trailing edge
  std::vector<int> row_trailing;    // rows: trailing point of the row's first vertex, others follow
  std::vector<int> row_surface;     // rows: which surface, for the vortex core between surfaces
  Points control, normal;           // one per panel
  Points middle;                    // of the bound vortices, where the velocity makes force
  std::vector<Points> normal_rate;  // per control: d normal / d deflection
  std::vector<int> parity;          // per control: 1 symmetric, -1 antisymmetric
  std::vector<int> mirror;          // per panel of the right half: its image
  int right = 0, center = 0;
  std::vector<int> strip;  // per panel
  // Per strip: ends of its trailing edge, and the point between them where its wash is taken.
  Points strip_first, strip_last, strip_middle;

  int panels() const { return static_cast<int>(control.cols()); }
  int rows() const { return static_cast<int>(row_surface.size()); }
  int solved() const { return right + center; }  // panels whose circulation is solved for
  int first_panel(int row) const { return row_start[static_cast<std::size_t>(row)] - row; }
};

struct Condition {
  double alpha = 0.0, beta = 0.0, mach = 0.0;
  Vector3d rate = Vector3d::Zero();   // hats, body axes
  Vector3d point = Vector3d::Zero();  // moments and rotations are about it
  double S = 1.0, b = 1.0, c = 1.0;
  double core = 0.0;    // radius of the vortex core between different surfaces, m; 0: none
  bool turning = true;  // the wake turns with alpha and beta; false: derivatives at a held wake
};

// The lattice in wind axes: x along the stream (aft), y to the right, z up; x of vertices and
// points divided by B = sqrt(1 - mach^2) (Prandtl-Glauert by Goethert's rule).
struct WindLattice {
  Matrix3d to_wind;  // from body axes
  double B = 1.0, cos_beta = 1.0, core2 = 0.0;
  Points vertices, trailing, control, middle;  // scaled; middle: of the bound vortices
  Points bound, arm;   // not scaled: bound vortex; its middle from the reference point
  Points control_arm;  // not scaled
  Points normal;
  std::vector<double> surface;  // of each panel
};

// Rows: unit vectors along the stream, to the right and up. The stream is
// -(cos a cos b, sin b, sin a cos b); d/d alpha of it is cos b times the third row, d/d beta the
// negative second row.
inline Matrix3d wind_axes(double alpha, double beta) {
  const double ca = std::cos(alpha), sa = std::sin(alpha), cb = std::cos(beta), sb = std::sin(beta);
  Matrix3d R;
  R << -ca * cb, -sb, -sa * cb, -ca * sb, cb, -sa * sb, sa, 0.0, -ca;
  return R;
}

inline WindLattice along_the_wind(const Lattice& lattice, const Condition& at) {
  WindLattice w;
  w.to_wind = wind_axes(at.alpha, at.beta);
  w.B = std::sqrt(1.0 - at.mach * at.mach);
  w.cos_beta = std::cos(at.beta);
  w.core2 = at.core * at.core;
  // About the reference point, so that a far origin costs no digits.
  const auto turned = [&](const Points& p) -> Points {
    return w.to_wind * (p.colwise() - at.point);
  };
  w.vertices = turned(lattice.vertices);
  w.trailing = turned(lattice.trailing);
  w.control = turned(lattice.control);
  w.control_arm = w.control;
  w.normal = w.to_wind * lattice.normal;
  const int n = lattice.panels();
  w.bound.resize(3, n);
  w.arm = turned(lattice.middle);
  w.surface.resize(static_cast<std::size_t>(n));
  for (int row = 0, panel = 0; row < lattice.rows(); ++row) {
    const std::size_t r = static_cast<std::size_t>(row);
    for (int v = lattice.row_start[r]; v + 1 < lattice.row_start[r + 1]; ++v, ++panel) {
      w.bound.col(panel) = w.vertices.col(v + 1) - w.vertices.col(v);
      w.surface[static_cast<std::size_t>(panel)] = lattice.row_surface[r];
    }
  }
  w.middle = w.arm;
  for (Points* p : {&w.vertices, &w.trailing, &w.control, &w.middle}) p->row(0) /= w.B;
  return w;
}

}  // namespace alula::lattice
