#pragma once
// What horseshoes of unit circulation induce at points: W points side by side in a vector register.
//
// Katz and Plotkin, Low-Speed Aerodynamics, 2nd ed. (2001), Sec. 2.12 and 12.1, with the bound
// vortex in the form that is regular on its extension, (a x b)(|a| + |b|) / (|a||b|(|a||b| + a.b)).
// A leg costs a root and a division, a bound vortex one division more; the part of the legs behind
// the trailing edge is shared by all panels of a strip.
#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "alula/host/vortex_lattice_panels.hpp"
#include "alula/math/lanes.hpp"

namespace alula::lattice {

inline constexpr int kTile = 64;   // points at a time
inline constexpr int kBlock = 32;  // panels at a time

using Pack = Lanes<double, kLanes>;
using Pack3 = Vec3<Pack>;

inline Pack3 packed(const Point& p) { return {Pack(p.x), Pack(p.y), Pack(p.z)}; }

// A vector at each point of a tile.
struct Field {
  alignas(64) double x[kTile], y[kTile], z[kTile];

  Pack3 load(int i) const { return {Pack::load(x + i), Pack::load(y + i), Pack::load(z + i)}; }
  void store(int i, const Pack3& v) { v.x.store(x + i), v.y.store(y + i), v.z.store(z + i); }
  void add(int i, const Pack3& v) { store(i, load(i) + v); }
  Point get(int i) const { return {x[i], y[i], z[i]}; }
  void set(int i, const Point& p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }
};

// Points in wind axes, x scaled; the last one repeated to fill whole registers.
struct Tile {
  int first = 0, count = 0, padded = 0;
  Field point;
  alignas(64) double surface[kTile];

  // Those from `begin` on, of `end` in all.
  Tile(const Points& points, const Values& of, int begin, int end)
      : first(begin),
        count(std::min(kTile, end - begin)),
        padded((count + kLanes - 1) / kLanes * kLanes) {
    for (int i = 0; i < padded; ++i) {
      const int k = begin + std::min(i, count - 1);
      point.set(i, points[k]);
      surface[i] = of[k];
    }
  }
};

// The points seen from a place of the lattice, and what the leg from there on induces (times 4 pi,
// scaled axes).
struct FromVertex {
  Field arm, leg;
  alignas(64) double r[kTile];
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
inline void see_edge(const Tile& tile, const Point& edge, double surface, double core2,
                     FromVertex& out) {
  for (int i = 0; i < tile.padded; i += kLanes) {
    const Pack3 a = tile.point.load(i) - packed(edge);
    const Leg leg(a.x, a.y * a.y + a.z * a.z + core_of(tile, i, surface, core2));
    out.arm.store(i, a), leg.r.store(out.r + i);
    out.leg.store(i, {Pack(0.0), -(a.z * leg.g), a.y * leg.g});
  }
}

// From a bound vortex' end: along the surface to the trailing edge, then on.
inline void see(const Tile& tile, const Point& vertex, const FromVertex& edge, double surface,
                double core2, FromVertex& out) {
  for (int i = 0; i < tile.padded; i += kLanes) {
    const Pack3 a = tile.point.load(i) - packed(vertex), e = edge.arm.load(i);
    const Pack r = sqrt(dot(a, a) + core_of(tile, i, surface, core2)), re = Pack::load(edge.r + i);
    const Pack h = bound_factor(r * re, dot(a, e), r + re);
    out.arm.store(i, a), r.store(out.r + i);
    out.leg.store(i, edge.leg.load(i) + h * cross(a, e));
  }
}

// Bound vortex from a to b with its two legs.
inline void horseshoes(const FromVertex& from, const FromVertex& to, int padded, double B,
                       Field& out) {
  const Pack scale(0.25 * std::numbers::inv_pi), scale_x(0.25 * std::numbers::inv_pi / B);
  for (int i = 0; i < padded; i += kLanes) {
    const Pack3 a = from.arm.load(i), b = to.arm.load(i);
    const Pack ra = Pack::load(from.r + i), rb = Pack::load(to.r + i);
    const Pack h = bound_factor(ra * rb, dot(a, b), ra + rb);
    const Pack3 v = h * cross(a, b) + (to.leg.load(i) - from.leg.load(i));
    out.store(i, {scale_x * v.x, scale * v.y, scale * v.z});
  }
}

// The horseshoes' velocities at a tile, block after block along the rows:
// for (Blocks b(lattice, wind, tile); b.next();) use(b.panel, b.count, b.velocity);
class Blocks {
 public:
  int panel = 0, count = 0;  // the block's first panel, and how many it has
  std::vector<Field> velocity = std::vector<Field>(kBlock);

