#pragma once
// Induced drag far behind the lattice, where the wake is a sheet of straight vortices.
//
// Katz and Plotkin, Low-Speed Aerodynamics, 2nd ed. (2001), Sec. 8.2.2: D = -rho/2 times the
// integral of circulation times normal wash over the trace of the wake.
#include <numbers>

#include "alula/host/vortex_lattice_panels.hpp"

namespace alula::lattice {

struct Trefftz {
  MatrixXd circulation;  // (strips, k)
  MatrixXd wash;         // (strips, k), normal to the trace, far behind: twice that at the wing
  MatrixXd drag;         // (k, k): CD of column i's circulation in column j's wash
};

// circulation: (panels, k). Each strip's wake leaves at its trailing edge, along the stream.
inline Trefftz trefftz(const Lattice& lattice, const Condition& at, const WindLattice& wind,
                       const MatrixXd& circulation) {
  const Eigen::Index strips = lattice.strip_first.cols(), k = circulation.cols();
  Trefftz out;
  out.circulation = MatrixXd::Zero(strips, k);
  for (int i = 0; i < lattice.panels(); ++i)
    out.circulation.row(lattice.strip[static_cast<std::size_t>(i)]) += circulation.row(i);
  const auto trace = [&](const Points& p) -> Points {
    return wind.to_wind * (p.colwise() - at.point);
  };
  const Points first = trace(lattice.strip_first), last = trace(lattice.strip_last),
               middle = trace(lattice.strip_middle);
  MatrixXd through(strips, strips);  // normal wash times width, of unit circulations
  for (Eigen::Index i = 0; i < strips; ++i) {
    const double y = middle(1, i), z = middle(2, i);
    const double dy = last(1, i) - first(1, i), dz = last(2, i) - first(2, i);
    const double close = 1e-12 * (dy * dy + dz * dz);
    for (Eigen::Index j = 0; j < strips; ++j) {
      double sum = 0.0;
      for (const auto& [edges, sign] : {std::pair{&first, -1.0}, std::pair{&last, 1.0}}) {
        const double ry = y - (*edges)(1, j), rz = z - (*edges)(2, j), r2 = ry * ry + rz * rz;
        if (r2 > close) sum += sign * (rz * dz + ry * dy) / r2;
      }
      through(i, j) = 0.5 * std::numbers::inv_pi * sum;
    }
  }
  out.wash.noalias() = through * out.circulation;
  out.drag.noalias() = -1.0 / at.S * out.circulation.transpose() * out.wash;
  for (Eigen::Index i = 0; i < strips; ++i)
    out.wash.row(i) /= std::hypot(last(1, i) - first(1, i), last(2, i) - first(2, i));
  return out;
}

}  // namespace alula::lattice
