#pragma once
// Vortex lattice: loads of thin lifting surfaces and their exact derivatives to angle of attack,
// sideslip, rates and controls, from one factorization.
//
// Horseshoe vortices on the quarter line of each panel, no flow through it at three quarters;
// trailing legs straight along the stream. Forces by Kutta and Joukowski on the bound vortices with
// all velocity there. Katz and Plotkin, Low-Speed Aerodynamics, 2nd ed. (2001), Sec. 12.3; Drela,
// Flight Vehicle Aerodynamics (2014), Ch. 6. Derivatives are those of the discrete equations,
// A dG = -(dV.n + V.dn + (dA/ds) G), the turning of the trailing legs included.
#include "alula/host/vortex_lattice_panels.hpp"
#include "alula/host/vortex_lattice_solve.hpp"
#include "alula/host/vortex_lattice_trefftz.hpp"
#include "alula/host/vortex_lattice_turning.hpp"

namespace alula::lattice {

// Columns of rates: alpha, beta, phat, qhat, rhat, then the controls.
inline constexpr int kMotions = 5;

struct Loads {
  VectorXd circulation;                      // panels
  MatrixXd circulation_rates;                // (panels, columns)
  Points force;                              // per panel over dynamic pressure and S, body axes
  Eigen::Matrix<double, 6, 1> coefficients;  // CX CY CZ Cl Cm Cn, body axes
  Eigen::Matrix<double, 6, Eigen::Dynamic> derivatives;  // (6, columns)
  Trefftz wake;  // columns: of the condition; of the angle of attack's circulation
};

namespace detail {

// Velocity of the air at an arm from the reference point where the body turns at unit hat rate.
inline Points turning(const WindLattice& wind, const Condition& at, int axis, const Points& arm) {
  const double length = axis == 1 ? at.c : at.b;
  const Vector3d w = wind.to_wind.col(axis) * (2.0 / length);
  Points out(3, arm.cols());
  for (Eigen::Index i = 0; i < arm.cols(); ++i) out.col(i) = -w.cross(arm.col(i).eval());
  return out;
}

// Outer flow in wind axes at some arms, and its derivative by column (zero for controls).
struct Stream {
  Points flow;
  std::vector<Points> rate;

  Stream(const WindLattice& wind, const Condition& at, const Points& arm, std::size_t columns)
      : flow(Vector3d::UnitX().replicate(1, arm.cols())),
        rate(columns, Points::Zero(3, arm.cols())) {
    rate[0].row(2).setConstant(wind.cos_beta);
    rate[1].row(1).setConstant(-1.0);
    for (int axis = 0; axis < 3; ++axis) {
      rate[static_cast<std::size_t>(2 + axis)] = turning(wind, at, axis, arm);
      flow += at.rate[axis] * rate[static_cast<std::size_t>(2 + axis)];
    }
  }

