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

// L: scalar of V alpha q; M: of beta p r phi; P: of theta.
template <class L, class M, class P>
struct MotionState {
  L V, alpha, q;
  M beta, p, r, phi;
  P theta;
};

// Rates of the eight variables, in their order, then ax ay az; angular accelerations stand among
// the rates. Only what the axes ask for is set.
template <class D>
struct MotionRates {
  D rate[kMotionVariables];
  D ax, ay, az;
};

// The one of them that is measured as `output`, an acceleration.
template <class D>
const D& acceleration(const MotionRates<D>& y, int output) {
  return output == kOutAx     ? y.ax
         : output == kOutAy   ? y.ay
         : output == kOutAz   ? y.az
         : output == kOutPdot ? y.rate[kMotionP]
         : output == kOutQdot ? y.rate[kMotionQ]
                              : y.rate[kMotionR];
}

namespace detail {
// The sine or cosine of x, by its value f and its derivative there.
inline double function_of(double, double f, double) { return f; }
template <class D>
D function_of(const D& x, double f, double df) {
  return x.chain(f, df);
}
}  // namespace detail

// C: coefficients in the model's axes, measured ones included. u: a row of inputs.
template <Axes axes, class D, class L, class M, class P>
inline void flight_equations(const MotionState<L, M, P>& x, const std::array<D, kCoefficients>& C,
                             const double* u, const MeasuredManeuver& m, MotionRates<D>& out) {
  constexpr bool longitudinal = axes != Axes::lateral, lateral = axes != Axes::longitudinal;
  using Angles = Lanes<double, 4>;
  Angles s, c;
  const double angles[4] = {value_of(x.alpha), value_of(x.theta), value_of(x.beta),
                            value_of(x.phi)};
  sincos(Angles::from([&angles](int i) { return angles[i]; }), s, c);
  const L sa = detail::function_of(x.alpha, s[0], c[0]),
          ca = detail::function_of(x.alpha, c[0], -s[0]);
  const P st = detail::function_of(x.theta, s[1], c[1]),
          ct = detail::function_of(x.theta, c[1], -s[1]);
  const M sb = detail::function_of(x.beta, s[2], c[2]),
          cb = detail::function_of(x.beta, c[2], -s[2]);
  const M sf = detail::function_of(x.phi, s[3], c[3]), cf = detail::function_of(x.phi, c[3], -s[3]);

  D CX = C[0], CZ = C[2];
  if (m.stability_axes) {
    CX = C[2] * sa - C[0] * ca;
    CZ = -(C[2] * ca + C[0] * sa);
  }
  const L pressure_area = (0.5 * m.S * u[kInDensity]) * (x.V * x.V);
  const D Fx = pressure_area * CX, Fy = pressure_area * C[1], Fz = pressure_area * CZ;
  const double per_mass = 1.0 / m.mass;
  out.ax = (Fx + u[kInForce]) * per_mass;
  out.az = (Fz + u[kInForce + 2]) * per_mass;
  const D fx = out.ax - m.gravity * st;
  const D fz = out.az + m.gravity * (ct * cf);
  const D ahead = fx * ca + fz * sa;  // along the airspeed's projection on the plane of symmetry

  // A motion in the plane of symmetry, whose lateral variables are plain zeros, leaves most out.
  bool turning = true, sideways = true;
  if constexpr (axes == Axes::longitudinal) {
    turning = x.p != 0.0 || x.r != 0.0;
    sideways = x.beta != 0.0;
  }
  D fy(0.0);
  if (sideways) {
    out.ay = (Fy + u[kInForce + 1]) * per_mass;
    fy = out.ay + m.gravity * (ct * sf);
  }

  // Moment about the center of gravity, less w x (J w).
  D Mx, My, Mz;
  if constexpr (lateral) {
    const L pressure_span = m.b * pressure_area;
    Mx = pressure_span * C[3] + u[kInMoment];
    Mz = pressure_span * C[5] + u[kInMoment + 2];
  }
  if constexpr (longitudinal) My = (m.c * pressure_area) * C[4] + u[kInMoment + 1];
  if (m.arm.x != 0.0 || m.arm.y != 0.0 || m.arm.z != 0.0) {
    if constexpr (lateral) {
      Mx += m.arm.y * Fz - m.arm.z * Fy;
      Mz += m.arm.x * Fy - m.arm.y * Fx;
    }
    if constexpr (longitudinal) My += m.arm.z * Fx - m.arm.x * Fz;
  }
  if (turning) {
    const auto hx = m.inertia.row[0].x * x.p + m.inertia.row[0].y * x.q + m.inertia.row[0].z * x.r;
    const auto hy = m.inertia.row[1].x * x.p + m.inertia.row[1].y * x.q + m.inertia.row[1].z * x.r;
    const auto hz = m.inertia.row[2].x * x.p + m.inertia.row[2].y * x.q + m.inertia.row[2].z * x.r;
    if constexpr (lateral) {
      Mx -= D(x.q * hz - x.r * hy);
      Mz -= D(x.p * hy - x.q * hx);
    }
    if constexpr (longitudinal) My -= D(x.r * hx - x.p * hz);
  }

  if constexpr (longitudinal) {
    out.rate[kMotionV] = ahead * cb;
    out.rate[kMotionAlpha] = (fz * ca - fx * sa) / (x.V * cb) + x.q;
    if (sideways) {
      out.rate[kMotionV] += fy * sb;
      out.rate[kMotionAlpha] -= D((sb / cb) * (x.p * ca + x.r * sa));
    }
    out.rate[kMotionTheta] = D(x.q * cf - x.r * sf);
  }
  if constexpr (lateral) {
    out.rate[kMotionBeta] = (fy * cb - ahead * sb) / x.V + x.p * sa - x.r * ca;
    out.rate[kMotionPhi] = D(x.p) + (st / ct) * (x.q * sf + x.r * cf);
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
