#pragma once
// Multiplicative quaternion filter: attitude and gyro bias, from rates and measured attitudes.
// Idea and rates: Pusztai 2018, Eq. (3.35) to (3.40). The printed matrices are misplaced in part
// and carry no bias; here the error states are the turn theta (rad, body axes) from the estimate
// to the truth, q = q_hat exp(theta), and the bias error b. With w_hat = w - b_hat
//   d theta / dt = -w_hat x theta - b - noise,   d b / dt = walk.
#include <cmath>

#include "alula/navigate/attitude.hpp"
#include "alula/navigate/covariance.hpp"

namespace alula {

template <class T>
struct AttitudeNoise {
  T gyro{T(2e-4)};       // rad/s per root Hz
  T gyro_walk{T(1e-5)};  // rad/s per root s
  // Of a measured attitude, phi theta psi, rad, as if white at 50 Hz. It is not: what maneuvers and
  // turbulence add, 3 deg or so, lasts some 10 s; over 500 samples that weighs as much as 1 rad.
  Vec3<T> measured{T(1), T(1), T(1)};
  T longest_step{T(0.1)};  // s; beyond it the sample comes after a hole
  T unknown_rate{T(0.3)};  // rad/s that the aircraft may turn with in a hole
  T gate{T(25)};           // of three angles together: one in 100 000 by chance
  T patience{T(30)};       // s of refusals after which the filter doubts itself
};

template <class T>
struct AttitudeFilter {
  Quaternion<T> q{T(1), T(0), T(0), T(0)};
  Vec3<T> bias{};             // rad/s
  Vec3<T> rate{};             // rad/s, measured less bias, at t
  ErrorCovariance<T, 6> P{};  // theta, b
  double t = 0;               // s; double also where T is float: a float of seconds ends at hours
  double refused_since = -1;
  bool started = false;
  Tally tally{};
};

// tilt, heading: standard deviations, rad (an unknown heading: 1.8); sigma_bias: rad/s.
template <class T>
Taken start(AttitudeFilter<T>& f, double t, const Quaternion<T>& q, T tilt, T heading,
            T sigma_bias) {
  const T norm = norm_squared(q);
  if (!std::isfinite(t) || !(norm > T(0)) || !std::isfinite(norm) || !std::isfinite(tilt + heading))
    return count(f.tally, Taken::kNotFinite);
  const Tally tally = f.tally;
  f = AttitudeFilter<T>{};
  f.tally = tally;
  f.q = normalized(q);
  f.t = t;
  const Mat3<T> R_BE = earth_to_body(f.q);
  add_attitude_variance(f.P, 0, {R_BE.row[0].z, R_BE.row[1].z, R_BE.row[2].z}, tilt, heading);
  const T b = sigma_bias * sigma_bias;
  add_variance(f.P, 3, {b, b, b});
  f.started = true;
  return count(f.tally, Taken::kYes);
}

// Rates w (rad/s) at t.
template <class T>
Taken predict(AttitudeFilter<T>& f, const AttitudeNoise<T>& noise, double t, const Vec3<T>& w) {
  if (!f.started) return count(f.tally, Taken::kUnusable);
  if (!std::isfinite(t) || !finite(w)) return count(f.tally, Taken::kNotFinite);
  const T dt = static_cast<T>(t - f.t);
  if (!(dt > T(0))) return count(f.tally, Taken::kBackwards);
  f.t = t;
  const Vec3<T> rate = w - f.bias;
  auto& P = f.P.P;
  if (dt > noise.longest_step) {  // what it did meanwhile is not known
    const T s = noise.unknown_rate * dt, b = noise.gyro_walk * noise.gyro_walk * dt;
    T turned = s * s;
    if (turned > T(3.3)) turned = T(3.3);  // of an attitude that may be any
    add_variance(f.P, 0, {turned, turned, turned});
    add_variance(f.P, 3, {b, b, b});
    f.rate = rate;
    return count(f.tally, Taken::kGap);
  }
  const Vec3<T> mean = T(0.5) * (rate + f.rate);
  f.rate = rate;
  const Quaternion<T> turn = quaternion_of_turn(dt * mean);
  f.q = normalized(f.q * turn);
  const Mat3<T> A = earth_to_body(turn);
  // P <- F P F' with F = [A, -dt; 0, 1]: rows of theta first, then their columns
  constexpr int R = kPaddedRow<6>;
  T G[3][R];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < R; ++j)
      G[i][j] =
          A.row[i].x * P[0][j] + A.row[i].y * P[1][j] + A.row[i].z * P[2][j] - dt * P[i + 3][j];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j)
      P[i][j] = P[j][i] =
          G[i][0] * A.row[j].x + G[i][1] * A.row[j].y + G[i][2] * A.row[j].z - dt * G[i][j + 3];
    for (int j = 3; j < 6; ++j) P[i][j] = P[j][i] = G[i][j];
  }
  const T n = noise.gyro * noise.gyro * dt, b = noise.gyro_walk * noise.gyro_walk * dt;
  add_variance(f.P, 0, {n, n, n});
  add_variance(f.P, 3, {b, b, b});
  return count(f.tally, Taken::kYes);
}

