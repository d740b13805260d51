#pragma once
// Vortex lattice: loads of thin lifting surfaces and their exact derivatives to angle of attack,
// sideslip, rates and controls, from one factorization.
//
// Horseshoe vortices on the quarter line of each panel, no flow through it at three quarters;
// legs along the surface to the trailing edge and on straight along the stream. Forces by Kutta and
// Joukowski: on the bound vortices with all velocity there, on the legs' part on the surface with
// the outer flow (what sideslip and yawing do to them; Queijo 1968, NASA TN D-4929). Katz and
// Plotkin, Low-Speed Aerodynamics, 2nd ed. (2001), Sec. 12.3; Drela, Flight Vehicle Aerodynamics
// (2014), Ch. 6. Derivatives are those of the discrete equations, A dG = -(dV.n + V.dn + (dA/ds)
// G), the turning of the wake's legs included.
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

// Force and moment about the reference point, one column per panel, wind axes.
struct PanelLoads {
  Points force, moment;

  PanelLoads times(const VectorXd& circulation) const {
    const auto by = circulation.head(force.cols()).asDiagonal();
    return {force * by, moment * by};
  }
};

// Loads of unit circulations in given flows: at the bound vortices, and at the middle of the legs
// on the surface (vertex by vertex), where the flow is the outer one.
struct UnitLoads {
  const Lattice& lattice;
  const WindLattice& wind;
  Points leg, leg_arm;  // of each vertex: the leg to the trailing edge, and its middle

  UnitLoads(const Lattice& of, const WindLattice& in)
      : lattice(of), wind(in), leg(3, of.vertices.cols()), leg_arm(3, of.vertices.cols()) {
    for (int row = 0; row < of.rows(); ++row) {
      const std::size_t r = static_cast<std::size_t>(row);
      for (int v = of.row_start[r]; v < of.row_start[r + 1]; ++v) {
        const auto edge = in.trailing.col(of.row_trailing[r] + v - of.row_start[r]);
        leg.col(v) = edge - in.vertices.col(v);
        leg_arm.col(v) = 0.5 * (edge + in.vertices.col(v));
      }
    }
    leg.row(0) *= in.B, leg_arm.row(0) *= in.B;
  }

  PanelLoads in(const Points& at_bound, const Points& at_leg) const {
    const int solved = lattice.solved();
    PanelLoads out{Points(3, solved), Points(3, solved)};
    for (int row = 0, i = 0; i < solved; ++row) {
      const std::size_t r = static_cast<std::size_t>(row);
      for (int v = lattice.row_start[r]; v + 1 < lattice.row_start[r + 1]; ++v, ++i) {
        const Vector3d bound = at_bound.col(i).cross(wind.bound.col(i).eval());
        const Vector3d first = at_leg.col(v).cross(leg.col(v).eval());
        const Vector3d last = at_leg.col(v + 1).cross(leg.col(v + 1).eval());
        out.force.col(i) = bound + last - first;
        out.moment.col(i) = Vector3d(wind.arm.col(i)).cross(bound) +
                            Vector3d(leg_arm.col(v + 1)).cross(last) -
                            Vector3d(leg_arm.col(v)).cross(first);
      }
    }
    return out;
  }
};

// Coefficients in body axes of the solved panels' loads (unit density and airspeed) and of their
// images.
inline Eigen::Matrix<double, 6, 1> total(const Lattice& lattice, const Condition& at,
                                         const WindLattice& wind, const PanelLoads& loads,
                                         int parity, Points* all = nullptr) {
  const Matrix3d to_body = wind.to_wind.transpose() * (2.0 / at.S);
  const Points force = to_body * loads.force, moment = to_body * loads.moment;
  Vector3d F = force.rowwise().sum(), M = moment.rowwise().sum();
  const Vector3d polar = parity * Vector3d(1, -1, 1), axial = -polar;
  F += polar.cwiseProduct(force.leftCols(lattice.right).rowwise().sum());
  M += axial.cwiseProduct(moment.leftCols(lattice.right).rowwise().sum());
  if (all) {
    all->leftCols(force.cols()) = force;
    for (int i = 0; i < lattice.right; ++i)
      all->col(lattice.mirror[static_cast<std::size_t>(i)]) = polar.cwiseProduct(force.col(i));
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
  if (at.turning)
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
  if (at.turning)
    at_bound.add(turned(lattice, wind, wind.middle, solved, out.circulation), wind.cos_beta);
  const MatrixXd wash = induced(lattice, wind, wind.middle, solved, circulation);
  const Points flow = at_bound.flow + detail::three_rows(wash, 0, circulation.cols());
  const detail::UnitLoads unit(lattice, wind);
  const detail::Stream at_leg(wind, at, unit.leg_arm, columns);
  const detail::PanelLoads steady_loads = unit.in(flow, at_leg.flow);
  out.force.resize(3, n);
  out.coefficients =
      detail::total(lattice, at, wind, steady_loads.times(out.circulation), steady, &out.force);
  out.derivatives.resize(6, static_cast<Eigen::Index>(columns));
  for (std::size_t k = 0; k < columns; ++k) {
    const Eigen::Index column = static_cast<Eigen::Index>(k);
    const Points rate = at_bound.rate[k] + detail::three_rows(wash, column + 1, circulation.cols());
    detail::PanelLoads loads = unit.in(rate, at_leg.rate[k]).times(out.circulation);
    const detail::PanelLoads by = steady_loads.times(circulation.col(column + 1));
    loads.force += by.force, loads.moment += by.moment;
    out.derivatives.col(column) = detail::total(lattice, at, wind, loads, parity(k));
  }
  out.wake = trefftz(lattice, at, wind, circulation.leftCols(2));
  out.circulation_rates = circulation.rightCols(static_cast<Eigen::Index>(columns));
  return out;
}

}  // namespace alula::lattice
