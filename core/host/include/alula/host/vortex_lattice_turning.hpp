#pragma once
// How the induced velocities change as the stream, and with it the trailing legs, turns about the
// lattice: exact derivatives of the horseshoes' velocities to angle of attack and sideslip.
//
// In axes that turn with the stream by a small rotation w the lattice turns by -w, so a velocity
// v(r) changes by dv = w x v - (grad v)(w x r). Bound vortices do not care without compressibility.
#include "alula/host/vortex_lattice_influence.hpp"

namespace alula::lattice {

// By the stream's turning towards up (wind z), and away from y (towards -y): one per point each.
struct Turned {
  Points up, aside;
};

namespace detail {

struct Turning {
  Field up, aside;
};

// Leg with circulation s: f = g (0, -z, y), q = 1/(B r^3) + x (2 - x/r) g^2 in which the first x is
// not scaled; see the header of this file, with w = -e_y and w = -e_z.
inline void turn_legs(const Tile& tile, const Point& vertex, double surface, double core2, double B,
                      double circulation, Turning& out) {
  const Pack s(0.25 * std::numbers::inv_pi * circulation);
  for (int i = 0; i < tile.padded; i += kLanes) {
    const auto [x, y, z] = tile.point.load(i) - packed(vertex);
    const Leg leg(x, y * y + z * z + core_of(tile, i, surface, core2));
    const Pack X = x * Pack(B), g = leg.g, u = leg.inverse_r;
    const Pack q = u * u * u * Pack(1.0 / B) + X * (Pack(2.0) - x * u) * g * g;
    out.up.add(i, {-(s * y * g), s * (X * g - z * z * q), s * y * z * q});
    out.aside.add(i, {-(s * z * g), s * y * z * q, s * (X * g - y * y * q)});
  }
}

// Derivative of the bound vortex' velocity (scaled axes) as a and b change by da and db.
inline Pack3 turn_bound(const Pack3& a, const Pack3& b, Pack ra, Pack rb, const Pack3& da,
                        const Pack3& db) {
  const Pack p = ra * rb, ab = dot(a, b), zero(0.0);
  const Pack h = bound_factor(p, ab, ra + rb);
  const Pack dra = dot(a, da) / ra, drb = dot(b, db) / rb, dp = dra * rb + ra * drb;
  const Pack dab = dot(da, b) + dot(a, db);
  const auto off = h > zero;
  const Pack den = select(off, p * (p + ab), Pack(1.0));
  const Pack dh = select(off, (dra + drb - h * (dp * (p + ab) + p * (dp + dab))) / den, zero);
  return h * (cross(da, b) + cross(a, db)) + dh * cross(a, b);
}

// With Prandtl-Glauert the bound vortices, too, feel which way the stream goes.
inline void turn_bounds(const FromVertex& from, const FromVertex& to, int padded, double B,
                        double circulation, Turning& out) {
  const Pack s(0.25 * std::numbers::inv_pi * circulation), k(1.0 / B), K(B), zero(0.0);
  for (int i = 0; i < padded; i += kLanes) {
    const Pack3 a = from.arm.load(i), b = to.arm.load(i);
    const Pack ra = Pack::load(from.r + i), rb = Pack::load(to.r + i);
    Pack3 v = bound_factor(ra * rb, dot(a, b), ra + rb) * cross(a, b);
    v.x *= k;
    const Pack3 up =
        turn_bound(a, b, ra, rb, {a.z * k, zero, -(a.x * K)}, {b.z * k, zero, -(b.x * K)});
    out.up.add(i, s * Pack3{up.x * k - v.z, up.y, up.z + v.x});
    const Pack3 aside =
        turn_bound(a, b, ra, rb, {-(a.y * k), a.x * K, zero}, {-(b.y * k), b.x * K, zero});
    out.aside.add(i, s * Pack3{aside.x * k + v.y, aside.y - v.x, aside.z});
  }
}

}  // namespace detail

// At the first `count` points, for the given circulation of all panels.
inline Turned turned(const Lattice& lattice, const WindLattice& wind, const Points& points,
                     int count, const Values& circulation) {
  Turned out{Points(count), Points(count)};
  if (std::all_of(circulation.begin(), circulation.end(), [](double g) { return g == 0.0; }))
    return out;
  // Circulation of the legs, positive downstream. Behind the trailing edge the legs of a strip's
  // panels are one.
  Values leg(wind.vertices.size()), wake(wind.trailing.size()), surface_of(wind.trailing.size());
  for (const Row& row : lattice.rows)
    for (int k = 0; k <= row.panels; ++k) {
      double& of = leg[row.vertex + k];
      if (k > 0) of = circulation[row.panel + k - 1];
      if (k < row.panels) of -= circulation[row.panel + k];
      wake[row.trailing + k] += of;
      surface_of[row.trailing + k] = row.surface;
    }
  FromVertex one, other, end;
  FromVertex *a = &one, *b = &other;
  for (int begin = 0; begin < count; begin += kTile) {
    const Tile tile(points, wind.surface, begin, count);
    detail::Turning sum{};
    for (std::size_t k = 0; k < wake.size(); ++k)
      detail::turn_legs(tile, wind.trailing[k], surface_of[k], wind.core2, wind.B, wake[k], sum);
    if (wind.B != 1.0)
      for (const Row& row : lattice.rows)
        for (int k = 0; k <= row.panels; ++k) {
          const double surface = row.surface;
          see_edge(tile, wind.trailing[row.trailing + k], surface, wind.core2, end);
          see(tile, wind.vertices[row.vertex + k], end, surface, wind.core2, *b);
          detail::turn_bounds(*b, end, tile.padded, wind.B, leg[row.vertex + k], sum);
          if (k > 0)
            detail::turn_bounds(*a, *b, tile.padded, wind.B, circulation[row.panel + k - 1], sum);
          std::swap(a, b);
        }
    for (int i = 0; i < tile.count; ++i) {
      out.up[begin + i] = sum.up.get(i);
      out.aside[begin + i] = sum.aside.get(i);
    }
  }
  return out;
}

}  // namespace alula::lattice
