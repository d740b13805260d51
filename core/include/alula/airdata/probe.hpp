#pragma once
// Five-hole pressure probe: pressures of a flow, and the flow of pressures.
//
// Port i on the tip feels p_air + q c_p(theta_i), theta_i between the port and the flow (Pusztai
// 2018, Eq. 3.1 to 3.4). Ports 1 and 2 sit port_angle below and above the tip, 3 and 4 to the right
// and left, port 0 on it. Three differences are measured: p0 less the static port, p1 - p2 and
// p3 - p4. Any fit of c_p will do that gives value and slope over cos(theta); between the ports'
// and the flow's direction everything is then algebra, no angle is ever formed.
//
// The inverse is Newton's method in (tan beta', tan alpha, q), beta' the flank angle. It starts
// from the exact solution for c_p = A cos 2 theta + B: with c = p0, r^2 = (p12^2 + p34^2)/K^2,
// K = 4 A sin 2 phi and T the tangent of the whole flow angle,
//   r (A - B) T^2 + c T - r (A + B) = 0,   T = 2 r (A + B) / (c + sqrt(c^2 + 4 r^2 (A^2 - B^2))),
// one root for flow from ahead whatever the sign of p0. Pusztai's (3.9) leaves arcsin's domain
// where p0 vanishes, at 29 deg of alpha and beta together.
#include <cmath>
#include <limits>

#include "alula/math/bounded.hpp"
#include "alula/math/vec3.hpp"

namespace alula::airdata {

template <class S>
struct CpAt {
  S value{}, slope{};  // slope with cos(theta)
};

// c_p = sum of power[k] cos^k(theta) + sine sin(2 theta): every even trigonometric fit, and the
// three terms of Eq. 3.5, a1 sin 2 theta + a2 cos 2 theta + a3 (see three_terms).
template <class S>
struct HarmonicCp {
  Bounded<S, 9> power;
  S sine{};

