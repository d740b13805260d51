#pragma once
// One error-state filter of attitude, velocity, position, inertial biases, wind and gust: motion
// by the inertial sensors. The truth is q = q_hat exp(theta), all else estimate plus error, and
// with R = R_BE, f the specific force less its bias, f_E = R' f
//   d theta = -w x theta - db_g,   d dv = -f_E x R' theta - R' db_a,   d dp = dv,
// gust: Gauss-Markov of length L at the airspeed; wind, biases: random walks.
#include "alula/math/limit.hpp"
#include "alula/navigate/joint_state.hpp"

namespace alula {

namespace joint_filter_detail {

// P <- F P F' + Q over dt: A turns theta, B (3 x 3) brings theta into velocity, C = R'.
template <class T>
void spread(JointFilter<T>& f, T dt, const Mat3<T>& A, const T (&B)[3][3], const T (&C)[3][3],
            const T (&keep)[3]) {
  constexpr int R = kPaddedRow<kJointStates>;
  auto& P = f.P.P;
  alignas(32) T G[9][R];
  for (int i = 0; i < 3; ++i) {
    const T ax = A.row[i].x, ay = A.row[i].y, az = A.row[i].z;
    for (int j = 0; j < R; ++j) {
      G[i][j] = ax * P[0][j] + ay * P[1][j] + az * P[2][j] - dt * P[kGyroBias + i][j];
      G[3 + i][j] = P[3 + i][j] + B[i][0] * P[0][j] + B[i][1] * P[1][j] + B[i][2] * P[2][j] -
                    dt * (C[i][0] * P[12][j] + C[i][1] * P[13][j] + C[i][2] * P[14][j]);
      G[6 + i][j] = P[6 + i][j] + dt * P[3 + i][j];
    }
  }
  for (int i = 0; i < 9; ++i) {
    const T* g = G[i];
    for (int j = 0; j < 3; ++j) {
      P[i][j] = A.row[j].x * g[0] + A.row[j].y * g[1] + A.row[j].z * g[2] - dt * g[kGyroBias + j];
      P[i][3 + j] = g[3 + j] + B[j][0] * g[0] + B[j][1] * g[1] + B[j][2] * g[2] -
                    dt * (C[j][0] * g[12] + C[j][1] * g[13] + C[j][2] * g[14]);
      P[i][6 + j] = g[6 + j] + dt * g[3 + j];
    }
    for (int j = 9; j < R; ++j) P[i][j] = g[j];
  }
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < R; ++j) P[kGust + k][j] *= keep[k];
    for (int i = 0; i < kJointStates; ++i) P[i][kGust + k] *= keep[k];
  }
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < i; ++j) P[i][j] = P[j][i];
    for (int j = 9; j < kJointStates; ++j) P[j][i] = P[i][j];
  }
}

template <class T>
void age(JointFilter<T>& f, const JointNoise<T>& noise, T dt, const T (&keep)[3]) {
  const auto walk = [&f, dt](int first, T density) {
    const T v = density * density * dt;
    add_variance(f.P, first, {v, v, v});
  };
  walk(kTurn, noise.gyro);
  walk(kVelocity, noise.accelerometer);
  walk(kGyroBias, noise.gyro_walk);
  walk(kForceBias, noise.accelerometer_walk);
  walk(kWind, noise.wind_walk);
  const T g[3] = {noise.gust.x, noise.gust.y, noise.gust.z};
  for (int k = 0; k < 3; ++k)
    f.P.P[kGust + k][kGust + k] += (T(1) - keep[k] * keep[k]) * g[k] * g[k];
  f.P.P[kHeightBias][kHeightBias] += noise.height_walk * noise.height_walk * dt;
}

}  // namespace joint_filter_detail

// Rates w (rad/s) and specific force (m/s2), body axes, at t. Between samples both are straight.
template <class T>
Taken predict(JointFilter<T>& f, const JointNoise<T>& noise, double t, const Vec3<T>& w,
              const Vec3<T>& force) {
  if (!f.started) return count(f.tally, Taken::kUnusable);
  if (!std::isfinite(t) || !finite(w) || !finite(force)) return count(f.tally, Taken::kNotFinite);
  const T dt = static_cast<T>(t - f.t);
  if (!(dt > T(0))) return count(f.tally, Taken::kBackwards);
  const bool hole = dt > noise.longest_step;
  const bool first = f.history.length <= 1 && !(dot(f.acceleration, f.acceleration) > T(0));
  f.t = t;

  const Vec3<T> against = f.velocity - f.wind - f.gust;
  const T way = dt * std::sqrt(dot(against, against));
  const auto kept = [way](T length) { return T(1) / (T(1) + way / length); };
  const T keep[3] = {kept(noise.gust_length.x), kept(noise.gust_length.y),
                     kept(noise.gust_length.z)};
  f.gust = {keep[0] * f.gust.x, keep[1] * f.gust.y, keep[2] * f.gust.z};

  const Vec3<T> rate = w - f.gyro_bias;
  Quaternion<T> turn{T(1), T(0), T(0), T(0)};
  if (!hole) {
    turn = quaternion_of_turn(T(0.5) * dt * (first ? rate + rate : rate + f.rate));
    f.q = normalized(f.q * turn);
  }
  f.rate = rate;
  const Mat3<T> R_BE = earth_to_body(f.q);
  Vec3<T> a = transposed_times(R_BE, force - f.force_bias);
  a.z += noise.gravity;
  const Vec3<T> mean = hole ? Vec3<T>{} : first ? a : T(0.5) * (a + f.acceleration);
  f.position = f.position + dt * (f.velocity + T(0.5) * dt * mean);
  f.velocity = f.velocity + dt * mean;
  f.acceleration = a;

  const T C[3][3] = {{R_BE.row[0].x, R_BE.row[1].x, R_BE.row[2].x},
                     {R_BE.row[0].y, R_BE.row[1].y, R_BE.row[2].y},
                     {R_BE.row[0].z, R_BE.row[1].z, R_BE.row[2].z}};
  T B[3][3] = {};
  if (!hole) {
    const Vec3<T> f_E{mean.x, mean.y, mean.z - noise.gravity};
    for (int k = 0; k < 3; ++k) {
      const Vec3<T> b = cross(f_E, Vec3<T>{C[0][k], C[1][k], C[2][k]});
      B[0][k] = -dt * b.x;
      B[1][k] = -dt * b.y;
      B[2][k] = -dt * b.z;
    }
  }
  joint_filter_detail::spread(f, dt, earth_to_body(turn), B, C, keep);
  joint_filter_detail::age(f, noise, dt, keep);
  if (hole) {  // what it did meanwhile is not known; yet airplanes stay more or less upright
    const T v = noise.unknown_acceleration * dt, p = T(0.5) * v * dt, s = noise.unknown_rate * dt;
    const T tilt = limited(s, T(0), T(0.32)), heading = limited(s, T(0), T(1.8));
    add_attitude_variance(f.P, kTurn, {R_BE.row[0].z, R_BE.row[1].z, R_BE.row[2].z}, tilt, heading);
    add_variance(f.P, kVelocity, {v * v, v * v, v * v});
    add_variance(f.P, kPosition, {p * p, p * p, p * p});
  }
  remember(f.history, t, antenna_of(f, noise));
  return count(f.tally, hole ? Taken::kGap : Taken::kYes);
}

}  // namespace alula
