#pragma once
// Angle vanes, and the flow at the center of gravity from what they and a pitot tube read.
//
// A vane turns into the local flow, that of the air at its place plus what the body adds (upwash):
//   alpha vane  (1 + upwash) atan(w/u) + bias
//   beta vane   (1 + sidewash) atan(v/u) + bias     the flank angle, not the sideslip asin(v/V)
// with (u, v, w) = velocity of the center of gravity + rates x arm.
#include <cmath>
#include <limits>

#include "alula/sensors/lever_arm.hpp"

namespace alula::airdata {

template <class S>
struct Vane {
  S upwash{};   // relative: 0.1 reads a tenth too much
  S bias{};     // rad
  Vec3<S> arm;  // from the center of gravity to the vane, body axes, m
};

template <class S>
struct FlowAngles {
  S V{}, alpha{}, beta{};  // m/s, atan2(w, u), asin(v/V)
};

// Sideslip asin(v/V) of the flank angle atan(v/u), rad, and back; alpha as atan(w/u).
template <class S>
S beta_of_flank(S flank, S alpha) {
  return std::atan(std::tan(flank) * std::cos(alpha));
}
template <class S>
S flank_of_beta(S beta, S alpha) {
  return std::atan2(std::sin(beta), std::cos(beta) * std::cos(alpha));
}

template <class S>
FlowAngles<S> flow_of(const Vec3<S>& v) {
  const S plane = std::hypot(v.x, v.z);
  return {std::hypot(plane, v.y), std::atan2(v.z, v.x), std::atan2(v.y, plane)};
}

template <class S>
Vec3<S> velocity_of(const FlowAngles<S>& flow) {
  const S plane = flow.V * std::cos(flow.beta);
  return {plane * std::cos(flow.alpha), flow.V * std::sin(flow.beta), plane * std::sin(flow.alpha)};
}

template <class S>
S alpha_vane_reading(const Vane<S>& vane, const Vec3<S>& v, const Vec3<S>& rates) {
  const Vec3<S> there = velocity_at(v, rates, vane.arm);
  return (S(1) + vane.upwash) * std::atan2(there.z, there.x) + vane.bias;
}
template <class S>
S beta_vane_reading(const Vane<S>& vane, const Vec3<S>& v, const Vec3<S>& rates) {
  const Vec3<S> there = velocity_at(v, rates, vane.arm);
  return (S(1) + vane.upwash) * std::atan2(there.y, there.x) + vane.bias;
}

// The flow at the center of gravity from the airspeed V at pitot_arm and both vanes' readings:
// w and v are linear in u, and the speed gives the quadratic equation of u, whose larger root is
// the flow from ahead. False, and `flow` untouched, for NaN, an airspeed that is not positive, a
// vane beyond 80 deg, or rates for which there is no such flow.
template <class S>
bool flow_from_vanes(const Vane<S>& alpha_vane, const Vane<S>& beta_vane, const Vec3<S>& pitot_arm,
                     S alpha_reading, S beta_reading, S V, const Vec3<S>& rates,
                     FlowAngles<S>& flow) {
  const S widest = S(1.3962634);
  const S a = (alpha_reading - alpha_vane.bias) / (S(1) + alpha_vane.upwash);
  const S b = (beta_reading - beta_vane.bias) / (S(1) + beta_vane.upwash);
  if (!(std::abs(a) < widest && std::abs(b) < widest && V > S(0))) return false;
  if (!(std::isfinite(V) && std::isfinite(rates.x + rates.y + rates.z))) return false;
  const Vec3<S> at_a = cross(rates, alpha_vane.arm), at_b = cross(rates, beta_vane.arm);
  const Vec3<S> at_p = cross(rates, pitot_arm);
  // Velocity at the pitot tube: (u + x0, slope_v u + y0, slope_w u + z0).
  const S slope_w = std::tan(a), slope_v = std::tan(b);
  const S x0 = at_p.x, y0 = slope_v * at_b.x - at_b.y + at_p.y;
  const S z0 = slope_w * at_a.x - at_a.z + at_p.z;
  const S A = S(1) + slope_v * slope_v + slope_w * slope_w;
  const S B = x0 + slope_v * y0 + slope_w * z0;
  const S C = x0 * x0 + y0 * y0 + z0 * z0 - V * V;
  const S root = B * B - A * C;
  if (!(root >= S(0))) return false;
  const S u = (std::sqrt(root) - B) / A;
  if (!(u > S(0))) return false;
  flow = flow_of(Vec3<S>{u, slope_v * (u + at_b.x) - at_b.y, slope_w * (u + at_a.x) - at_a.z});
  return true;
}

}  // namespace alula::airdata
