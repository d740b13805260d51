#pragma once
// What horseshoes of unit circulation induce at points: W points side by side in a vector register.
//
// Katz and Plotkin, Low-Speed Aerodynamics, 2nd ed. (2001), Sec. 2.12 and 12.1, with the bound
// vortex in the form that is regular on its extension, (a x b)(|a| + |b|) / (|a||b|(|a||b| + a.b)).
// A leg costs a root and a division, a bound vortex one division more; the part of the legs behind
// the trailing edge is shared by all panels of a strip.
#include <algorithm>
#include <numbers>
#include <vector>

#include "alula/host/vortex_lattice_panels.hpp"
#include "alula/math/lanes.hpp"

namespace alula::lattice {

inline constexpr int kTile = 64;   // points at a time
inline constexpr int kBlock = 32;  // panels at a time

using Pack = Lanes<double, kLanes>;

// Points in wind axes, x scaled; the last one repeated to fill whole registers.
struct Tile {
  int first = 0, count = 0, padded = 0;
  alignas(64) double x[kTile], y[kTile], z[kTile], surface[kTile];

  Tile(const Points& points, const std::vector<double>& of, int begin, int end)
      : first(begin), count(end - begin), padded((count + kLanes - 1) / kLanes * kLanes) {
    for (int i = 0; i < padded; ++i) {
      const int k = begin + std::min(i, count - 1);
      x[i] = points(0, k), y[i] = points(1, k), z[i] = points(2, k);
      surface[i] = of[static_cast<std::size_t>(k)];
    }
  }
};

// The points seen from a place of the lattice, and what the leg from there on induces (times 4 pi,
// scaled axes).
struct FromVertex {
  alignas(64) double x[kTile], y[kTile], z[kTile], r[kTile], fx[kTile], fy[kTile], fz[kTile];
};

// Leg from the origin along +x. D = y^2 + z^2 + core^2, r^2 = x^2 + D;
// g = (1 + x/r)/D = 1/(r (r - x)), each where it does not cancel.
struct Leg {
  Pack r, inverse_r, g;