namespace attitude_filter_detail {

template <class T>
void apply(AttitudeFilter<T>& f, const T* dx) {
  f.q = normalized(f.q * quaternion_of_turn(Vec3<T>{dx[0], dx[1], dx[2]}));
  const Vec3<T> b{dx[3], dx[4], dx[5]};
  f.bias = f.bias + b;
  f.rate = f.rate - b;
}

}  // namespace attitude_filter_detail

// A measured attitude, as `measured_attitude` gives it. Its gain divides the standard deviations
// (at no gain it is not used): (3.28a) mixes the heading by it, which is the same idea without a
// covariance. Without heading, bank and pitch are taken alone.
template <class T>
Judged<T> update(AttitudeFilter<T>& f, const AttitudeNoise<T>& noise,
                 const MeasuredAttitude<T>& z) {
  if (!f.started || !z.valid || !(z.gain > T(0.05)))
    return {count(f.tally, Taken::kUnusable), T(0), {}};
  if (!finite(z.euler) || !std::isfinite(z.gain))
    return {count(f.tally, Taken::kNotFinite), T(0), {}};
  const Quaternion<T> known = normalized(f.q);
  const Vec3<T> now = euler_from_quaternion(known);
  const Quaternion<T> measured =
      quaternion_from_euler(z.euler.x, z.euler.y, z.heading ? z.euler.z : now.z);
  // the measured Earth's z seen from the body is the axis that heading turns about
  const Mat3<T> R_BE = earth_to_body(measured);
  const Vec3<T> down{R_BE.row[0].z, R_BE.row[1].z, R_BE.row[2].z};
  const T cx = std::cos(z.euler.x), sx = std::sin(z.euler.x);
  // small turns about phi, theta, psi in body axes
  const Vec3<T> axis[3] = {{T(1), T(0), T(0)}, {T(0), cx, -sx}, down};
  const T g = T(1) / z.gain;
  const T variance[3] = {noise.measured.x * g, noise.measured.y * g,
                         z.heading ? noise.measured.z * g : T(3)};
  Innovation<T, 3, 3> in{{0, 1, 2}};
  const Vec3<T> e = turn_of_quaternion(conjugate(known) * measured);
  in.e[0] = e.x;
  in.e[1] = e.y;
  in.e[2] = e.z;
  for (int k = 0; k < 3; ++k) {
    const T a[3] = {axis[k].x, axis[k].y, axis[k].z}, s = variance[k] * variance[k];
    in.H[k][k] = T(1);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) in.R[i][j] += s * a[i] * a[j];
  }
  // at 90 degrees of pitch two axes coincide: a floor keeps the covariance positive
  for (int i = 0; i < 3; ++i) in.R[i][i] += T(1e-6);
  T dx[6];
  Judged<T> out = correct(f.P, in, noise.gate, dx);
  if (out.taken == Taken::kGated) {
    count(f.tally, out.taken);
    if (f.refused_since < 0) f.refused_since = f.t;
    if (f.t - f.refused_since > static_cast<double>(noise.patience)) {
      const T s = dot(e, e);
      add_variance(f.P, 0, {s, s, s});
      f.refused_since = -1;
    }
    if (!z.heading) return out;
    // most often it is the field that is wrong: gravity is tried alone
    const double since = f.refused_since;
    MeasuredAttitude<T> gravity = z;
    gravity.heading = false;
    const Judged<T> again = update(f, noise, gravity);
    f.refused_since = since;
    return again.taken == Taken::kYes ? out : again;
  }
  if (out.taken == Taken::kYes) {
    f.refused_since = -1;
    attitude_filter_detail::apply(f, dx);
  }
  count(f.tally, out.taken);
  return out;
}

}  // namespace alula
