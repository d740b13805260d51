#pragma once
// Induced drag far behind the lattice, where the wake is a sheet of straight vortices.
//
// Katz and Plotkin, Low-Speed Aerodynamics, 2nd ed. (2001), Sec. 8.2.2: D = -rho/2 times the
// integral of circulation times normal wash over the trace of the wake.
#include <cmath>
#include <numbers>
#include <utility>

#include "alula/host/vortex_lattice_panels.hpp"

namespace alula::lattice {

struct Trefftz {
  Columns circulation;  // (strips, k)
  Columns wash;         // (strips, k), normal to the trace, far behind: twice that at the wing
  Columns drag;         // (k, k): CD of column i's circulation in column j's wash
};

// circulation: (panels, k). Each strip's wake leaves at its trailing edge, along the stream.
inline Trefftz trefftz(const Lattice& lattice, const Condition& at, const WindLattice& wind,
                       const Columns& circulation) {
  const std::size_t strips = lattice.strip_first.size(), k = circulation.size();
  const Columns zeros(k, Values(strips));
  Trefftz out{zeros, zeros, Columns(k, Values(k))};
  for (std::size_t c = 0; c < k; ++c)
    for (int i = 0; i < lattice.panels(); ++i)
      out.circulation[c][lattice.strip[i]] += circulation[c][i];
  const Points first = rotated(wind.to_wind, lattice.strip_first, at.point),
               last = rotated(wind.to_wind, lattice.strip_last, at.point),
               middle = rotated(wind.to_wind, lattice.strip_middle, at.point);
  for (std::size_t i = 0; i < strips; ++i) {
    const double dy = last[i].y - first[i].y, dz = last[i].z - first[i].z;
    const double close = 1e-12 * (dy * dy + dz * dz);
    for (std::size_t j = 0; j < strips; ++j) {
      double through = 0.0;  // normal wash times width, of unit circulation
      for (const auto& [edge, sign] : {std::pair{first[j], -1.0}, std::pair{last[j], 1.0}}) {
        const double ry = middle[i].y - edge.y, rz = middle[i].z - edge.z;
        const double r2 = ry * ry + rz * rz;
        if (r2 > close) through += sign * (rz * dz + ry * dy) / r2;
      }
      through *= 0.5 * std::numbers::inv_pi;
      for (std::size_t c = 0; c < k; ++c) out.wash[c][i] += through * out.circulation[c][j];
    }
    const double width = std::hypot(dy, dz);
    for (std::size_t c = 0; c < k; ++c) {
      for (std::size_t b = 0; b < k; ++b)
        out.drag[c][b] -= out.circulation[b][i] * out.wash[c][i] / at.S;
      out.wash[c][i] /= width;
    }
  }
  return out;
}

}  // namespace alula::lattice
