#pragma once
// Position and velocity from specific force at a given attitude, corrected by position, velocity
// and height. Pusztai 2018, Eq. (3.33), (3.34); velocity stands in NED axes here, in which the
// transition does not depend on the rates, and the accelerometer's bias is estimated along:
//   d dp / dt = dv,   d dv / dt = -R_BE' db + noise,   d db / dt = walk.
#include <cmath>

#include "alula/navigate/covariance.hpp"
#include "alula/navigate/history.hpp"
#include "alula/navigate/rotation.hpp"

namespace alula {

template <class T>
struct PositionNoise {
  T accelerometer{T(0.2)};  // m/s2 per root Hz; what a wrong attitude adds counts in
  T accelerometer_walk{T(3e-3)};
  T gravity{T(9.80665)};
  T longest_step{T(0.1)};          // s; beyond it the sample comes after a hole
  T unknown_acceleration{T(10)};   // m/s2 that the aircraft may have in a hole
  T gate3{T(25)}, gate1{T(19.5)};  // one in 100 000 by chance
  T patience{T(5)};                // s of refusals after which the filter doubts itself
};

template <class T>
struct PositionFilter {
  Vec3<T> position{}, velocity{};  // NED, m, m/s
  Vec3<T> bias{};                  // m/s2, body axes
  Vec3<T> acceleration{};          // NED, m/s2, at t
  ErrorCovariance<T, 9> P{};       // position, velocity, bias
  History<T> history{};
  double t = 0;
  double refused_since[3] = {-1, -1, -1};  // position, velocity, height
  bool started = false;
  Tally tally{};
};

template <class T>
Taken start(PositionFilter<T>& f, double t, const Vec3<T>& position, const Vec3<T>& velocity,
            T sigma_position, T sigma_velocity, T sigma_bias) {
  if (!std::isfinite(t) || !finite(position) || !finite(velocity))
    return count(f.tally, Taken::kNotFinite);
  const Tally tally = f.tally;
  f = PositionFilter<T>{};
  f.tally = tally;
  f.position = position;
  f.velocity = velocity;
  f.t = t;
  const auto all = [](T s) { return Vec3<T>{s * s, s * s, s * s}; };
  add_variance(f.P, 0, all(sigma_position));
  add_variance(f.P, 3, all(sigma_velocity));
  add_variance(f.P, 6, all(sigma_bias));
  remember(f.history, t, {position, velocity});
  f.started = true;
  return count(f.tally, Taken::kYes);
}

// Specific force (m/s2, body axes) at t, and the attitude there.
template <class T>
Taken predict(PositionFilter<T>& f, const PositionNoise<T>& noise, double t, const Vec3<T>& force,
              const Quaternion<T>& q) {
  if (!f.started) return count(f.tally, Taken::kUnusable);
  if (!std::isfinite(t) || !finite(force) || !std::isfinite(norm_squared(q)))
    return count(f.tally, Taken::kNotFinite);
  const T dt = static_cast<T>(t - f.t);
  if (!(dt > T(0))) return count(f.tally, Taken::kBackwards);
  f.t = t;
  const Mat3<T> R_BE = earth_to_body(q);
  Vec3<T> a = transposed_times(R_BE, force - f.bias);
  a.z += noise.gravity;
  if (dt > noise.longest_step) {  // straight on, and what it did meanwhile is not known
    f.position = f.position + dt * f.velocity;
    f.acceleration = a;
    const T v = noise.unknown_acceleration * dt, p = T(0.5) * v * dt;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 9; ++j) f.P.P[i][j] += dt * f.P.P[i + 3][j];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 9; ++j) f.P.P[j][i] += dt * f.P.P[j][i + 3];
    add_variance(f.P, 0, {p * p, p * p, p * p});
    add_variance(f.P, 3, {v * v, v * v, v * v});
    remember(f.history, t, {f.position, f.velocity});
    return count(f.tally, Taken::kGap);
  }
  // trapezoid: position takes the mean velocity
  const Vec3<T> dv = T(0.5) * dt * (a + f.acceleration);
  f.position = f.position + dt * (f.velocity + T(0.5) * dv);
  f.velocity = f.velocity + dv;
  f.acceleration = a;
  // P <- F P F': rows of position and velocity first, then their columns
  constexpr int R = kPaddedRow<9>;
  auto& P = f.P.P;
  T G[6][R];
  const T C[3][3] = {{R_BE.row[0].x, R_BE.row[1].x, R_BE.row[2].x},
                     {R_BE.row[0].y, R_BE.row[1].y, R_BE.row[2].y},
                     {R_BE.row[0].z, R_BE.row[1].z, R_BE.row[2].z}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < R; ++j) {
      G[i][j] = P[i][j] + dt * P[i + 3][j];
      G[i + 3][j] = P[i + 3][j] - dt * (C[i][0] * P[6][j] + C[i][1] * P[7][j] + C[i][2] * P[8][j]);
    }
  for (int i = 0; i < 6; ++i) {
    T row[6];
    for (int j = 0; j < 3; ++j) {
      row[j] = G[i][j] + dt * G[i][j + 3];
      row[j + 3] = G[i][j + 3] - dt * (C[j][0] * G[i][6] + C[j][1] * G[i][7] + C[j][2] * G[i][8]);
    }
    for (int j = 0; j <= i; ++j) P[i][j] = P[j][i] = row[j];
    for (int j = 6; j < 9; ++j) P[i][j] = P[j][i] = G[i][j];
  }
  const T v = noise.accelerometer * noise.accelerometer * dt;
  const T b = noise.accelerometer_walk * noise.accelerometer_walk * dt;
  add_variance(f.P, 3, {v, v, v});
  add_variance(f.P, 6, {b, b, b});
  remember(f.history, t, {f.position, f.velocity});
  return count(f.tally, Taken::kYes);
}