  // What the trailing legs' turning adds for the condition's circulation.
  void add(const Turned& by, double cos_beta) {
    rate[0] += cos_beta * by.up;
    rate[1] += by.aside;
  }
};

inline VectorXd through(const Points& velocity, const Points& normal) {
  return velocity.cwiseProduct(normal.leftCols(velocity.cols())).colwise().sum().transpose();
}

inline Points three_rows(const MatrixXd& stacked, Eigen::Index column, Eigen::Index columns) {
  Points out(3, stacked.cols());
  for (int axis = 0; axis < 3; ++axis) out.row(axis) = stacked.row(axis * columns + column);
  return out;
}

// Forces of unit density and area (over half) on the solved panels, completed by their images, and
// their sum in body axes about the reference point.
inline Eigen::Matrix<double, 6, 1> total(const Lattice& lattice, const Condition& at,
                                         const WindLattice& wind, const Points& force, int parity,
                                         Points* all = nullptr) {
  Vector3d F = Vector3d::Zero(), M = Vector3d::Zero();
  const Matrix3d to_body = wind.to_wind.transpose();
  const auto put = [&](Eigen::Index panel, const Vector3d& body) {
    const Vector3d arm = to_body * wind.arm.col(panel);
    F += body, M += arm.cross(body);
    if (all) all->col(panel) = body;
  };
  for (Eigen::Index i = 0; i < force.cols(); ++i) {
    Vector3d body = to_body * force.col(i) * (2.0 / at.S);
    put(i, body);
    if (i >= lattice.right) continue;
    body *= parity, body[1] = -body[1];
    put(lattice.mirror[static_cast<std::size_t>(i)], body);
  }
  Eigen::Matrix<double, 6, 1> out;
  out << F, M[0] / at.b, M[1] / at.c, M[2] / at.b;
  return out;
}

}  // namespace detail

// The condition must be symmetric (no sideslip, roll and yaw rate, reference point in the plane)
// where the lattice uses symmetry. The caller checks it, and that the lattice is one.
inline Loads solve(const Lattice& lattice, const Condition& at) {
  const WindLattice wind = along_the_wind(lattice, at);
  const int n = lattice.panels(), solved = lattice.solved();
  const std::size_t controls = lattice.normal_rate.size(), columns = kMotions + controls;
  const auto parity = [&](std::size_t k) {
    constexpr int motion[kMotions] = {1, -1, -1, 1, -1};
    if (lattice.right == 0) return -1;
    return k < kMotions ? motion[k] : lattice.parity[k - kMotions];
  };
  const int steady = lattice.right > 0 ? 1 : -1;
  const Systems systems(lattice, wind);

  Loads out;
  detail::Stream stream(wind, at, wind.control_arm.leftCols(solved), columns);
  out.circulation = systems.circulation(detail::through(stream.flow, wind.normal), steady);
  stream.add(turned(lattice, wind, wind.control, solved, out.circulation), wind.cos_beta);
  Points there = stream.flow;
  if (controls > 0)
    there +=
        detail::three_rows(induced(lattice, wind, wind.control, solved, out.circulation), 0, 1);

  MatrixXd circulation(n, 1 + static_cast<Eigen::Index>(columns));  // the condition's, then rates
  circulation.col(0) = out.circulation;
  for (std::size_t k = 0; k < columns; ++k) {
    VectorXd flow = detail::through(stream.rate[k], wind.normal);
    if (k >= kMotions)
      flow =
          detail::through(there, wind.to_wind * lattice.normal_rate[k - kMotions].leftCols(solved));
    circulation.col(static_cast<Eigen::Index>(k) + 1) = systems.circulation(flow, parity(k));
  }

  detail::Stream at_bound(wind, at, wind.arm.leftCols(solved), columns);
  at_bound.add(turned(lattice, wind, wind.middle, solved, out.circulation), wind.cos_beta);
  const MatrixXd wash = induced(lattice, wind, wind.middle, solved, circulation);
  const Points flow = at_bound.flow + detail::three_rows(wash, 0, circulation.cols());
  const auto force_by = [&](const Points& velocity, const VectorXd& strength) {
    Points force(3, solved);
    for (int i = 0; i < solved; ++i)
      force.col(i) = strength[i] * velocity.col(i).cross(wind.bound.col(i).eval());
    return force;
  };
  out.force.resize(3, n);
  out.coefficients =
      detail::total(lattice, at, wind, force_by(flow, out.circulation), steady, &out.force);
  out.derivatives.resize(6, static_cast<Eigen::Index>(columns));
  for (std::size_t k = 0; k < columns; ++k) {
    const Eigen::Index column = static_cast<Eigen::Index>(k);
    const Points rate = at_bound.rate[k] + detail::three_rows(wash, column + 1, circulation.cols());
    const Points force =
        force_by(flow, circulation.col(column + 1)) + force_by(rate, out.circulation);
    out.derivatives.col(column) = detail::total(lattice, at, wind, force, parity(k));
  }
  out.wake = trefftz(lattice, at, wind, circulation.leftCols(2));
  out.circulation_rates = circulation.rightCols(static_cast<Eigen::Index>(columns));
  return out;
}

}  // namespace alula::lattice