  Leg(Pack x, Pack D) {
    const Pack zero(0.0);
    r = sqrt(x * x + D);
    const auto behind = x > zero;
    const Pack m = select(behind, D, r - x), t = Pack(1.0) / (r * m);
    inverse_r = t * m;
    g = select(behind, t * (r + x), t);
  }
};

// Smoothed by the core only between different surfaces; 0 within one.
inline Pack core_of(const Tile& tile, int i, double surface, double core2) {
  if (core2 == 0.0) return Pack(0.0);
  return select(Pack::load(tile.surface + i) == Pack(surface), Pack(0.0), Pack(core2));
}

// Zero where a x b vanishes on the vortex itself: within 2e-5 of its length.
inline Pack bound_factor(Pack p, Pack dot, Pack sum) {
  const auto off = p + dot > Pack(1e-9) * p;
  return select(off, sum / select(off, p * (p + dot), Pack(1.0)), Pack(0.0));
}

// From the trailing edge: a leg along the stream, (0, -z, y) g.
inline void see_edge(const Tile& tile, const Eigen::Ref<const Vector3d>& edge, double surface,
                     double core2, FromVertex& out) {
  for (int i = 0; i < tile.padded; i += kLanes) {
    const Pack x = Pack::load(tile.x + i) - Pack(edge[0]);
    const Pack y = Pack::load(tile.y + i) - Pack(edge[1]);
    const Pack z = Pack::load(tile.z + i) - Pack(edge[2]);
    const Leg leg(x, y * y + z * z + core_of(tile, i, surface, core2));
    x.store(out.x + i), y.store(out.y + i), z.store(out.z + i), leg.r.store(out.r + i);
    Pack(0.0).store(out.fx + i), (-(z * leg.g)).store(out.fy + i), (y * leg.g).store(out.fz + i);
  }
}

// From a bound vortex' end: along the surface to the trailing edge, then on.
inline void see(const Tile& tile, const Eigen::Ref<const Vector3d>& vertex, const FromVertex& edge,
                double surface, double core2, FromVertex& out) {
  for (int i = 0; i < tile.padded; i += kLanes) {
    const Pack x = Pack::load(tile.x + i) - Pack(vertex[0]);
    const Pack y = Pack::load(tile.y + i) - Pack(vertex[1]);
    const Pack z = Pack::load(tile.z + i) - Pack(vertex[2]);
    const Pack r = sqrt(x * x + y * y + z * z + core_of(tile, i, surface, core2));
    const Pack ex = Pack::load(edge.x + i), ey = Pack::load(edge.y + i),
               ez = Pack::load(edge.z + i), er = Pack::load(edge.r + i);
    const Pack h = bound_factor(r * er, x * ex + y * ey + z * ez, r + er);
    x.store(out.x + i), y.store(out.y + i), z.store(out.z + i), r.store(out.r + i);
    (h * (y * ez - z * ey)).store(out.fx + i);
    (Pack::load(edge.fy + i) + h * (z * ex - x * ez)).store(out.fy + i);
    (Pack::load(edge.fz + i) + h * (x * ey - y * ex)).store(out.fz + i);
  }
}

// Bound vortex from a to b with its two legs; v: x, y, z, each `stride` apart.
inline void horseshoes(const FromVertex& a, const FromVertex& b, int padded, double B, double* v,
                       int stride) {
  const Pack scale(0.25 * std::numbers::inv_pi), scale_x(0.25 * std::numbers::inv_pi / B);
  for (int i = 0; i < padded; i += kLanes) {
    const Pack ax = Pack::load(a.x + i), ay = Pack::load(a.y + i), az = Pack::load(a.z + i);
    const Pack bx = Pack::load(b.x + i), by = Pack::load(b.y + i), bz = Pack::load(b.z + i);
    const Pack ra = Pack::load(a.r + i), rb = Pack::load(b.r + i);
    const Pack h = bound_factor(ra * rb, ax * bx + ay * by + az * bz, ra + rb);
    const Pack fy = Pack::load(b.fy + i) - Pack::load(a.fy + i);
    const Pack fz = Pack::load(b.fz + i) - Pack::load(a.fz + i);
    const Pack fx = Pack::load(b.fx + i) - Pack::load(a.fx + i);
    (scale_x * (h * (ay * bz - az * by) + fx)).store(v + i);
    (scale * (h * (az * bx - ax * bz) + fy)).store(v + stride + i);
    (scale * (h * (ax * by - ay * bx) + fz)).store(v + 2 * stride + i);
  }
}

// Velocities of `count` panels from `first` on at a tile of points: column per panel, x in the rows
// 0 ..., y from kTile, z from 2 kTile on.
using Block = Eigen::Matrix<double, 3 * kTile, Eigen::Dynamic>;

// Calls use(first panel, count, block) until all horseshoes were had.
template <class Use>
void induce(const Lattice& lattice, const WindLattice& wind, const Tile& tile, Use&& use) {
  FromVertex one, other;
  FromVertex *a = &one, *b = &other;
  Block block(3 * kTile, kBlock);
  std::vector<FromVertex> edges;  // of the rows of one side of a surface
  int edges_from = -1;
  for (int row = 0; row < lattice.rows(); ++row) {
    const std::size_t r = static_cast<std::size_t>(row);
    const double surface = lattice.row_surface[r];
    const int begin = lattice.row_start[r], end = lattice.row_start[r + 1];
    if (edges_from != lattice.row_trailing[r]) {
      edges_from = lattice.row_trailing[r];
      edges.resize(static_cast<std::size_t>(end - begin));
      for (int k = 0; k < end - begin; ++k)
        see_edge(tile, wind.trailing.col(edges_from + k), surface, wind.core2,
                 edges[static_cast<std::size_t>(k)]);
    }
    see(tile, wind.vertices.col(begin), edges[0], surface, wind.core2, *a);
    for (int v = begin + 1; v < end;) {
      const int first = v - 1 - row, count = std::min(kBlock, end - v);
      for (int k = 0; k < count; ++k, ++v) {
        see(tile, wind.vertices.col(v), edges[static_cast<std::size_t>(v - begin)], surface,
            wind.core2, *b);
        horseshoes(*a, *b, tile.padded, wind.B, block.col(k).data(), kTile);
        std::swap(a, b);
      }
      use(first, count, block);
    }
  }
}

// Velocities at the first `count` points that the circulations (panels, k) induce: (3 k, count),
// x of all columns first, then y, z.
inline MatrixXd induced(const Lattice& lattice, const WindLattice& wind, const Points& points,
                        int count, const MatrixXd& circulation) {
  const Eigen::Index k = circulation.cols();
  MatrixXd out(3 * k, count);
  Eigen::Matrix<double, 3 * kTile, Eigen::Dynamic> sum(3 * kTile, k);
  for (int i = 0; i < count; i += kTile) {
    const Tile tile(points, wind.surface, i, std::min(i + kTile, count));
    sum.setZero();
    induce(lattice, wind, tile, [&](int first, int n, const Block& block) {
      sum.noalias() += block.leftCols(n) * circulation.middleRows(first, n);
    });
    for (int axis = 0; axis < 3; ++axis)
      out.block(axis * k, i, k, tile.count) = sum.middleRows(axis * kTile, tile.count).transpose();
  }
  return out;
}

}  // namespace alula::lattice