  Blocks(const Lattice& lattice, const WindLattice& wind, const Tile& tile)
      : lattice_(lattice), wind_(wind), tile_(tile) {}

  bool next() {
    panel += count;
    if (panel == lattice_.panels()) return false;
    const Row* row = &lattice_.rows[row_];
    if (panel == row->panel + row->panels) row = &lattice_.rows[++row_];
    const double surface = row->surface, core2 = wind_.core2;
    const int done = panel - row->panel;
    if (edges_from_ != row->trailing) {
      edges_from_ = row->trailing;
      edges_.resize(row->panels + 1);
      for (int k = 0; k <= row->panels; ++k)
        see_edge(tile_, wind_.trailing[edges_from_ + k], surface, core2, edges_[k]);
    }
    const Point* vertex = &wind_.vertices[row->vertex];
    if (done == 0) see(tile_, vertex[0], edges_[0], surface, core2, last_[panel % 2]);
    count = std::min(kBlock, row->panels - done);
    for (int k = 0; k < count; ++k) {
      FromVertex &a = last_[(panel + k) % 2], &b = last_[(panel + k + 1) % 2];
      see(tile_, vertex[done + k + 1], edges_[done + k + 1], surface, core2, b);
      horseshoes(a, b, tile_.padded, wind_.B, velocity[k]);
    }
    return true;
  }

 private:
  const Lattice& lattice_;
  const WindLattice& wind_;
  const Tile& tile_;
  FromVertex last_[2];             // by turns
  std::vector<FromVertex> edges_;  // of the rows of one side of a surface
  int row_ = 0, edges_from_ = -1;
};

// Adds the panels' velocities times their circulation, eight registers of one component at a time.
inline void add_up(const Field* block, int count, int padded, const double* circulation,
                   Field& sum) {
  constexpr int kAtOnce = 8 * kLanes;
  static_assert(kTile % kAtOnce == 0);
  for (const auto component : {&Field::x, &Field::y, &Field::z})
    for (int i = 0; i < padded; i += kAtOnce) {
      double* to = sum.*component + i;
      Pack s[8];
#pragma GCC unroll 8
      for (int j = 0; j < 8; ++j) s[j] = Pack::load(to + j * kLanes);
      for (int k = 0; k < count; ++k) {
        const double* from = block[k].*component + i;
#pragma GCC unroll 8
        for (int j = 0; j < 8; ++j) s[j] += Pack(circulation[k]) * Pack::load(from + j * kLanes);
      }
#pragma GCC unroll 8
      for (int j = 0; j < 8; ++j) s[j].store(to + j * kLanes);
    }
}

// Velocities at the first `count` points that the circulations of all panels induce, by column.
inline std::vector<Points> induced(const Lattice& lattice, const WindLattice& wind,
                                   const Points& points, int count, const Columns& circulation) {
  const std::size_t columns = circulation.size();
  std::vector<Points> out(columns, Points(count));
  for (int begin = 0; begin < count; begin += kTile) {
    const Tile tile(points, wind.surface, begin, count);
    std::vector<Field> sum(columns);
    for (Blocks b(lattice, wind, tile); b.next();)
      for (std::size_t c = 0; c < columns; ++c)
        add_up(b.velocity.data(), b.count, tile.padded, &circulation[c][b.panel], sum[c]);
    for (std::size_t c = 0; c < columns; ++c)
      for (int i = 0; i < tile.count; ++i) out[c][begin + i] = sum[c].get(i);
  }
  return out;
}

}  // namespace alula::lattice
