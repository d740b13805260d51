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
#include <array>

#include "alula/host/vortex_lattice_panels.hpp"
#include "alula/host/vortex_lattice_solve.hpp"
#include "alula/host/vortex_lattice_trefftz.hpp"
#include "alula/host/vortex_lattice_turning.hpp"

namespace alula::lattice {

// Columns of rates: alpha, beta, phat, qhat, rhat, then the controls.
inline constexpr int kMotions = 5;

using Six = std::array<double, 6>;  // CX CY CZ Cl Cm Cn, body axes

struct Loads {
  Values circulation;         // panels
  Columns circulation_rates;  // (panels, columns)
  Points force;               // per panel over dynamic pressure and S, body axes
  Six coefficients;
  std::vector<Six> derivatives;  // by column
  Trefftz wake;                  // columns: of the condition; of the angle of attack's circulation
};

namespace detail {

// Outer flow in wind axes at the first `count` arms from the reference point, and its derivative
// by column (zero for controls).
struct Stream {
  Points flow;
  std::vector<Points> rate;

  Stream(const WindLattice& wind, const Condition& at, const Points& arm, int count,
         std::size_t columns)
      : flow(count, Point{1.0, 0.0, 0.0}), rate(columns, Points(count)) {
    // Angular velocities of unit hat rates.
    const Point p = 2.0 / at.b * wind.to_body.row[0], q = 2.0 / at.c * wind.to_body.row[1],
                r = 2.0 / at.b * wind.to_body.row[2];
    for (int i = 0; i < count; ++i) {
      rate[0][i].z = wind.cos_beta;
      rate[1][i].y = -1.0;
      rate[2][i] = cross(arm[i], p), rate[3][i] = cross(arm[i], q), rate[4][i] = cross(arm[i], r);
      flow[i] = flow[i] + at.rate.x * rate[2][i] + at.rate.y * rate[3][i] + at.rate.z * rate[4][i];
    }
  }

  // What the trailing legs' turning adds for the condition's circulation.
  void add(const Turned& by, double cos_beta) {
    for (std::size_t i = 0; i < flow.size(); ++i) {
      rate[0][i] = rate[0][i] + cos_beta * by.up[i];
      rate[1][i] = rate[1][i] + by.aside[i];
    }
  }
};

// Velocities through the panels, as many as there are.
inline Values through(const Points& velocity, const Points& normal) {
  Values out(velocity.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = dot(velocity[i], normal[i]);
  return out;
}

inline Points sum(Points a, const Points& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = a[i] + b[i];
  return a;
}

// Force, and moment about the reference point, of one panel; wind axes.
struct PanelLoad {
  Point force, moment;
};
using PanelLoads = std::vector<PanelLoad>;

// Adds `loads` times the circulation.
inline void add(PanelLoads& to, const PanelLoads& loads, const Values& circulation) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i].force = to[i].force + circulation[i] * loads[i].force;
    to[i].moment = to[i].moment + circulation[i] * loads[i].moment;
  }
}

// Loads of unit circulations in given flows: at the bound vortices, and at the middle of the legs
// on the surface (vertex by vertex), where the flow is the outer one.
struct UnitLoads {
  const Lattice& lattice;
  const WindLattice& wind;
  Points leg, leg_arm;  // of each vertex: the leg to the trailing edge, and its middle

  UnitLoads(const Lattice& of, const WindLattice& in)
      : lattice(of), wind(in), leg(in.vertices.size()), leg_arm(in.vertices.size()) {
    for (const Row& row : of.rows)
      for (int k = 0; k <= row.panels; ++k) {
        const int v = row.vertex + k;
        leg[v] = in.trailing[row.trailing + k] - in.vertices[v];
        leg_arm[v] = 0.5 * (in.trailing[row.trailing + k] + in.vertices[v]);
        leg[v].x *= in.B, leg_arm[v].x *= in.B;
      }
  }

  PanelLoads in(const Points& at_bound, const Points& at_leg) const {
    PanelLoads out(at_bound.size());
    for (const Row& row : lattice.rows)
      for (int k = 0; k < row.panels; ++k) {
        const int i = row.panel + k, v = row.vertex + k;
        if (i == lattice.solved()) return out;
        const Point bound = cross(at_bound[i], wind.bound[i]);
        const Point first = cross(at_leg[v], leg[v]), last = cross(at_leg[v + 1], leg[v + 1]);
        out[i].force = bound + last - first;
        out[i].moment =
            cross(wind.arm[i], bound) + cross(leg_arm[v + 1], last) - cross(leg_arm[v], first);
      }
    return out;
  }
};