namespace position_filter_detail {

// The readings' part common to all: judge, apply, remember refusals.
template <class T, int M, int K>
Judged<T> take(PositionFilter<T>& f, const PositionNoise<T>& noise, const Innovation<T, M, K>& in,
               int kind, int first) {
  T dx[9];
  const Judged<T> out = correct(f.P, in, M == 1 ? noise.gate1 : noise.gate3, dx);
  if (out.taken == Taken::kGated) {
    if (f.refused_since[kind] < 0) f.refused_since[kind] = f.t;
    if (f.t - f.refused_since[kind] > static_cast<double>(noise.patience)) {
      for (int m = 0; m < M; ++m) f.P.P[first + m][first + m] += in.e[m] * in.e[m];
      f.refused_since[kind] = -1;
    }
  }
  if (out.taken == Taken::kYes) {
    f.refused_since[kind] = -1;
    const Vec3<T> dp{dx[0], dx[1], dx[2]}, dv{dx[3], dx[4], dx[5]};
    f.position = f.position + dp;
    f.velocity = f.velocity + dv;
    f.bias = f.bias + Vec3<T>{dx[6], dx[7], dx[8]};
    amend(f.history, f.t, dp, dv);
  }
  count(f.tally, out.taken);
  return out;
}

// Where the aircraft was when it was measured; kYes where that is known. numbers: whether the
// reading is made of them.
template <class T>
Taken past(const PositionFilter<T>& f, const PositionNoise<T>& noise, double t_measured,
           bool numbers, Place3<T>& then) {
  if (!std::isfinite(t_measured) || !numbers) return Taken::kNotFinite;
  if (!f.started) return Taken::kUnusable;
  if (t_measured > f.t + static_cast<double>(noise.longest_step)) return Taken::kBackwards;
  return recall(f.history, t_measured, f.t, {f.position, f.velocity}, then) ? Taken::kYes
                                                                            : Taken::kTooOld;
}

}  // namespace position_filter_detail

// Position (m, NED) as measured at t_measured, at most one step after the filter's time; sigma per
// axis.
template <class T>
Judged<T> update_position(PositionFilter<T>& f, const PositionNoise<T>& noise, double t_measured,
                          const Vec3<T>& z, const Vec3<T>& sigma) {
  Place3<T> then;
  const Taken known =
      position_filter_detail::past(f, noise, t_measured, finite(z) && finite(sigma), then);
  if (known != Taken::kYes) return {count(f.tally, known), T(0), {}};
  const T age = static_cast<T>(f.t - t_measured),
          e[3] = {z.x - then.position.x, z.y - then.position.y, z.z - then.position.z},
          s[3] = {sigma.x, sigma.y, sigma.z};
  Innovation<T, 3, 6> in{{0, 1, 2, 3, 4, 5}};
  for (int i = 0; i < 3; ++i) {
    in.e[i] = e[i];
    in.H[i][i] = T(1);
    in.H[i][i + 3] = -age;
    in.R[i][i] = s[i] * s[i];
  }
  return position_filter_detail::take(f, noise, in, 0, 0);
}

// Velocity (m/s, NED) as measured at t_measured.
template <class T>
Judged<T> update_velocity(PositionFilter<T>& f, const PositionNoise<T>& noise, double t_measured,
                          const Vec3<T>& z, const Vec3<T>& sigma) {
  Place3<T> then;
  const Taken known =
      position_filter_detail::past(f, noise, t_measured, finite(z) && finite(sigma), then);
  if (known != Taken::kYes) return {count(f.tally, known), T(0), {}};
  const T e[3] = {z.x - then.velocity.x, z.y - then.velocity.y, z.z - then.velocity.z};
  const T s[3] = {sigma.x, sigma.y, sigma.z};
  Innovation<T, 3, 3> in{{3, 4, 5}};
  for (int i = 0; i < 3; ++i) {
    in.e[i] = e[i];
    in.H[i][i] = T(1);
    in.R[i][i] = s[i] * s[i];
  }
  return position_filter_detail::take(f, noise, in, 1, 3);
}

// Height (m) as measured at t_measured.
template <class T>
Judged<T> update_height(PositionFilter<T>& f, const PositionNoise<T>& noise, double t_measured, T z,
                        T sigma) {
  Place3<T> then;
  const Taken known = position_filter_detail::past(f, noise, t_measured,
                                                   std::isfinite(z) && std::isfinite(sigma), then);
  if (known != Taken::kYes) return {count(f.tally, known), T(0), {}};
  Innovation<T, 1, 2> in{{2, 5}};
  in.e[0] = -z - then.position.z;
  in.H[0][0] = T(1);
  in.H[0][1] = -static_cast<T>(f.t - t_measured);
  in.R[0][0] = sigma * sigma;
  return position_filter_detail::take(f, noise, in, 2, 2);
}

}  // namespace alula
