#pragma once
// Blade elements, each with its own ring of the wake: thrust and torque of any propeller.
#include <cmath>

#include "alula/propulsion/blade_shape.hpp"
#include "alula/propulsion/momentum_propeller.hpp"
#include "alula/propulsion/section_polar.hpp"

namespace alula {

// smooth: Gauss's rule between stations, with the tip's and the hub's square roots taken out.
// stations: what some codes do: the loads at the stations, evenly spaced, times their distance,
// the first and the last one in full.
enum class BladeRule : std::uint8_t { smooth, stations };

template <class T>
struct BladeElementCase {
  T axial_speed{0};  // m/s, against the air along the thrust
  T omega{0};        // rad/s
  T density{1};      // kg/m3
  T viscosity{1};    // kg/(m s)
  T sound{340};      // m/s
  bool tip_loss = true, hub_loss = false, swirl = true;
  BladeRule rule = BladeRule::smooth;
};

template <class T>
struct BladeElement {
  T thrust{0}, torque{0};  // of all blades, per length: N/m, N
  T inflow{0};             // phi, rad
  T speed{0};              // W, m/s
  T alpha{0}, c_l{0}, c_d{0};
  bool solved = false;
};

// Part of the momentum that reaches the ring near a tip or hub: Prandtl's factor with f from the
// helix of the wake, Glauert 1935.
template <class T>
T prandtl_factor(T f) {
  return T(0.636619772367581343) * std::acos(std::exp(-f));
}

// One ring, r in m. The unknown is the angle phi at which the air meets the blade, as in Ning 2014
// (Wind Energy 17), in a form without his poles. With W the speed and s = N c/(2 pi r), momentum
// says V = W (sin(phi) - s c_n/(4 F sin(phi))) and w r = W (cos(phi) + s c_t/(4 F sin(phi))), so
//   V (F sin(phi) cos(phi) + s c_t/4) = w r (F sin(phi)^2 - s c_n/4),
//   W = (V sin(phi) + w r cos(phi)) F sin(phi)/(F sin(phi) + s c_d/4),
// good at rest (V = 0) and at the tip (F = 0) too. Searched from a right angle down, so that of
// several solutions it is the one with the least angle of attack: attached flow.
template <class T>
BladeElement<T> blade_element(const BladeShape<T>& blade, const SectionPolar<T>* polars,
                              int polar_count, const BladeElementCase<T>& c, T r) {
  constexpr T kPi = T(3.14159265358979323846);
  const T x = r / blade.radius, chord = chord_at(blade, x) * blade.radius;
  const T pitch = pitch_at(blade, x), around = c.omega * r;
  const T solidity = T(blade.count) * chord / (T(2) * kPi * r);
  T part = T(0);
  const int panel = polar_count > 1 ? panel_of(blade, x, part) : 0;

  T sine, cosine, F, normal, tangential, W;
  SectionLoads<T> loads{};
  const auto evaluate = [&](T phi) {
    sine = std::sin(phi);
    cosine = std::cos(phi);
    F = T(1);
    if (c.tip_loss) F *= prandtl_factor(T(0.5) * T(blade.count) * (T(1) - x) / (x * sine));
    if (c.hub_loss && blade.hub > T(0))
      F *= prandtl_factor(T(0.5) * T(blade.count) * (x - blade.hub) / (blade.hub * sine));
    const T met = c.axial_speed * sine + around * cosine;
    const T reynolds = c.density * met * chord / c.viscosity, mach = met / c.sound;
    loads = section_loads(polars[panel], pitch - phi, reynolds, mach);
    if (part > T(0) && polar_count > 1) {
      const SectionLoads<T> next = section_loads(polars[panel + 1], pitch - phi, reynolds, mach);
      loads.c_l += part * (next.c_l - loads.c_l);
      loads.c_d += part * (next.c_d - loads.c_d);
    }
    normal = loads.c_l * cosine - loads.c_d * sine;
    tangential = loads.c_l * sine + loads.c_d * cosine;
    const T turned = c.swirl ? T(0.25) * solidity * tangential : T(0);
    const T pushed = T(0.25) * solidity * normal;
    W = c.swirl ? met * F * sine / (F * sine + T(0.25) * solidity * loads.c_d) : around / cosine;
    return around * (F * sine * sine - pushed) - c.axial_speed * (F * sine * cosine + turned);
  };

  BladeElement<T> out;
  constexpr int kSteps = 48;
  T high = T(0.5) * kPi * (T(1) - T(1e-6)), f_high = evaluate(high);
  if (!(f_high >= T(0))) return out;
  for (int i = kSteps - 1; i >= 0; --i) {
    const T share = T(i) / T(kSteps), low = i > 0 ? T(0.5) * kPi * share * share : T(1e-7);
    const T f_low = evaluate(low);
    if (f_low < T(0)) {
      out.inflow = bracketed_root(evaluate, low, f_low, high, f_high);
      evaluate(out.inflow);
      const T q = T(0.5) * c.density * W * W * chord * T(blade.count);
      out.speed = W;
      out.alpha = pitch - out.inflow;
      out.c_l = loads.c_l;
      out.c_d = loads.c_d;
      out.thrust = q * normal;
      out.torque = q * tangential * r;
      out.solved = std::isfinite(out.thrust) && std::isfinite(out.torque);
      return out;
    }
    high = low;
    f_high = f_low;
  }
  return out;
}

template <class T>
struct BladeLoads {
  T thrust{0}, torque{0};  // N, N m
  PropellerRegime regime = PropellerRegime::unsolved;
};

// polars: one for all stations or one per station (between them their loads are mixed).
template <class T>
BladeLoads<T> blade_loads(const BladeShape<T>& blade, const SectionPolar<T>* polars,
                          int polar_count, const BladeElementCase<T>& c) {
  BladeLoads<T> out;
  if (!(c.omega > T(0))) {
    out.regime = PropellerRegime::standing;
    return out;
  }
  if (c.axial_speed < T(0)) {
    out.regime = PropellerRegime::reverse;
    return out;
  }
  bool solved = true;
  const auto add = [&](T x, T weight) {
    const BladeElement<T> e = blade_element(blade, polars, polar_count, c, x * blade.radius);
    solved = solved && e.solved;
    out.thrust += weight * blade.radius * e.thrust;
    out.torque += weight * blade.radius * e.torque;
  };
  if (c.rule == BladeRule::stations) {
    const int n = blade.stations;
    const T step = (blade.r[static_cast<unsigned>(n - 1)] - blade.r[0]) / T(n - 1);
    for (int i = 0; i < n; ++i) add(blade.r[static_cast<unsigned>(i)], step);
  } else {
    for_pieces(blade, [&](T begin, T end) {
      const bool tip = c.tip_loss && !(end < T(1)), hub = c.hub_loss && !(begin > blade.hub);
      for (int i = 0; i < kGaussPoints; ++i) {
        const T s = T(0.5) * (T(1) + T(kGaussAt[i])), w = T(0.5) * T(kGaussWeight[i]);
        const T h = end - begin;
        if (tip)
          add(end - h * s * s, T(2) * h * s * w);
        else if (hub)
          add(begin + h * s * s, T(2) * h * s * w);
        else
          add(begin + h * s, h * w);
      }
    });
  }
  out.regime = !solved             ? PropellerRegime::unsolved
               : out.torque < T(0) ? PropellerRegime::windmill
                                   : PropellerRegime::inside;
  return out;
}

}  // namespace alula
