#pragma once
// The motion's rates and specific forces by the aerodynamic coefficients: rigid body, flat Earth,
// steady wind. Flow angles and airspeed as states: Dittrich 2016, Eq. (2.61) and (2.62), here with
// the specific force, so that thrust, aerodynamics and gravity enter in one place.
#include <array>
#include <cmath>

#include "alula/estimate/measured_maneuver.hpp"
#include "alula/math/dual.hpp"

namespace alula {

// Which of the motion a kernel differentiates; the rest are plain numbers there.
enum class Axes { longitudinal, lateral, six };

// L: scalar of V alpha theta q; M: of beta p r phi.
template <class L, class M>
struct MotionState {
  L V, alpha, theta, q;
  M beta, p, r, phi;
};

// Rates of the eight variables, in their order, then ax ay az; angular accelerations stand among
// the rates. Only what the axes ask for is set.
template <class D>
struct MotionRates {
  D rate[kMotionVariables];
  D ax, ay, az;
};

namespace detail {
// Sine and cosine, of a plain number that is mostly zero.
inline void sincos_of(double x, double& s, double& c) {
  if (x == 0.0) {
    s = 0.0;
    c = 1.0;
  } else {
    sincos(x, s, c);
  }
}
template <class D>
void sincos_of(const D& x, D& s, D& c) {
  sincos(x, s, c);
}
}  // namespace detail

// C: coefficients in the model's axes, measured ones included. u: a row of inputs.
template <Axes axes, class D, class L, class M>
inline void flight_equations(const MotionState<L, M>& x, const std::array<D, kCoefficients>& C,
                             const double* u, const MeasuredManeuver& m, MotionRates<D>& out) {
  constexpr bool longitudinal = axes != Axes::lateral, lateral = axes != Axes::longitudinal;
  L sa, ca, st, ct;
  M sb, cb, sf, cf;
  detail::sincos_of(x.alpha, sa, ca);
  detail::sincos_of(x.theta, st, ct);
  detail::sincos_of(x.beta, sb, cb);
  detail::sincos_of(x.phi, sf, cf);

  D CX = C[0], CZ = C[2];
  if (m.stability_axes) {
    CX = C[2] * sa - C[0] * ca;
    CZ = -(C[2] * ca + C[0] * sa);
  }
  const L pressure_area = (0.5 * m.S * u[kInDensity]) * (x.V * x.V);
  const D Fx = pressure_area * CX, Fy = pressure_area * C[1], Fz = pressure_area * CZ;
  const double per_mass = 1.0 / m.mass;
  out.ax = (Fx + u[kInForce]) * per_mass;
  out.ay = (Fy + u[kInForce + 1]) * per_mass;
  out.az = (Fz + u[kInForce + 2]) * per_mass;

  const D fx = out.ax - m.gravity * st;
  const D fy = out.ay + m.gravity * (ct * sf);
  const D fz = out.az + m.gravity * (ct * cf);
  const D ahead = fx * ca + fz * sa;  // along the airspeed's projection on the plane of symmetry

  // Moment about the center of gravity, less w x (J w).
  const auto hx = m.inertia.row[0].x * x.p + m.inertia.row[0].y * x.q + m.inertia.row[0].z * x.r;
  const auto hy = m.inertia.row[1].x * x.p + m.inertia.row[1].y * x.q + m.inertia.row[1].z * x.r;
  const auto hz = m.inertia.row[2].x * x.p + m.inertia.row[2].y * x.q + m.inertia.row[2].z * x.r;
  const L pressure_span = m.b * pressure_area;
  D Mx, My, Mz;
  if constexpr (lateral) {
    Mx =
        pressure_span * C[3] + (m.arm.y * Fz - m.arm.z * Fy) + u[kInMoment] - (x.q * hz - x.r * hy);
    Mz = pressure_span * C[5] + (m.arm.x * Fy - m.arm.y * Fx) + u[kInMoment + 2] -
         (x.p * hy - x.q * hx);
  }
  if constexpr (longitudinal)
    My = (m.c * pressure_area) * C[4] + (m.arm.z * Fx - m.arm.x * Fz) + u[kInMoment + 1] -
         (x.r * hx - x.p * hz);

  if constexpr (longitudinal) {
    const L per_V = 1.0 / x.V;
    out.rate[kMotionV] = ahead * cb + fy * sb;
    out.rate[kMotionAlpha] =
        (fz * ca - fx * sa) * (per_V / cb) + x.q - (sb / cb) * (x.p * ca + x.r * sa);
    out.rate[kMotionTheta] = D(0.0) + x.q * cf - x.r * sf;
  }
  if constexpr (lateral) {
    out.rate[kMotionBeta] = (fy * cb - ahead * sb) / x.V + x.p * sa - x.r * ca;
    out.rate[kMotionPhi] = D(0.0) + x.p + (st / ct) * (x.q * sf + x.r * cf);
  }
  const Mat3<double>& I = m.inertia_inverse;
  if constexpr (axes == Axes::six) {
    out.rate[kMotionP] = I.row[0].x * Mx + I.row[0].y * My + I.row[0].z * Mz;
    out.rate[kMotionQ] = I.row[1].x * Mx + I.row[1].y * My + I.row[1].z * Mz;
    out.rate[kMotionR] = I.row[2].x * Mx + I.row[2].y * My + I.row[2].z * Mz;
  } else if constexpr (lateral) {  // of a symmetric aircraft: pitch does not couple
    out.rate[kMotionP] = I.row[0].x * Mx + I.row[0].z * Mz;
    out.rate[kMotionR] = I.row[2].x * Mx + I.row[2].z * Mz;
  } else {
    out.rate[kMotionQ] = I.row[1].y * My;
  }
}

}  // namespace alula
