#pragma once
// Motion of a point of the body (the inertial sensor) under measured specific force and rates.
// Flat Earth, constant gravity; attitude by Euler angles 3-2-1, so |theta| stays below 90 deg.
// Written for the point where the accelerometers sit, the equations need no angular acceleration.
// Source: van den Hoek 2017, Eq. (3), with the yaw equation corrected; Dittrich 2016, Sec. 2.4.2.
#include <alula/math/dual.hpp>
#include <alula/math/lanes.hpp>

namespace alula {

// State: height [m], velocity of the point against the Earth in body axes [m/s], attitude [rad]
// and, where position is measured, north and east [m].
enum MotionState { kHeight, kU, kV, kW, kPhi, kTheta, kPsi, kNorth, kEast };
inline constexpr int kMotionStates = 7;
inline constexpr int kMotionStatesWithPosition = 9;
inline constexpr int kInertialInputs = 6;  // ax ay az [m/s2] p q r [rad/s], true values

// Rates d of the state y under inputs m. N is 7, or 9 with position.
template <int N, class S, class T>
inline void point_derivative(const S* y, const S* m, T gravity, S* d) {
  const S &u = y[kU], &v = y[kV], &w = y[kW], &p = m[3], &q = m[4], &r = m[5];
  S sp, cp, st, ct;
  sincos(y[kPhi], sp, cp);
  sincos(y[kTheta], st, ct);
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
  point_derivative<N>(y, m0, gravity, k);
  for (int i = 0; i < N; ++i) { total[i] = k[i]; x[i] = y[i] + half * k[i]; }
  point_derivative<N>(x, mid, gravity, k);
  for (int i = 0; i < N; ++i) { total[i] += two * k[i]; x[i] = y[i] + half * k[i]; }
  point_derivative<N>(x, mid, gravity, k);
  for (int i = 0; i < N; ++i) { total[i] += two * k[i]; x[i] = y[i] + full * k[i]; }
  point_derivative<N>(x, m1, gravity, k);
  for (int i = 0; i < N; ++i) y[i] = y[i] + sixth * (total[i] + k[i]);
}

// The step above with its exact Jacobians: A = dy1/dy0 (N x N), B = dy1/dm (N x 6) for one and
// the same change of the inputs at both ends, as a bias makes it. Height, north and east do not
// enter the rates; the twelve directions are u v w phi theta psi and the six inputs.
template <int N, class T>
inline void point_step_jacobian(T* y, const T* m0, const T* m1, T gravity, T dt, T (*A)[N],
                                T (*B)[kInertialInputs]) {
  using D = Dual<T, 12>;
  D x[N], a[kInertialInputs], b[kInertialInputs];
  x[kHeight] = D(y[kHeight]);
  for (int i = 0; i < 6; ++i) x[kU + i] = D::variable(y[kU + i], i);
  for (int i = kMotionStates; i < N; ++i) x[i] = D(y[i]);
  for (int i = 0; i < kInertialInputs; ++i) {
    a[i] = D::variable(m0[i], 6 + i);
    b[i] = D::variable(m1[i], 6 + i);
  }
  point_step<N>(x, a, b, gravity, dt);
  for (int i = 0; i < N; ++i) {
    y[i] = x[i].value;
    for (int j = 0; j < N; ++j) A[i][j] = T(i == j && (j == kHeight || j >= kMotionStates));
    for (int j = 0; j < 6; ++j) A[i][kU + j] = x[i].slope_of(j);
    for (int j = 0; j < kInertialInputs; ++j) B[i][j] = x[i].slope_of(6 + j);
  }
}

// G = d(rates)/d(inputs) at y: how input noise drives the seven states (north, east: none).
template <class T>
inline void point_input_gain(const T* y, T (*G)[kInertialInputs]) {
  T sp, cp, st, ct;
  sincos(y[kPhi], sp, cp);
  sincos(y[kTheta], st, ct);
  const T u = y[kU], v = y[kV], w = y[kW], tt = st / ct;
  for (int i = 0; i < kMotionStates; ++i)
    for (int j = 0; j < kInertialInputs; ++j) G[i][j] = T(0);
  G[kU][0] = G[kV][1] = G[kW][2] = G[kPhi][3] = T(1);
  G[kU][4] = -w; G[kU][5] = v;
  G[kV][3] = w;  G[kV][5] = -u;
  G[kW][3] = -v; G[kW][4] = u;
  G[kPhi][4] = sp * tt; G[kPhi][5] = cp * tt;
  G[kTheta][4] = cp;    G[kTheta][5] = -sp;
  G[kPsi][4] = sp / ct; G[kPsi][5] = cp / ct;
}

}  // namespace alula