  constexpr CpAt<S> operator()(S c) const {
    CpAt<S> at;
    for (int k = power.size() - 1; k >= 0; --k) {
      at.slope = at.slope * c + at.value;
      at.value = at.value * c + power[k];
    }
    if (sine != S(0)) {
      const S square = S(1) - c * c, least = std::numeric_limits<S>::epsilon();
      const S s = std::sqrt(square > least ? square : least);  // a cone at theta = 0
      at.value += sine * S(2) * c * s;
      at.slope += sine * S(2) * (s - c * c / s);
    }
    return at;
  }
};

template <class S>
constexpr HarmonicCp<S> three_terms(S a1, S a2, S a3) {
  HarmonicCp<S> cp;
  cp.power.push(a3 - a2);
  cp.power.push(S(0));
  cp.power.push(S(2) * a2);
  cp.sine = a1;
  return cp;
}

template <class S, class Side = HarmonicCp<S>, class Center = Side>
struct Probe {
  Side side;                // c_p of ports 1 to 4
  Center center;            // c_p of port 0
  S port_angle{};           // rad
  S widest{S(1.6)};         // rad, largest theta that the fit of c_p covers
  S domain{S(0.6981317)};   // rad, largest alpha and beta that are reported
  S least{S(1)};            // Pa, below it there is no flow to speak of
  S cosine{S(1)}, sine{};   // of the port angle
  S A{S(1)}, B{}, K{S(1)};  // of the start
};

struct ProbeStatus {
  enum Value : int {
    ok = 0,
    not_finite,      // NaN or infinite pressure
    no_flow,         // pressures too small for an angle: zero airspeed
    from_behind,     // the pressures of no flow from ahead: negative dynamic pressure
    outside_domain,  // converged, outside the range of c_p or of the reported angles
    not_converged,
    saturated,  // a sensor at the end of its range
    stuck,      // a sensor that has not moved for too long
  };
};
inline constexpr int kProbeIterations = 8;

template <class S>
struct ProbePressures {
  S center{}, vertical{}, lateral{};  // p0 - static, p1 - p2, p3 - p4, Pa
};

template <class S>
struct ProbeFlow {
  S q{}, alpha{}, beta{};  // Pa, atan2(w, u), asin(v/V)
  int iterations = 0;
};

// Fills in what follows from the fits and the port angle; call it once. False where the side ports
// see no difference between small angles, or the center port no maximum ahead: no such probe.
template <class S, class Side, class Center>
bool prepare(Probe<S, Side, Center>& probe) {
  probe.cosine = std::cos(probe.port_angle);
  probe.sine = std::sin(probe.port_angle);
  probe.B = probe.center(S(0.70710678118654752)).value;
  probe.A = probe.center(S(1)).value - probe.B;
  probe.K = S(2) * probe.sine * probe.side(probe.cosine).slope;
  return probe.A > std::abs(probe.B) && probe.K > S(0) && std::isfinite(probe.A + probe.K) &&
         probe.widest > S(0) && probe.domain > S(0) && probe.domain < S(1.5);
}

// What is measured in a unit of dynamic pressure, with slopes with the tangents Y = v/u, Z = w/u.
template <class S>
struct ProbeSlopes {
  Vec3<S> value, by_y, by_z;  // each: center, vertical, lateral
  S least_cosine{};           // of the largest theta of any port
};

template <class S, class Side, class Center>
ProbeSlopes<S> probe_slopes(const Probe<S, Side, Center>& probe, S Y, S Z) {
  const S x = S(1) / std::sqrt(S(1) + Y * Y + Z * Z), y = Y * x, z = Z * x;
  const S c = probe.cosine, s = probe.sine;
  // Slopes of the direction (x, y, z) with Y and Z.
  const S x_y = -x * x * y, x_z = -x * x * z;
  const S y_y = x * (S(1) - y * y), z_z = x * (S(1) - z * z), cross_yz = -x * y * z;
  const S below = c * x + s * z, above = c * x - s * z, right = c * x + s * y, left = c * x - s * y;
  const CpAt<S> p0 = probe.center(x);
  const CpAt<S> p1 = probe.side(below), p2 = probe.side(above);
  const CpAt<S> p3 = probe.side(right), p4 = probe.side(left);
  ProbeSlopes<S> f;
  f.value = {p0.value, p1.value - p2.value, p3.value - p4.value};
  f.by_y = {p0.slope * x_y,
            p1.slope * (c * x_y + s * cross_yz) - p2.slope * (c * x_y - s * cross_yz),
            p3.slope * (c * x_y + s * y_y) - p4.slope * (c * x_y - s * y_y)};
  f.by_z = {p0.slope * x_z, p1.slope * (c * x_z + s * z_z) - p2.slope * (c * x_z - s * z_z),
            p3.slope * (c * x_z + s * cross_yz) - p4.slope * (c * x_z - s * cross_yz)};
  const S vertical = below < above ? below : above, lateral = right < left ? right : left;
  const S least = vertical < lateral ? vertical : lateral;
  f.least_cosine = least < x ? least : x;
  return f;
}

template <class S, class Side, class Center>
ProbePressures<S> probe_pressures(const Probe<S, Side, Center>& probe, S q, S alpha, S beta) {
  const S Z = std::tan(alpha), Y = std::tan(beta) / std::cos(alpha);
  const Vec3<S> f = probe_slopes(probe, Y, Z).value;
  return {q * f.x, q * f.y, q * f.z};
}

// Start of the inverse: Y, Z and q; exact for two terms. False where no flow from ahead fits.
template <class S, class Side, class Center>
bool probe_start(const Probe<S, Side, Center>& probe, const ProbePressures<S>& p, S& Y, S& Z,
                 S& q) {
  const S a = p.vertical / probe.K, b = p.lateral / probe.K, r2 = a * a + b * b;
  const S A = probe.A, B = probe.B;
  const S d = p.center + std::sqrt(p.center * p.center + S(4) * r2 * (A * A - B * B));
  const S k = S(2) * (A + B) / d;
  Y = b * k;
  Z = a * k;
  q = (S(1) + Y * Y + Z * Z) / k;
  // Beyond 80 deg no port of the probe sees the flow: what is measured is noise about nothing.
  return d > S(0) && Y * Y + Z * Z < S(32);
}

// The flow of three pressure differences; `flow` is untouched unless ok.
template <class S, class Side, class Center>
ProbeStatus::Value probe_flow(const Probe<S, Side, Center>& probe, const ProbePressures<S>& raw,
                              ProbeFlow<S>& flow) {
  const S size =
      std::sqrt(raw.center * raw.center + raw.vertical * raw.vertical + raw.lateral * raw.lateral);
  if (!std::isfinite(size)) return ProbeStatus::not_finite;
  if (!(size >= probe.least)) return ProbeStatus::no_flow;
  const S unit = S(1) / size;
  const ProbePressures<S> p{raw.center * unit, raw.vertical * unit, raw.lateral * unit};
  S Y{}, Z{}, q{};
  if (!probe_start(probe, p, Y, Z, q)) return ProbeStatus::from_behind;
  // Newton doubles the digits: after a step of this size the next is below rounding.
  const S enough = sizeof(S) == 4 ? S(2e-4) : S(1e-6);
  for (int i = 1; i <= kProbeIterations; ++i) {
    const ProbeSlopes<S> f = probe_slopes(probe, Y, Z);
    // Columns q df/dY, q df/dZ, f; Cramer's rule on the difference.
    const Vec3<S> e{p.center - q * f.value.x, p.vertical - q * f.value.y,
                    p.lateral - q * f.value.z};
    const Vec3<S> normal = cross(f.by_y, f.by_z);
    const S determinant = dot(normal, f.value);
    if (!(std::abs(determinant) > std::numeric_limits<S>::min())) return ProbeStatus::not_converged;
    const S inverse = S(1) / determinant;
    S dY = dot(cross(e, f.by_z), f.value) * inverse / q;
    S dZ = dot(cross(f.by_y, e), f.value) * inverse / q;
    S dq = dot(normal, e) * inverse;
    const S largest = std::fmax(std::abs(dY), std::abs(dZ));
    if (!std::isfinite(largest + dq)) return ProbeStatus::not_converged;
    // Far from the solution the tangent overshoots; q has to stay positive.
    S share = largest > S(0.5) ? S(0.5) / largest : S(1);
    if (dq < S(-0.7) * q) share = std::fmin(share, S(-0.7) * q / dq);
    Y += share * dY;
    Z += share * dZ;
    q += share * dq;
    if (largest < enough && std::abs(dq) < enough * q) {
      const S alpha = std::atan(Z), beta = std::atan(Y / std::sqrt(S(1) + Z * Z));
      const bool seen = f.least_cosine >= std::cos(probe.widest);
      const S border = probe.domain + S(1e-5);  // rounding does not turn the border away
      if (!seen || std::abs(alpha) > border || std::abs(beta) > border)
        return ProbeStatus::outside_domain;
      flow = {q * size, alpha, beta, i};
      return ProbeStatus::ok;
    }
  }
  return ProbeStatus::not_converged;
}

// Slopes of (alpha, beta, q) with the three pressures at a flow, rows in that order. With it,
// errors of the pressures (or of c_p, times q) become errors of the flow. False where singular.
template <class S, class Side, class Center>
bool probe_sensitivity(const Probe<S, Side, Center>& probe, S q, S alpha, S beta, Mat3<S>& out) {
  const S Z = std::tan(alpha), Y = std::tan(beta) / std::cos(alpha);
  const ProbeSlopes<S> f = probe_slopes(probe, Y, Z);
  const Vec3<S> normal = cross(f.by_y, f.by_z);
  const S determinant = dot(normal, f.value);
  if (!(q > S(0)) || !(std::abs(determinant) > std::numeric_limits<S>::epsilon())) return false;
  const Vec3<S> by_Y = (S(1) / (q * determinant)) * cross(f.by_z, f.value);
  const Vec3<S> by_Z = (S(1) / (q * determinant)) * cross(f.value, f.by_y);
  const S plane = S(1) + Z * Z, root = std::sqrt(plane), whole = plane + Y * Y;
  out.row[0] = (S(1) / plane) * by_Z;
  out.row[1] = (root / whole) * by_Y - (Y * Z / (root * whole)) * by_Z;
  out.row[2] = (S(1) / determinant) * normal;
  return true;
}

// --- on board: readings one after the other ---

template <class S>
struct PressureLimits {
  S low{}, high{};      // Pa, ends of the sensors' range; equal: not known
  int stuck_after = 0;  // equal readings in a row that a live sensor does not give; 0: not watched
};

template <class S>
struct ProbeState {
  ProbeFlow<S> flow;     // the last valid
  bool valid = false;    // whether there has been one
  int age = 0;           // readings since
  int rejected[8] = {};  // by status
  S last[3] = {};        // readings
  int same[3] = {};      // how often each was repeated
};

// Takes one reading up. Unless ok, the flow stays as it was and the rejection is counted.
template <class S, class Side, class Center>
ProbeStatus::Value probe_step(const Probe<S, Side, Center>& probe, const PressureLimits<S>& limits,
                              const ProbePressures<S>& p, ProbeState<S>& state) {
  const S reading[3] = {p.center, p.vertical, p.lateral};
  ProbeStatus::Value status = ProbeStatus::ok;
  for (const S& x : reading)
    if (!std::isfinite(x)) status = ProbeStatus::not_finite;
  if (status == ProbeStatus::ok)
    for (int i = 0; i < 3; ++i) {
      if (reading[i] != state.last[i])
        state.same[i] = 0;
      else if (state.same[i] < limits.stuck_after)
        ++state.same[i];
      state.last[i] = reading[i];
      if (limits.low < limits.high && !(reading[i] > limits.low && reading[i] < limits.high))
        status = ProbeStatus::saturated;
      else if (status == ProbeStatus::ok && limits.stuck_after > 0 &&
               state.same[i] >= limits.stuck_after)
        status = ProbeStatus::stuck;
    }
  if (status == ProbeStatus::ok) status = probe_flow(probe, p, state.flow);
  if (status == ProbeStatus::ok) {
    state.valid = true;
    state.age = 0;
    return status;
  }
  if (state.rejected[status] < std::numeric_limits<int>::max()) ++state.rejected[status];
  if (state.age < std::numeric_limits<int>::max()) ++state.age;
  return status;
}

}  // namespace alula::airdata
