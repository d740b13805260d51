#pragma once
// What corrects the joint filter: position and velocity by satellite (also late), height by
// pressure, magnetic field, airspeed, angle of attack, sideslip; each alone, in any order.
#include "alula/motion/flat_earth.hpp"
#include "alula/navigate/joint_filter.hpp"

namespace alula {

namespace joint_filter_detail {

template <class T, int M, int K>
Judged<T> take(JointFilter<T>& f, const JointNoise<T>& noise, const Innovation<T, M, K>& in,
               JointSensor sensor) {
  T dx[kJointStates];
  const Judged<T> out = correct(f.P, in, M == 1 ? noise.gate1 : noise.gate3, dx);
  double& since = f.refused_since[sensor];
  if (out.taken == Taken::kYes) {
    since = -1;
    const auto at = [&dx](int i) { return Vec3<T>{dx[i], dx[i + 1], dx[i + 2]}; };
    f.q = normalized(f.q * quaternion_of_turn(at(kTurn)));
    f.velocity = f.velocity + at(kVelocity);
    f.position = f.position + at(kPosition);
    f.gyro_bias = f.gyro_bias + at(kGyroBias);
    f.rate = f.rate - at(kGyroBias);
    f.force_bias = f.force_bias + at(kForceBias);
    f.wind = f.wind + at(kWind);
    f.gust = f.gust + at(kGust);
    f.height_bias += dx[kHeightBias];
    amend(f.history, f.t, at(kPosition), at(kVelocity));
  } else if (out.taken == Taken::kGated && sensor != kOfField) {
    // A disturbed field may last; what else is refused for long shows that the filter is wrong.
    if (since < 0) since = f.t;
    if (f.t - since > static_cast<double>(noise.patience)) {
      T size(0);
      for (int m = 0; m < M; ++m) size += in.e[m] * in.e[m];
      const Vec3<T> s{size, size, size}, little{T(0.01), T(0.01), T(0.01)}, air{T(9), T(9), T(1)};
      if (sensor == kOfPosition) add_variance(f.P, kPosition, s);
      if (sensor == kOfVelocity) {
        add_variance(f.P, kVelocity, s);
        add_variance(f.P, kTurn, little);
      }
      if (sensor == kOfHeight) f.P.P[kHeightBias][kHeightBias] += size;
      if (sensor == kOfAir) add_variance(f.P, kWind, air);
      since = -1;
    }
  }
  count(f.tally, out.taken);
  return out;
}

template <class T>
Judged<T> refused(JointFilter<T>& f, Taken why) {
  return {count(f.tally, why), T(0), {}};
}

// Innovation of a position or velocity that was measured `age` ago: the errors carried back.
// With c = -f_E x R' theta - R' db_a, then: dv - age c, dp - age dv + age^2/2 c.
template <class T>
Innovation<T, 3, 12> of_the_past(const JointFilter<T>& f, const JointNoise<T>& noise, T age,
                                 const Place3<T>& then, bool position) {
  Innovation<T, 3, 12> in{{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14}};
  for (int i = 0; i < 3; ++i) {
    in.H[i][(position ? 6 : 3) + i] = T(1);
    if (position) in.H[i][3 + i] = -age;
  }
  if (!(age > T(0))) return in;
  const T of_c = position ? T(0.5) * age * age : -age;
  Vec3<T> f_E = (T(1) / age) * (antenna_of(f, noise).velocity - then.velocity);
  f_E.z -= noise.gravity;
  const Mat3<T> R_BE = earth_to_body(f.q);
  for (int k = 0; k < 3; ++k) {
    const Vec3<T> column = R_BE.row[k];  // of R'
    const Vec3<T> b = cross(f_E, column);
    in.H[0][k] = -of_c * b.x;
    in.H[1][k] = -of_c * b.y;
    in.H[2][k] = -of_c * b.z;
    in.H[0][9 + k] = -of_c * column.x;
    in.H[1][9 + k] = -of_c * column.y;
    in.H[2][9 + k] = -of_c * column.z;
  }
  return in;
}

template <class T>
Judged<T> satellite(JointFilter<T>& f, const JointNoise<T>& noise, double t_measured,
                    const Vec3<T>& z, const Vec3<T>& sigma, bool position) {
  if (!std::isfinite(t_measured) || !finite(z) || !finite(sigma))
    return refused(f, Taken::kNotFinite);
  if (!f.started) return refused(f, Taken::kUnusable);
  if (t_measured > f.t + static_cast<double>(noise.longest_step))
    return refused(f, Taken::kBackwards);
  Place3<T> then;
  if (!recall(f.history, t_measured, f.t, antenna_of(f, noise), then))
    return refused(f, Taken::kTooOld);
  const T late = static_cast<T>(f.t - t_measured);
  Innovation<T, 3, 12> in = of_the_past(f, noise, late, then, position);
  const Vec3<T> e = z - (position ? then.position : then.velocity);
  in.e[0] = e.x;
  in.e[1] = e.y;
  in.e[2] = e.z;
  in.R[0][0] = sigma.x * sigma.x;
  in.R[1][1] = sigma.y * sigma.y;
  in.R[2][2] = sigma.z * sigma.z;
  return take(f, noise, in, position ? kOfPosition : kOfVelocity);
}

// Air data are not linear in an attitude or a velocity that may be any: they wait for the others.
template <class T>
bool ready_for_air(const JointFilter<T>& f, T V) {
  const auto spread = [&f](int i) {
    return f.P.P[i][i] + f.P.P[i + 1][i + 1] + f.P.P[i + 2][i + 2];
  };
  return f.started && spread(kTurn) < T(0.5) && spread(kVelocity) < T(0.25) * V * V;
}

// Share of a vector that the second order of the turn makes uncertain: without it, a filter that is
// still far off takes the curvature of its readings for knowledge.
template <class T>
T curvature(const JointFilter<T>& f) {
  return T(0.5) * (f.P.P[0][0] + f.P.P[1][1] + f.P.P[2][2]);
}

// A scalar of the air velocity v (body axes, at its sensor) with gradient g.
template <class T>
Innovation<T, 1, 15> of_the_air(const JointFilter<T>& f, const JointNoise<T>& noise,
                                const Vec3<T>& g, T e, T sigma) {
  Innovation<T, 1, 15> in{{0, 1, 2, 3, 4, 5, 9, 10, 11, 15, 16, 17, 18, 19, 20}};
  const Mat3<T> R_BE = earth_to_body(f.q);
  const Vec3<T> v = R_BE * (f.velocity - f.wind - f.gust);
  const Vec3<T> turn = cross(g, v), along = transposed_times(R_BE, g);
  const Vec3<T> bias = cross(g, noise.air_sensor);
  const Vec3<T> part[5] = {turn, along, bias, T(-1) * along, T(-1) * along};
  for (int k = 0; k < 5; ++k) {
    in.H[0][3 * k] = part[k].x;
    in.H[0][3 * k + 1] = part[k].y;
    in.H[0][3 * k + 2] = part[k].z;
  }
  in.e[0] = e;
  const T bent = curvature(f);
  in.R[0][0] = sigma * sigma + bent * bent * dot(v, v) * dot(g, g);
  return in;
}

// An angle of the air velocity v; `angle` gives it and its gradient g from v and u^2 + w^2.
template <class T, class Angle>
Judged<T> update_angle(JointFilter<T>& f, const JointNoise<T>& noise, T z, T sigma, Angle angle) {
  if (!std::isfinite(z) || !std::isfinite(sigma)) return refused(f, Taken::kNotFinite);
  const Vec3<T> v = air_velocity_at_sensor(f, noise);
  const T plane = v.x * v.x + v.z * v.z;
  if (!(plane > noise.least_airspeed * noise.least_airspeed) || !ready_for_air(f, std::sqrt(plane)))
    return refused(f, Taken::kUnusable);
  Vec3<T> g;
  const T e = wrapped(z - angle(v, plane, g));
  return take(f, noise, of_the_air(f, noise, g, e, sigma), kOfAir);
}

}  // namespace joint_filter_detail

// Position (m, NED) of the antenna as measured at t_measured; sigma per axis.
template <class T>
Judged<T> update_position(JointFilter<T>& f, const JointNoise<T>& noise, double t_measured,
                          const Vec3<T>& z, const Vec3<T>& sigma) {
  return joint_filter_detail::satellite(f, noise, t_measured, z, sigma, true);
}

// Velocity (m/s, NED) as measured at t_measured.
template <class T>
Judged<T> update_velocity(JointFilter<T>& f, const JointNoise<T>& noise, double t_measured,
                          const Vec3<T>& z, const Vec3<T>& sigma) {
  return joint_filter_detail::satellite(f, noise, t_measured, z, sigma, false);
}

// Height by pressure, m: minus position down plus its own error.
template <class T>
Judged<T> update_height(JointFilter<T>& f, const JointNoise<T>& noise, T z, T sigma) {
  using namespace joint_filter_detail;
  if (!std::isfinite(z) || !std::isfinite(sigma)) return refused(f, Taken::kNotFinite);
  if (!f.started) return refused(f, Taken::kUnusable);
  Innovation<T, 1, 2> in{{kPosition + 2, kHeightBias}};
  in.H[0][0] = T(-1);
  in.H[0][1] = T(1);
  in.e[0] = z + f.position.z - f.height_bias;
  in.R[0][0] = sigma * sigma;
  return take(f, noise, in, kOfHeight);
}

// Magnetic field, body axes, in the unit of `noise.field`. While the heading is unknown by more
// than half a radian, the levelled field's direction is taken instead, which is linear in it.
template <class T>
Judged<T> update_field(JointFilter<T>& f, const JointNoise<T>& noise, const Vec3<T>& z, T sigma) {
  using namespace joint_filter_detail;
  if (!finite(z) || !std::isfinite(sigma)) return refused(f, Taken::kNotFinite);
  const Vec3<T>& B = noise.field;
  const T horizontal = B.x * B.x + B.y * B.y;
  if (!f.started || !(horizontal > T(0))) return refused(f, Taken::kUnusable);
  const Mat3<T> R_BE = earth_to_body(f.q);
  const Vec3<T> down{R_BE.row[0].z, R_BE.row[1].z, R_BE.row[2].z};
  const auto& P = f.P.P;
  const T d[3] = {down.x, down.y, down.z};
  T heading(0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) heading += d[i] * P[i][j] * d[j];
  if (heading > T(0.25)) {
    const Vec3<T> level = transposed_times(R_BE, z);
    Innovation<T, 1, 3> in{{0, 1, 2}};
    for (int i = 0; i < 3; ++i) in.H[0][i] = d[i];
    in.e[0] = wrapped(std::atan2(B.y, B.x) - std::atan2(level.y, level.x));
    // tilt turns the dip into heading
    const T tilt = P[0][0] + P[1][1] + P[2][2] - heading;
    in.R[0][0] = (sigma * sigma + B.z * B.z * (tilt > T(0) ? tilt : T(0))) / horizontal;
    return take(f, noise, in, kOfField);
  }
  const Vec3<T> h = R_BE * B;
  Innovation<T, 3, 3> in{{0, 1, 2}};
  in.H[0][1] = -h.z;
  in.H[0][2] = h.y;
  in.H[1][0] = h.z;
  in.H[1][2] = -h.x;
  in.H[2][0] = -h.y;
  in.H[2][1] = h.x;
  const Vec3<T> e = z - h;
  in.e[0] = e.x;
  in.e[1] = e.y;
  in.e[2] = e.z;
  const T bent = curvature(f);
  for (int i = 0; i < 3; ++i) in.R[i][i] = sigma * sigma + bent * bent * dot(B, B);
  return take(f, noise, in, kOfField);
}

// True airspeed, m/s.
template <class T>
Judged<T> update_airspeed(JointFilter<T>& f, const JointNoise<T>& noise, T z, T sigma) {
  using namespace joint_filter_detail;
  if (!std::isfinite(z) || !std::isfinite(sigma)) return refused(f, Taken::kNotFinite);
  const Vec3<T> v = air_velocity_at_sensor(f, noise);
  const T V = std::sqrt(dot(v, v));
  if (!(V > noise.least_airspeed) || !(z > noise.least_airspeed) || !ready_for_air(f, V))
    return refused(f, Taken::kUnusable);
  return take(f, noise, of_the_air(f, noise, (T(1) / V) * v, z - V, sigma), kOfAir);
}

// Angle of attack atan2(w, u), rad.
template <class T>
Judged<T> update_alpha(JointFilter<T>& f, const JointNoise<T>& noise, T z, T sigma) {
  const auto alpha = [](const Vec3<T>& v, T plane, Vec3<T>& g) {
    g = {-v.z / plane, T(0), v.x / plane};
    return std::atan2(v.z, v.x);
  };
  return joint_filter_detail::update_angle(f, noise, z, sigma, alpha);
}

// Sideslip asin(v/V), rad.
template <class T>
Judged<T> update_beta(JointFilter<T>& f, const JointNoise<T>& noise, T z, T sigma) {
  const auto beta = [](const Vec3<T>& v, T plane, Vec3<T>& g) {
    const T root = std::sqrt(plane), k = T(1) / ((plane + v.y * v.y) * root);
    g = {-k * v.x * v.y, k * plane, -k * v.z * v.y};
    return std::atan2(v.y, root);
  };
  return joint_filter_detail::update_angle(f, noise, z, sigma, beta);
}

}  // namespace alula
