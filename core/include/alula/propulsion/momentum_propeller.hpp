#pragma once
// A propeller as a momentum disk that turns its wake, with blades that stall from the hub outward:
// Pusztai 2018, section 2.1 and appendix B.1.
#include <array>
#include <cstdint>

#include "alula/math/dual.hpp"
#include "alula/math/vec3.hpp"
#include "alula/propulsion/hub_coefficients.hpp"

namespace alula {

// Outside the model there is no number to trust: a propeller that stands, air from behind, and the
// windmill, where the air drives the shaft or is stopped in the wake (2 J1 <= J0).
enum class PropellerRegime : std::uint8_t { inside, standing, reverse, windmill, unsolved };

template <class T>
struct DiskState {
  T J{0};      // V/(n D) of the flight
  T J0{0};     // u0/(w' R), Eq. (B.1)
  T J1{0};     // u1/(w' R), Eq. (2.21)
  T ratio{1};  // w'/w: turning speed against the swirl at the disk, over the shaft's
  HubCoefficients<T> c{};
  PropellerRegime regime = PropellerRegime::unsolved;
};

// The flight that belongs to J1. Eq. (B.2), and w' = w - Omega_1 by Eqs. (2.9), (2.11): with the
// shaft's torque -C_Mx rho w'^2 R^5 that is w' (1 - C_Mx (2 J1 - J0)/(pi J1^2)) = w, exactly, where
// (B.3) is its estimate.
template <class T>
DiskState<T> disk_at(const BladeShape<T>& blade, const BladeAerodynamics<T>& a, T J1) {
  const T pi = T(3.14159265358979323846);
  DiskState<T> s;
  s.J1 = J1;
  s.c = hub_coefficients(blade, a, J1);
  s.J0 = J1 - s.c.of[kFx] / (T(2) * pi * J1);
  s.ratio = T(1) / (T(1) - s.c.of[kMx] * (T(2) * J1 - s.J0) / (pi * J1 * J1));
  s.J = pi * s.J0 * s.ratio;
  const bool drives = s.c.of[kMx] > T(0), stops = !(T(2) * J1 > s.J0);
  s.regime = drives || stops ? PropellerRegime::windmill : PropellerRegime::inside;
  return s;
}

// Root of f between low (f < 0) and high (f >= 0) to rounding: secants that keep the bracket
// (Illinois), every third step a bisection.
template <class T, class F>
T bracketed_root(const F& f, T low, T f_low, T high, T f_high) {
  int side = 0;
  for (int i = 0; i < 90 && high > low; ++i) {
    T x = i % 3 == 2 ? T(0.5) * (low + high) : (low * f_high - high * f_low) / (f_high - f_low);
    if (!(x > low && x < high)) x = T(0.5) * (low + high);
    if (!(x > low && x < high)) break;
    const T y = f(x);
    if (y < T(0)) {
      low = x;
      f_low = y;
      if (side == -1) f_high *= T(0.5);
      side = -1;
    } else {
      high = x;
      f_high = y;
      if (side == 1) f_low *= T(0.5);
      side = 1;
      if (y == T(0)) break;
    }
  }
  return high;
}

// J1 of the static propeller: J1^2 = C_Fx/(2 pi), Eq. (B.2) with J0 = 0. Zero where it gives no
// static thrust.
template <class T>
T static_J1(const BladeShape<T>& blade, const BladeAerodynamics<T>& a) {
  const auto f = [&](T J1) {
    return J1 * J1 - hub_coefficients(blade, a, J1).of[kFx] / T(6.283185307179586);
  };
  T low = T(1e-4), f_low = f(low);
  if (!(f_low < T(0))) return T(0);
  for (int i = 0; i < 60; ++i) {
    const T high = low + T(0.05), f_high = f(high);
    if (!(f_high < T(0))) return bracketed_root(f, low, f_low, high, f_high);
    low = high;
    f_low = f_high;
  }
  return T(0);
}

// The disk at a flight's advance ratio J = V/(n D). Marched from the static state up, so that the
// solution is the one that belongs to it; at most some 150 evaluations.
template <class T>
DiskState<T> disk_of(const BladeShape<T>& blade, const BladeAerodynamics<T>& a, T J) {
  DiskState<T> s;
  s.J = J;
  if (J < T(0)) {
    s.regime = PropellerRegime::reverse;
    return s;
  }
  T low = static_J1(blade, a);
  if (!(low > T(0))) return s;
  if (J == T(0)) {
    s = disk_at(blade, a, low);
    s.J = s.J0 = T(0);
    return s;
  }
  const auto f = [&](T J1) { return disk_at(blade, a, J1).J - J; };
  T f_low = -J, step = T(0.02);
  for (int i = 0; i < 60; ++i) {
    const T high = low + step;
    const DiskState<T> next = disk_at(blade, a, high);
    const T f_high = next.J - J;
    if (!(f_high < T(0))) return disk_at(blade, a, bracketed_root(f, low, f_low, high, f_high));
    // Behind the windmill the drag of stalled blades may ask for power again.
    if (next.regime == PropellerRegime::windmill) break;
    low = high;
    f_low = f_high;
    step *= T(1.1);
  }
  s.regime = PropellerRegime::windmill;
  return s;
}

// Where the shaft's torque ends: the windmill begins behind this advance ratio. Zero where the
// propeller gives no static thrust or turns the air's energy into none before J1 = 6.
template <class T>
T windmill_J(const BladeShape<T>& blade, const BladeAerodynamics<T>& a) {
  T low = static_J1(blade, a);
  if (!(low > T(0))) return T(0);
  const auto inside = [&](T J1) { return disk_at(blade, a, J1).regime == PropellerRegime::inside; };
  T step = T(0.02);
  for (int i = 0; i < 60 && inside(low); ++i) {
    T high = low + step;
    step *= T(1.1);
    if (inside(high)) {
      low = high;
      continue;
    }
    for (int k = 0; k < 60; ++k) {
      const T middle = T(0.5) * (low + high);
      (inside(middle) ? low : high) = middle;
    }
    return disk_at(blade, a, low).J;
  }
  return T(0);
}

// The J0-J1 solution over J from zero to the windmill, evenly spaced: one lookup is one division
// and a cubic, whatever J. Coefficients are per the shaft's own speed w: forces rho w^2 R^4.
inline constexpr int kMomentumKnots = 49;

template <class T>
struct MomentumTable {
  T radius{1};
  T sense{1};                                                             // +1: right-hand
  T last{0};                                                              // J of the windmill
  std::array<std::array<T, kHubLoads>, kMomentumKnots> value{}, slope{};  // slope: per knot
};

// False, and `out` as it was, where the propeller has no solution from J = 0 to the windmill.
template <class T>
bool make_momentum_table(const BladeShape<T>& blade, const BladeAerodynamics<T>& a, T sense,
                         MomentumTable<T>& out) {
  MomentumTable<T> table;
  table.radius = blade.radius;
  table.sense = sense;
  table.last = windmill_J(blade, a);
  if (!(table.last > T(0))) return false;
  constexpr unsigned n = kMomentumKnots;
  for (unsigned i = 0; i < n; ++i) {
    // The last knot stays a hair inside: behind it the search may say windmill.
    const T J = table.last * (T(i) / T(n - 1)) * (T(1) - T(1e-7));
    const DiskState<T> s = disk_of(blade, a, J);
    if (s.regime == PropellerRegime::unsolved) return false;
    for (unsigned k = 0; k < kHubLoads; ++k)
      table.value[i][k] = s.c.of[k] * s.ratio * (k == kFx || k == kMx ? s.ratio : T(1));
  }
  for (unsigned k = 0; k < kHubLoads; ++k) {
    const auto y = [&](unsigned i) { return table.value[i][k]; };
    table.slope[0][k] = T(2) * y(1) - T(1.5) * y(0) - T(0.5) * y(2);
    table.slope[n - 1][k] = T(1.5) * y(n - 1) - T(2) * y(n - 2) + T(0.5) * y(n - 3);
    for (unsigned i = 1; i + 1 < n; ++i) table.slope[i][k] = T(0.5) * (y(i + 1) - y(i - 1));
  }
  out = table;
  return true;
}

template <class S>
struct HubLoads {
  Vec3<S> force{S(0), S(0), S(0)};   // N on the aircraft, axes of the hub
  Vec3<S> moment{S(0), S(0), S(0)};  // N m about the hub; the shaft's reaction is its x
  S torque{0};                       // N m that the shaft must give
  PropellerRegime regime = PropellerRegime::standing;
};

// Eq. (2.27). omega: rad/s, of the shaft; v: of the hub against the air, w: rates of the aircraft,
// in axes of the hub: x along the thrust, y and z the aircraft's turned with it. Outside the model
// the coefficients of its end are held and the regime says so; a standing propeller has no loads.
//
// For a left-hand propeller the aircraft is mirrored: v, the rates p and r, F_y, M_x and M_z change
// their signs, which leaves the sense before M_x, F per rate and M per speed.
template <class S, class T>
HubLoads<S> hub_loads(const MomentumTable<T>& table, const S& omega, const Vec3<S>& v,
                      const Vec3<S>& w, const S& density) {
  HubLoads<S> out;
  if (!(value_of(omega) > T(0)) || !(table.last > T(0))) return out;
  const T R = table.radius, pi = T(3.14159265358979323846);
  const S J = (pi / R) * v.x / omega;
  out.regime = PropellerRegime::inside;
  S at = (T(kMomentumKnots - 1) / table.last) * J;
  if (value_of(J) < T(0)) {
    out.regime = PropellerRegime::reverse;
    at = S(0);
  } else if (value_of(J) > table.last) {
    out.regime = PropellerRegime::windmill;
    at = S(T(kMomentumKnots - 1));
  }
  int knot = static_cast<int>(value_of(at));
  if (knot > kMomentumKnots - 2) knot = kMomentumKnots - 2;
  const unsigned i = static_cast<unsigned>(knot);
  const S d = at - T(knot);
  const auto of = [&](unsigned k) {
    const T y = table.value[i][k], rise = table.value[i + 1][k] - y;
    const T m0 = table.slope[i][k], m1 = table.slope[i + 1][k];
    return S(y + d * (m0 + d * ((T(3) * rise - T(2) * m0 - m1) + d * (m0 + m1 - T(2) * rise))));
  };
  const S square = (R * R * R) * density * omega;
  const S full = R * square * omega;
  const S FV = square * of(kFyV), FQ = (table.sense * R) * square * of(kFyQ);
  const S MV = (table.sense * R) * square * of(kMyV), MQ = (R * R) * square * of(kMyQ);
  out.torque = -R * full * of(kMx);
  out.force = {full * of(kFx), FV * v.y + FQ * w.y, FV * v.z + FQ * w.z};
  out.moment = {-table.sense * out.torque, MV * v.y + MQ * w.y, MV * v.z + MQ * w.z};
  return out;
}

}  // namespace alula