// Coefficients in body axes of the solved panels' loads (unit density and airspeed) and of their
// images.
inline Six total(const Lattice& lattice, const Condition& at, const WindLattice& wind,
                 const PanelLoads& loads, int parity, Points* all = nullptr) {
  Point F, M;
  for (int i = 0; i < lattice.solved(); ++i) {
    const Point force = 2.0 / at.S * (wind.to_body * loads[i].force);
    const Point moment = 2.0 / at.S * (wind.to_body * loads[i].moment);
    F = F + force, M = M + moment;
    if (all) (*all)[i] = force;
    if (i >= lattice.right) continue;
    const Point image = parity * Point{force.x, -force.y, force.z};
    F = F + image, M = M + parity * Point{-moment.x, moment.y, -moment.z};
    if (all) (*all)[lattice.mirror[i]] = image;
  }
  return {F.x, F.y, F.z, M.x / at.b, M.y / at.c, M.z / at.b};
}

}  // namespace detail

// The condition must be symmetric (no sideslip, roll and yaw rate, reference point in the plane)
// where the lattice uses symmetry. The caller checks it, and that the lattice is one.
inline Loads solve(const Lattice& lattice, const Condition& at) {
  const WindLattice wind = along_the_wind(lattice, at);
  const int solved = lattice.solved();
  const std::size_t controls = lattice.normal_rate.size(), columns = kMotions + controls;
  std::vector<int> parity{1, -1, -1, 1, -1};  // of each column
  parity.insert(parity.end(), lattice.parity.begin(), lattice.parity.end());
  if (lattice.right == 0) parity.assign(columns, -1);
  const int steady = lattice.right > 0 ? 1 : -1;
  const Systems systems(lattice, wind);

  Loads out;
  detail::Stream stream(wind, at, wind.control_arm, solved, columns);
  Columns circulation = systems.circulation({detail::through(stream.flow, wind.normal)}, {steady});
  out.circulation = circulation[0];
  if (at.turning)
    stream.add(turned(lattice, wind, wind.control, solved, out.circulation), wind.cos_beta);
  Points there = stream.flow;
  if (controls > 0)
    there = detail::sum(there, induced(lattice, wind, wind.control, solved, circulation)[0]);
  Columns flows;
  for (std::size_t k = 0; k < columns; ++k)
    flows.push_back(
        k < kMotions
            ? detail::through(stream.rate[k], wind.normal)
            : detail::through(there, rotated(wind.to_wind, lattice.normal_rate[k - kMotions])));
  out.circulation_rates = systems.circulation(std::move(flows), parity);
  circulation.insert(circulation.end(), out.circulation_rates.begin(),
                     out.circulation_rates.end());  // the condition's, then rates

  detail::Stream at_bound(wind, at, wind.arm, solved, columns);
  if (at.turning)
    at_bound.add(turned(lattice, wind, wind.middle, solved, out.circulation), wind.cos_beta);
  const std::vector<Points> wash = induced(lattice, wind, wind.middle, solved, circulation);
  const detail::UnitLoads unit(lattice, wind);
  const int legs = static_cast<int>(unit.leg.size());
  const detail::Stream at_leg(wind, at, unit.leg_arm, legs, columns);
  const detail::PanelLoads steady_loads = unit.in(detail::sum(at_bound.flow, wash[0]), at_leg.flow);
  out.force.resize(lattice.panels());
  detail::PanelLoads loads(solved);
  detail::add(loads, steady_loads, out.circulation);
  out.coefficients = detail::total(lattice, at, wind, loads, steady, &out.force);
  for (std::size_t k = 0; k < columns; ++k) {
    const Points rate = detail::sum(at_bound.rate[k], wash[k + 1]);
    std::fill(loads.begin(), loads.end(), detail::PanelLoad{});
    detail::add(loads, unit.in(rate, at_leg.rate[k]), out.circulation);
    detail::add(loads, steady_loads, out.circulation_rates[k]);
    out.derivatives.push_back(detail::total(lattice, at, wind, loads, parity[k]));
  }
  circulation.resize(2);
  out.wake = trefftz(lattice, at, wind, circulation);
  return out;
}

}  // namespace alula::lattice
