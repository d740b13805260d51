#pragma once
// How the induced velocities change as the stream, and with it the trailing legs, turns about the
// lattice: exact derivatives of the horseshoes' velocities to angle of attack and sideslip.
//
// In axes that turn with the stream by a small rotation w the lattice turns by -w, so a velocity
// v(r) changes by dv = w x v - (grad v)(w x r). Bound vortices do not care without compressibility.
#include "alula/host/vortex_lattice_influence.hpp"

namespace alula::lattice {

// By the stream's turning towards up (wind z), and away from y (towards -y): (3, points) each.
struct Turned {
  Points up, aside;
};

// Circulation of the leg from a row's vertex, positive downstream.
inline double leg_circulation(const Lattice& lattice, const VectorXd& circulation, int row, int v) {
  const std::size_t r = static_cast<std::size_t>(row);
  const double before = v > lattice.row_start[r] ? circulation[v - 1 - row] : 0.0;
  return before - (v + 1 < lattice.row_start[r + 1] ? circulation[v - row] : 0.0);
}

namespace detail {

struct Turning {
  alignas(64) double up[3][kTile], aside[3][kTile];
};

inline void add(double* to, Pack x) { (Pack::load(to) + x).store(to); }

// Leg with circulation s: f = g (0, -z, y), q = 1/(B r^3) + x (2 - x/r) g^2 in which the first x is
// not scaled; see the header of this file, with w = -e_y and w = -e_z.
inline void turn_legs(const Tile& tile, const Eigen::Ref<const Vector3d>& vertex, double surface,
                      double core2, double B, double circulation, Turning& out) {
  const Pack s(0.25 * std::numbers::inv_pi * circulation);
  for (int i = 0; i < tile.padded; i += kLanes) {
    const Pack x = Pack::load(tile.x + i) - Pack(vertex[0]);
    const Pack y = Pack::load(tile.y + i) - Pack(vertex[1]);
    const Pack z = Pack::load(tile.z + i) - Pack(vertex[2]);
    const Leg leg(x, y * y + z * z + core_of(tile, i, surface, core2));
    const Pack X = x * Pack(B), g = leg.g, u = leg.inverse_r;
    const Pack q = u * u * u * Pack(1.0 / B) + X * (Pack(2.0) - x * u) * g * g;
    add(out.up[0] + i, -(s * y * g));
    add(out.up[1] + i, s * (X * g - z * z * q));
    add(out.up[2] + i, s * y * z * q);
    add(out.aside[0] + i, -(s * z * g));
    add(out.aside[1] + i, s * y * z * q);
    add(out.aside[2] + i, s * (X * g - y * y * q));
  }
}

struct Three {
  Pack x, y, z;
};
inline Three cross(const Three& a, const Three& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Pack dot(const Three& a, const Three& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Derivative of the bound vortex' velocity (scaled axes) as a and b change by da and db.
inline Three turn_bound(const Three& a, const Three& b, Pack ra, Pack rb, const Three& da,
                        const Three& db) {
  const Pack p = ra * rb, ab = dot(a, b), zero(0.0);
  const Pack h = bound_factor(p, ab, ra + rb);
  const Pack dra = dot(a, da) / ra, drb = dot(b, db) / rb, dp = dra * rb + ra * drb;
  const Pack dab = dot(da, b) + dot(a, db);
  const auto off = h > zero;
  const Pack den = select(off, p * (p + ab), Pack(1.0));
  const Pack dh = select(off, (dra + drb - h * (dp * (p + ab) + p * (dp + dab))) / den, zero);
  const Three c = cross(a, b), l = cross(da, b), m = cross(a, db);
  return {(l.x + m.x) * h + c.x * dh, (l.y + m.y) * h + c.y * dh, (l.z + m.z) * h + c.z * dh};
}

// With Prandtl-Glauert the bound vortices, too, feel which way the stream goes.
inline void turn_bounds(const FromVertex& a_of, const FromVertex& b_of, int padded, double B,
                        double circulation, Turning& out) {
  const Pack s(0.25 * std::numbers::inv_pi * circulation), k(1.0 / B), K(B);
  for (int i = 0; i < padded; i += kLanes) {
    const Three a{Pack::load(a_of.x + i), Pack::load(a_of.y + i), Pack::load(a_of.z + i)};
    const Three b{Pack::load(b_of.x + i), Pack::load(b_of.y + i), Pack::load(b_of.z + i)};
    const Pack ra = Pack::load(a_of.r + i), rb = Pack::load(b_of.r + i), zero(0.0);
    const Pack h = bound_factor(ra * rb, dot(a, b), ra + rb);
    Three v = cross(a, b);
    v = {v.x * h * k, v.y * h, v.z * h};
    const Three up =
        turn_bound(a, b, ra, rb, {a.z * k, zero, -(a.x * K)}, {b.z * k, zero, -(b.x * K)});
    add(out.up[0] + i, s * (up.x * k - v.z));
    add(out.up[1] + i, s * up.y);
    add(out.up[2] + i, s * (up.z + v.x));
    const Three aside =
        turn_bound(a, b, ra, rb, {-(a.y * k), a.x * K, zero}, {-(b.y * k), b.x * K, zero});
    add(out.aside[0] + i, s * (aside.x * k + v.y));
    add(out.aside[1] + i, s * (aside.y - v.x));
    add(out.aside[2] + i, s * aside.z);
  }
}

}  // namespace detail

// At the first `count` points, for the given circulation of all panels.
inline Turned turned(const Lattice& lattice, const WindLattice& wind, const Points& points,
                     int count, const VectorXd& circulation) {
  Turned out{Points::Zero(3, count), Points::Zero(3, count)};
  if (circulation.isZero(0.0)) return out;
  // Behind the trailing edge the legs of a strip's panels are one.
  VectorXd wake = VectorXd::Zero(wind.trailing.cols());
  std::vector<double> surface_of(static_cast<std::size_t>(wind.trailing.cols()));
  VectorXd leg(wind.vertices.cols());
  for (int row = 0; row < lattice.rows(); ++row) {
    const std::size_t r = static_cast<std::size_t>(row);
    for (int v = lattice.row_start[r]; v < lattice.row_start[r + 1]; ++v) {
      const int edge = lattice.row_trailing[r] + v - lattice.row_start[r];
      leg[v] = leg_circulation(lattice, circulation, row, v);
      wake[edge] += leg[v];
      surface_of[static_cast<std::size_t>(edge)] = lattice.row_surface[r];
    }
  }
  FromVertex one, other, end;
  FromVertex *a = &one, *b = &other;
  for (int i = 0; i < count; i += kTile) {
    const Tile tile(points, wind.surface, i, std::min(i + kTile, count));
    detail::Turning sum{};
    for (int k = 0; k < wake.size(); ++k)
      detail::turn_legs(tile, wind.trailing.col(k), surface_of[static_cast<std::size_t>(k)],
                        wind.core2, wind.B, wake[k], sum);
    for (int row = 0; wind.B != 1.0 && row < lattice.rows(); ++row) {
      const std::size_t r = static_cast<std::size_t>(row);
      const double surface = lattice.row_surface[r];
      const int begin = lattice.row_start[r];
      for (int v = begin; v < lattice.row_start[r + 1]; ++v) {
        const int edge = lattice.row_trailing[r] + v - begin;
        see_edge(tile, wind.trailing.col(edge), surface, wind.core2, end);
        see(tile, wind.vertices.col(v), end, surface, wind.core2, *b);
        detail::turn_bounds(*b, end, tile.padded, wind.B, leg[v], sum);
        if (v > begin)
          detail::turn_bounds(*a, *b, tile.padded, wind.B, circulation[v - 1 - row], sum);
        std::swap(a, b);
      }
    }
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < tile.count; ++k) {
        out.up(axis, i + k) = sum.up[axis][k];
        out.aside(axis, i + k) = sum.aside[axis][k];
      }
  }
  return out;
}

}  // namespace alula::lattice
