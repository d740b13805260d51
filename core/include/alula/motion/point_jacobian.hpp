#pragma once
// Exact derivatives of the motion of a point (point_kinematics.hpp): of one Runge-Kutta step, by
// the variational equations, and of the rates with respect to the inputs.
#include <alula/math/rows.hpp>
#include <alula/motion/point_kinematics.hpp>

namespace alula {

// Slopes along u v w phi theta psi and the six inputs; height, north and east enter no rate.
inline constexpr int kPointDirections = 12;
template <class T>
using PointSlopes = T[kPointDirections];

// G = d(rates)/d(inputs) at a state y of roll and pitch `tilt`, at columns `first` on; entries that
// are always zero are left alone (north, east: all).
template <class T, class Row>
inline void point_input_slopes(const T* y, const RollPitch<T>& tilt, Row* G, int first) {
  const auto& [sp, cp, st, ct] = tilt;
  const T u = y[kU], v = y[kV], w = y[kW], secant = T(1) / ct;
  const int p = first + 3, q = first + 4, r = first + 5;
  G[kU][first] = G[kV][first + 1] = G[kW][first + 2] = G[kPhi][p] = T(1);
  G[kU][q] = -w;
  G[kU][r] = v;
  G[kV][p] = w;
  G[kV][r] = -u;
  G[kW][p] = -v;
  G[kW][q] = u;
  G[kPsi][q] = sp * secant;
  G[kPsi][r] = cp * secant;
  G[kPhi][q] = G[kPsi][q] * st;
  G[kPhi][r] = G[kPsi][r] * st;
  G[kTheta][q] = cp;
  G[kTheta][r] = -sp;
}

template <class T>
inline void point_input_gain(const T* y, T (*G)[kInertialInputs]) {
  for (int i = 0; i < kMotionStates; ++i)
    for (int j = 0; j < kInertialInputs; ++j) G[i][j] = T(0);
  point_input_slopes(y, RollPitch<T>(y), G, 0);
}

// Slopes D of the rates d at the state y, which has slopes J; `inputs` as point_input_slopes
// leaves them.
template <int N, class T>
inline void point_rate_slopes(const T* y, const RollPitch<T>& tilt, const T* m, T gravity,
                              const T* d, const PointSlopes<T>* J, const PointSlopes<T>* inputs,
                              PointSlopes<T>* D) {
  constexpr int R = kPointDirections;
  const auto& [sp, cp, st, ct] = tilt;
  const T u = y[kU], v = y[kV], w = y[kW], p = m[3], q = m[4], r = m[5], one(1);
  const T side = v * sp + w * cp, right = v * cp - w * sp, turn = d[kPsi], secant = T(1) / ct;
  const T turn_phi = d[kTheta] * secant, turn_theta = turn * st * secant;
  const T down = gravity * ct, along = gravity * st;
  combine<R>(D[kHeight], st, J[kU], -ct * sp, J[kV], -ct * cp, J[kW], -ct * right, J[kPhi],
             u * ct + side * st, J[kTheta]);
  combine<R>(D[kU], one, inputs[kU], r, J[kV], -q, J[kW], -down, J[kTheta]);
  combine<R>(D[kV], one, inputs[kV], p, J[kW], -r, J[kU], down * cp, J[kPhi], -along * sp,
             J[kTheta]);
  combine<R>(D[kW], one, inputs[kW], q, J[kU], -p, J[kV], -down * sp, J[kPhi], -along * cp,
             J[kTheta]);
  combine<R>(D[kPhi], one, inputs[kPhi], turn_phi * st, J[kPhi], turn * secant, J[kTheta]);
  combine<R>(D[kTheta], one, inputs[kTheta], -turn * ct, J[kPhi]);
  combine<R>(D[kPsi], one, inputs[kPsi], turn_phi, J[kPhi], turn_theta, J[kTheta]);
  if constexpr (N == kMotionStatesWithPosition) {
    T sy, cy;
    sincos(y[kPsi], sy, cy);
    const T lift = side * ct - u * st;  // of the horizontal velocity, as the nose rises
    combine<R>(D[kNorth], ct * cy, J[kU], st * sp * cy - cp * sy, J[kV], st * cp * cy + sp * sy,
               J[kW], right * st * cy + side * sy, J[kPhi], lift * cy, J[kTheta], -d[kEast],
               J[kPsi]);
    combine<R>(D[kEast], ct * sy, J[kU], st * sp * sy + cp * cy, J[kV], st * cp * sy - sp * cy,
               J[kW], right * st * sy - side * cy, J[kPhi], lift * sy, J[kTheta], d[kNorth],
               J[kPsi]);
  }
}

// point_step with its exact Jacobians: A = dy1/dy0 (N x N), B = dy1/dm (N x 6) for one and the same
// change of the inputs at both ends, as a bias makes it.
template <int N, class T>
inline void point_step_jacobian(T* y, const T* m0, const T* m1, T gravity, T dt, T (*A)[N],
                                T (*B)[kInertialInputs]) {
  constexpr int R = kPointDirections;
  T mid[kInertialInputs], x[N], d[N], total[N] = {};
  PointSlopes<T> first[N] = {}, J[N], D[N], sum[N] = {}, inputs[N] = {};
  for (int i = 0; i < kInertialInputs; ++i) mid[i] = T(0.5) * (m0[i] + m1[i]);
  for (int i = 0; i < 6; ++i) first[kU + i][i] = T(1);
  for (int i = 0; i < N; ++i) {
    x[i] = y[i];
    scale<R>(J[i], T(1), first[i]);
  }
  const RollPitch<T> start(y);
  for (int stage = 0; stage < 4; ++stage) {
    const T* m = stage == 0 ? m0 : stage == 3 ? m1 : mid;
    const T weight = stage == 0 || stage == 3 ? T(1) : T(2), h = stage == 2 ? dt : T(0.5) * dt;
    const RollPitch<T> tilt = stage == 0 ? start : RollPitch<T>(start, y, x);
    point_derivative<N>(x, tilt, m, gravity, d);
    point_input_slopes(x, tilt, inputs, 6);
    point_rate_slopes<N>(x, tilt, m, gravity, d, J, inputs, D);
    for (int i = 0; i < N; ++i) {
      total[i] += weight * d[i];
      x[i] = y[i] + h * d[i];
      add_scaled<R>(sum[i], weight, D[i]);
      combine<R>(J[i], T(1), first[i], h, D[i]);
    }
  }
  for (int i = 0; i < N; ++i) {
    y[i] += dt / T(6) * total[i];
    add_scaled<R>(first[i], dt / T(6), sum[i]);
    for (int j = 0; j < N; ++j) A[i][j] = T(i == j && (j == kHeight || j >= kMotionStates));
    for (int j = 0; j < 6; ++j) A[i][kU + j] = first[i][j];
    for (int j = 0; j < kInertialInputs; ++j) B[i][j] = first[i][6 + j];
  }
}

}  // namespace alula
