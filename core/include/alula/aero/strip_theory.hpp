#pragma once
// Strip theory: loads of an aircraft from those of the sections of its lifting surfaces, with the
// slipstream of a propeller, its swirl, and the wing's downwash at the tail. All angles of attack
// and sideslip. Pusztai 2018, 2.2, in vectors: docs/methods/strip_theory.md.
#include <array>
#include <cmath>

#include "alula/aero/section.hpp"
#include "alula/math/bounded.hpp"
#include "alula/math/vec3.hpp"

namespace alula {

inline constexpr int kMaxStrips = 256;
inline constexpr int kMaxSurfaces = 8;
inline constexpr int kStripControls = 4;  // de da dr df

// Body axes, m from the moment reference. Axes are unit vectors: `chord` forward along the section,
// `normal` to its upper side (of a fin: the right one), both normal to the quarter-chord line.
template <class T>
struct Strip {
  Vec3<T> point;  // of the quarter-chord line, mid-strip
  Vec3<T> chord, normal;
  T length, area;  // chord normal to the line, m; m2
  T half_width;    // along the line, m
  Flap<T> flap;
  T gain[kStripControls];  // deflection, trailing edge away from `normal`, over each control
};

template <class T>
struct StripSurface {
  SectionTable<T> sections;
  int first = 0, count = 0;  // of its strips
  T k{1};                    // lift of the finite wing over that of its sections
  T induced{0};              // 1/(pi e A): induced drag over the square of lift
  T lift_slope{1};           // k c_l_alpha
  T downwash{0};             // gradient that it feels
  bool wing = false;         // whether it makes the downwash: before those that feel it
};

template <class T>
struct StripAircraft {
  T S{1}, b{1}, c{1};
  T CD_body{0};      // parasitic drag along the airspeed
  Vec3<T> center{};  // center of gravity, from the moment reference: rates turn about it
  Vec3<T> hub{};     // a point of the slipstream's axis, which is along x
  T incidence{0};    // of the wing; for the downwash by angle
  bool downwash_by_angle =
      false;  // gradient times alpha + incidence (his), else by the wing's lift
  Bounded<StripSurface<T>, kMaxSurfaces> surfaces{};
  Bounded<Strip<T>, kMaxStrips> strips{};
};

// Everything over the airspeed V.
template <class S>
struct StripFlow {
  S alpha, beta;
  Vec3<S> rates;  // 1/m: p/V, q/V, r/V
  S controls[kStripControls];
  S wash;    // (U_i - u_0)/V: excess of axial speed in the slipstream
  S swirl;   // 1/m: Omega_i/V
  S radius;  // m: R_i; 0: no slipstream
};

// Over the dynamic pressure of the free stream and the area S, body axes; moments not yet over b,
// c.
template <class S>
struct StripLoads {
  Vec3<S> force{S(0), S(0), S(0)}, moment{S(0), S(0), S(0)};
  S lift{0};  // sum of area times c_l
};

namespace detail {

// Which part of the strip lies inside the slipstream: the piece of its line that the circle cuts
// off, so that nothing jumps as the radius grows.
template <class S, class T>
S covered(const Strip<T>& strip, const Vec3<T>& hub, const S& radius) {
  using std::sqrt;
  const Vec3<T> line = cross(strip.chord, strip.normal);
  const T y = strip.point.y - hub.y, z = strip.point.z - hub.z;
  const T square = line.y * line.y + line.z * line.z;
  if (!(square > T(0)) || !(value_of(radius) > T(0))) return S(0);
  const T middle = -(y * line.y + z * line.z) / square;
  const T miss = y * y + z * z - middle * middle * square;
  const S left = radius * radius - miss;
  if (!(value_of(left) > T(0))) return S(0);
  const S reach = sqrt(left * (T(1) / square));
  const T h = strip.half_width;
  S from = middle - reach, to = middle + reach;
  if (value_of(from) < -h) from = S(-h);
  if (value_of(to) > h) to = S(h);
  const S part = (T(0.5) / h) * (to - from);
  return select(value_of(part) > T(0), part, S(0));
}

// Adds `share` of a strip's loads in the flow v (its own velocity against the air, over V).
template <class S, class T>
void add_section(const StripSurface<T>& surface, const Strip<T>& strip, const Vec3<S>& v,
                 const S& share, const S& delta, StripLoads<S>& out) {
  using std::atan2;
  using std::sqrt;
  const S forward = dot(v, strip.chord), up = -dot(v, strip.normal);
  const S pressure = forward * forward + up * up;
  if (!(value_of(pressure) > T(0))) return;
  const S inverse = T(1) / sqrt(pressure);
  const S cosine = inverse * forward, sine = inverse * up;
  S c_l, c_d, c_m;
  if (value_of(delta) == T(0) && !(strip.flap.c_l_delta != T(0))) {
    const auto c = section_at(surface.sections, S(atan2(up, forward)));
    c_l = c.c_l, c_d = c.c_d, c_m = c.c_m;
  } else {
    const FlapEffect<S> flap = flap_effect(strip.flap, delta);
    const S fading = flap_fading(cosine);
    const auto c = section_at(surface.sections, S(atan2(up, forward) + flap.shift));
    c_l = c.c_l + surface.k * (fading * flap.lift);
    c_d = c.c_d;
    c_m = c.c_m + strip.flap.c_m_delta * (fading * delta);
  }
  c_d += surface.induced * (c_l * c_l);
  const S weight = share * strip.area;
  const S load = weight * pressure;
  // Lift is normal to the strip's own flow, drag along it.
  const S along = c_l * sine - c_d * cosine, across = c_l * cosine + c_d * sine;
  const Vec3<S> force = load * (along * strip.chord + across * strip.normal);
  const Vec3<S> pitch = (load * strip.length * c_m) * cross(strip.chord, strip.normal);
  out.force = out.force + force;
  out.moment = out.moment + cross(strip.point, force) + pitch;
  out.lift += weight * c_l;
}

}  // namespace detail

// Loads of one surface. epsilon: downwash angle there, rad.
template <class S, class T>
StripLoads<S> surface_loads(const StripAircraft<T>& a, int which, const StripFlow<S>& flow,
                            const S& epsilon) {
  const StripSurface<T>& surface = a.surfaces[which];
  S sa, ca, sb, cb, se, ce;
  sincos(flow.alpha, sa, ca);
  sincos(flow.beta, sb, cb);
  sincos(epsilon, se, ce);
  const Vec3<S> v{ca * cb, sb, sa * cb};
  StripLoads<S> out;
  for (int i = surface.first; i < surface.first + surface.count; ++i) {
    const Strip<T>& strip = a.strips[i];
    S delta(0);
    for (int k = 0; k < kStripControls; ++k) delta += strip.gain[k] * flow.controls[k];
    const auto turned = [&](const Vec3<S>& u) {
      return Vec3<S>{u.x * ce + u.z * se, u.y, u.z * ce - u.x * se};
    };
    const Vec3<S> free = v + cross(flow.rates, strip.point - a.center);  // Eq. (2.42)
    const S inside = detail::covered(strip, a.hub, flow.radius);
    if (value_of(inside) < T(1))
      detail::add_section(surface, strip, turned(free), S(T(1) - inside), delta, out);
    if (value_of(inside) > T(0)) {
      // The air goes aft by the excess and around the axis: Eqs. (2.38), (2.39).
      const Vec3<S> washed{free.x + flow.wash, free.y + flow.swirl * (strip.point.z - a.hub.z),
                           free.z - flow.swirl * (strip.point.y - a.hub.y)};
      detail::add_section(surface, strip, turned(washed), inside, delta, out);
    }
  }
  return out;
}

// CX CY CZ Cl Cm Cn, body axes.
template <class S, class T>
std::array<S, 6> strip_coefficients(const StripAircraft<T>& a, const StripFlow<S>& flow) {
  S epsilon(0);
  if (a.downwash_by_angle) epsilon = flow.alpha + a.incidence;
  StripLoads<S> all;
  for (int i = 0; i < a.surfaces.size(); ++i) {
    const StripSurface<T>& surface = a.surfaces[i];
    const StripLoads<S> one = surface_loads(a, i, flow, S(surface.downwash * epsilon));
    all.force = all.force + one.force;
    all.moment = all.moment + one.moment;
    if (!surface.wing || a.downwash_by_angle) continue;
    T area(0);
    for (int j = surface.first; j < surface.first + surface.count; ++j) area += a.strips[j].area;
    epsilon = (T(1) / (area * surface.lift_slope)) * one.lift;  // angle that attached flow asks for
  }
  S sa, ca, sb, cb;
  sincos(flow.alpha, sa, ca);
  sincos(flow.beta, sb, cb);
  const T k = T(1) / a.S;
  return {k * all.force.x - a.CD_body * ca * cb,
          k * all.force.y - a.CD_body * sb,
          k * all.force.z - a.CD_body * sa * cb,
          (k / a.b) * all.moment.x,
          (k / a.c) * all.moment.y,
          (k / a.b) * all.moment.z};
}

}  // namespace alula
