#pragma once
// Motion of a point of the body (the inertial sensor) under measured specific force and rates.
// Flat Earth, constant gravity; attitude by Euler angles 3-2-1, so |theta| stays below 90 deg.
// Written for the point where the accelerometers sit, the equations need no angular acceleration.
// Source: van den Hoek 2017, Eq. (3), with the yaw equation corrected; Dittrich 2016, Sec. 2.4.2.
#include <alula/math/dual.hpp>
#include <alula/math/lanes.hpp>
#include <alula/math/near.hpp>

namespace alula {

// State: height [m], velocity of the point against the Earth in body axes [m/s], attitude [rad]
// and, where position is measured, north and east [m].
enum MotionState { kHeight, kU, kV, kW, kPhi, kTheta, kPsi, kNorth, kEast };
inline constexpr int kMotionStates = 7;
inline constexpr int kMotionStatesWithPosition = 9;
inline constexpr int kInertialInputs = 6;  // ax ay az [m/s2] p q r [rad/s], true values

// Sines and cosines of roll and pitch, at a state or near one whose own are known.
template <class S>
struct RollPitch {
  S sp, cp, st, ct;
  explicit RollPitch(const S* y) {
    sincos(y[kPhi], sp, cp);
    sincos(y[kTheta], st, ct);
  }
  RollPitch(const RollPitch& near, const S* y, const S* x) {
    sincos_near(near.sp, near.cp, y[kPhi], x[kPhi] - y[kPhi], sp, cp);
    sincos_near(near.st, near.ct, y[kTheta], x[kTheta] - y[kTheta], st, ct);
  }
};

// Rates d of the state y, rolled and pitched so, under inputs m. N is 7, or 9 with position.
template <int N, class S, class T>
inline void point_derivative(const S* y, const RollPitch<S>& tilt, const S* m, T gravity, S* d) {
  const S &u = y[kU], &v = y[kV], &w = y[kW], &p = m[3], &q = m[4], &r = m[5];
  const auto& [sp, cp, st, ct] = tilt;
  const S side = v * sp + w * cp;  // horizontal-plane part of v and w, rolled level
  d[kHeight] = u * st - side * ct;
  d[kU] = m[0] + r * v - q * w - S(gravity) * st;
  d[kV] = m[1] + p * w - r * u + S(gravity) * (sp * ct);
  d[kW] = m[2] + q * u - p * v + S(gravity) * (cp * ct);
  const S turn = (q * sp + r * cp) / ct;
  d[kPhi] = p + turn * st;
  d[kTheta] = q * cp - r * sp;
  d[kPsi] = turn;
  if constexpr (N == kMotionStatesWithPosition) {
    S sy, cy;
    sincos(y[kPsi], sy, cy);
    const S forward = u * ct + side * st, right = v * cp - w * sp;
    d[kNorth] = forward * cy - right * sy;
    d[kEast] = forward * sy + right * cy;
  }
}

// One RK4 step of length dt, in place; inputs linear between m0 and m1.
template <int N, class S, class T>
inline void point_step(S* y, const S* m0, const S* m1, T gravity, T dt) {
  S mid[kInertialInputs], k[N], total[N], x[N];
  for (int i = 0; i < kInertialInputs; ++i) mid[i] = S(T(0.5)) * (m0[i] + m1[i]);
  const S half(T(0.5) * dt), full(dt), two(T(2)), sixth(dt / T(6));
  const RollPitch<S> tilt(y);
  point_derivative<N>(y, tilt, m0, gravity, k);
  for (int i = 0; i < N; ++i) {
    total[i] = k[i];
    x[i] = y[i] + half * k[i];
  }
  point_derivative<N>(x, RollPitch<S>(tilt, y, x), mid, gravity, k);
  for (int i = 0; i < N; ++i) {
    total[i] += two * k[i];
    x[i] = y[i] + half * k[i];
  }
  point_derivative<N>(x, RollPitch<S>(tilt, y, x), mid, gravity, k);
  for (int i = 0; i < N; ++i) {
    total[i] += two * k[i];
    x[i] = y[i] + full * k[i];
  }
  point_derivative<N>(x, RollPitch<S>(tilt, y, x), m1, gravity, k);
  for (int i = 0; i < N; ++i) y[i] = y[i] + sixth * (total[i] + k[i]);
}

}  // namespace alula
