#pragma once
// The same information in steps: an extended Kalman filter over airspeed, alpha and beta (polar, so
// that the airspeed is a linear measurement and angles of which nothing is known stay apart from
// it), attitude error, and the constant errors of accelerometers and gyros. In trim the angles are
// carried on by the rates with growing variance. Airspeeds may come late: the exact affine form
// (asse_track.hpp) says what they were.
#include "alula/airdata/asse_settings.hpp"
#include "alula/airdata/asse_track.hpp"

namespace alula {

template <class T>
struct AsseFilter {
  static constexpr int n = 12;
  static constexpr T second_order_time = T(3);  // s
  static constexpr int kMostOutliers = 25;      // in a row: then it is the filter that is wrong

  AsseSettings<T> settings;
  T V{0};
  T alpha{0}, beta{0};       // rad
  Vec3<T> tilt;              // rad: true gravity is gravity + gravity x tilt
  Vec3<T> error_a, error_w;  // m/s2, rad/s: what the sensors read too much
  T P[n][n]{};               // of V, alpha, beta, tilt, error_a, error_w
  AsseTrack<T> track;
  AsseInput<T> input{};  // the last one
  ReportedAngle<T> reported_alpha, reported_beta;
  bool running = false;  // an airspeed has been seen
  int outliers = 0;      // in a row
  double last_V = 0.0;   // s, time stamp of the last airspeed
  bool any_V = false;
  AsseRejected rejected;
};

namespace asse_detail {

template <class T>
inline constexpr T kPivot = sizeof(T) == 8 ? T(1e-14) : T(1e-7);

template <class T>
inline void forget_row(AsseFilter<T>& f, int i, T variance) {
  for (int j = 0; j < AsseFilter<T>::n; ++j) f.P[i][j] = f.P[j][i] = T(0);
  f.P[i][i] = variance;
}

// The angles as before anything was known; what was learned of the sensors is kept.
template <class T>
inline void forget_motion(AsseFilter<T>& f) {
  const auto& s = f.settings;
  f.running = false;
  f.outliers = 0;
  f.alpha = s.first_alpha;
  f.beta = s.first_beta;
  forget_row(f, 0, s.sigma_V * s.sigma_V);
  forget_row(f, 1, s.first_sigma * s.first_sigma);
  forget_row(f, 2, s.first_sigma * s.first_sigma);
}

// Adds a measurement with sensitivities H, of variance r; false where it is an outlier.
template <class T>
inline bool measure(AsseFilter<T>& f, const T* H, T innovation, T r) {
  constexpr int n = AsseFilter<T>::n;
  T PH[n], s = r;
  for (int i = 0; i < n; ++i) {
    T sum = T(0);
    for (int j = 0; j < n; ++j) sum += f.P[i][j] * H[j];
    PH[i] = sum;
  }
  for (int i = 0; i < n; ++i) s += H[i] * PH[i];
  if (!(s > T(0)) || !(innovation * innovation <= f.settings.gate * f.settings.gate * s))
    return false;
  T* state[n] = {&f.V,         &f.alpha,     &f.beta,      &f.tilt.x,
                 &f.tilt.y,    &f.tilt.z,    &f.error_a.x, &f.error_a.y,
                 &f.error_a.z, &f.error_w.x, &f.error_w.y, &f.error_w.z};
  const T k = T(1) / s;
  for (int i = 0; i < n; ++i) {
    *state[i] += k * PH[i] * innovation;
    for (int j = i; j < n; ++j) f.P[i][j] = f.P[j][i] = f.P[i][j] - k * PH[i] * PH[j];
    // Rounding must not make anything known that is not.
    const T least = kPivot<T> * (PH[i] * PH[i] * k + f.P[i][i]);
    if (!(f.P[i][i] > least)) f.P[i][i] = least;
  }
  return true;
}

}  // namespace asse_detail

// Everything as before the first sample, with the settings the filter has.
template <class T>
inline void start(AsseFilter<T>& f) {
  const AsseSettings<T> s = f.settings;
  f = AsseFilter<T>{};
  f.settings = s;
  for (int i = 0; i < 3; ++i) {
    f.P[3 + i][3 + i] = s.sigma_tilt * s.sigma_tilt;
    f.P[6 + i][6 + i] = s.sigma_a * s.sigma_a;
    f.P[9 + i][9 + i] = s.sigma_w * s.sigma_w;
  }
  asse_detail::forget_motion(f);
}

namespace asse_detail {

// State and covariance over dt with the mean inputs.
template <class T>
inline void propagate(AsseFilter<T>& f, T dt, const Vec3<T>& a_measured, const Vec3<T>& gravity,
                      const Vec3<T>& w_measured) {
  constexpr int n = AsseFilter<T>::n;
  const auto& s = f.settings;
  const Vec3<T> a = a_measured + cross(gravity, f.tilt) - f.error_a, w = w_measured - f.error_w;
  const auto b = flow_basis(f.alpha, f.beta);
  const T before = f.V;
  const Vec3<T> v = before * b.along;
  const Mat3<T> R = rotation((-dt) * w);
  const Vec3<T> then = R * v + dt * (rotation((T(-0.5) * dt) * w) * a);
  const T V = std::sqrt(dot(then, then)), least = T(0.1) * s.least_V;
  // Second order: angles that are wrong either way shorten the part of a along v. What that is
  // uncertain by lasts as long as the angles stay wrong; as white noise it is that much stronger.
  const T bent = dot(a, b.along), pa = f.P[1][1], pb = f.P[2][2], pab = f.P[1][2];
  const T shorter = T(0.5) * dt * bent * (pa + pb);
  const T unsure =
      dt * AsseFilter<T>::second_order_time * bent * bent * (pa * pa + pb * pb + T(2) * pab * pab);
  f.V = V - shorter > least ? V - shorter : least;
  f.alpha = std::atan2(then.z, then.x);
  f.beta = std::atan2(then.y, std::hypot(then.x, then.z));
  const auto c = flow_basis(f.alpha, f.beta);
  // Rows of d(V, alpha, beta)/dv; cos(beta) is kept away from zero, where alpha has no meaning.
  const T cb = std::fmax(c.cos_beta, T(1e-3));
  const Vec3<T> rows[3] = {c.along, (T(1) / (f.V * cb)) * c.by_alpha, (T(1) / f.V) * c.by_beta};
  const T keep = s.tilt_time > T(0) ? std::exp(-dt / s.tilt_time) : T(0);
  const Vec3<T> columns[3] = {R * b.along, (before * b.cos_beta) * (R * b.by_alpha),
                              before * (R * b.by_beta)};
  const Vec3<T> middle = T(0.5) * (R * v + then);  // on which wrong rates act
  T F[3][n];
  const T noise_a = dt * (s.density_a * s.density_a + s.density_wind * s.density_wind);
  const T noise_w = dt * s.density_w * s.density_w;
  Vec3<T> by_w[3];
  for (int i = 0; i < 3; ++i) {
    const Vec3<T> r = rows[i], tilted = dt * cross(r, gravity), turned = dt * cross(r, middle);
    by_w[i] = cross(r, middle);
    for (int j = 0; j < 3; ++j) F[i][j] = dot(r, columns[j]);
    F[i][3] = tilted.x, F[i][4] = tilted.y, F[i][5] = tilted.z;
    F[i][6] = -dt * r.x, F[i][7] = -dt * r.y, F[i][8] = -dt * r.z;
    F[i][9] = -turned.x, F[i][10] = -turned.y, F[i][11] = -turned.z;
  }
  T FP[3][n];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < n; ++j) {
      T sum = T(0);
      for (int k = 0; k < n; ++k) sum += F[i][k] * f.P[k][j];
      FP[i][j] = sum;
    }
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      T sum = noise_a * dot(rows[i], rows[j]) + noise_w * dot(by_w[i], by_w[j]);
      for (int k = 0; k < n; ++k) sum += FP[i][k] * F[j][k];
      f.P[i][j] = f.P[j][i] = sum;
    }
  f.P[0][0] += unsure;
  for (int i = 0; i < 3; ++i)
    for (int j = 3; j < n; ++j) f.P[i][j] = f.P[j][i] = (j < 6 ? keep : T(1)) * FP[i][j];
  for (int i = 3; i < 6; ++i) {
    for (int j = i; j < n; ++j) f.P[i][j] = f.P[j][i] = (j < 6 ? keep * keep : keep) * f.P[i][j];
    f.P[i][i] += (T(1) - keep * keep) * s.sigma_tilt * s.sigma_tilt;
  }
  f.tilt = keep * f.tilt;
  // Less is known than of any flight: that angle starts over.
  const T most = T(9) * s.first_sigma * s.first_sigma;
  if (!(f.P[1][1] < most)) forget_row(f, 1, most), f.alpha = s.first_alpha;
  if (!(f.P[2][2] < most)) forget_row(f, 2, most), f.beta = s.first_beta;
}

template <class T>
inline void report_angles(AsseFilter<T>& f, T dt) {
  const T most = f.settings.limit * f.settings.limit;
  report(f.reported_alpha, f.alpha, f.running && f.P[1][1] < most, dt);
  report(f.reported_beta, f.beta, f.running && f.P[2][2] < most, dt);
}

}  // namespace asse_detail

// Takes up rates and accelerations; false where they were rejected and nothing has changed.
template <class T>
inline bool advance(AsseFilter<T>& f, const AsseInput<T>& u) {
  if (!is_finite(u)) return ++f.rejected.not_finite, false;
  const Vec3<T> a = air_acceleration(u.f, u.gravity, u.wind_rate);
  const T dt = f.track.started ? static_cast<T>(u.t - f.input.t) : T(0);
  if (f.track.started && !(dt > T(0))) return ++f.rejected.backward, false;
  if (!f.track.started || dt > f.settings.longest_gap) {
    if (f.track.started) {
      ++f.rejected.gaps;
      asse_detail::forget_motion(f);
    }
    start(f.track, u.t, a, u.w);
  } else {
    if (f.running)
      asse_detail::propagate(f, dt, T(0.5) * (a + f.track.a),
                             T(0.5) * (u.gravity + f.input.gravity), T(0.5) * (u.w + f.track.w));
    if (f.track.here.t > T(1)) put_origin_here(f.track);
    advance(f.track, u.t, a, u.w);
  }
  f.input = u;
  asse_detail::report_angles(f, dt);
  return true;
}

// Takes up the airspeed V with time stamp t, s; false where it was rejected.
template <class T>
inline bool add_airspeed(AsseFilter<T>& f, double t, T V) {
  if (!std::isfinite(t) || !std::isfinite(V)) return ++f.rejected.not_finite, false;
  if (!(V > f.settings.least_V)) return ++f.rejected.slow, false;
  TrackPoint<T> p;
  if ((f.any_V && !(t > f.last_V)) || !find(f.track, t - static_cast<double>(f.settings.delay), p))
    return ++f.rejected.backward, false;
  f.last_V = t;
  f.any_V = true;
  const auto q = shift(f.track, p);
  const Vec3<T> error = f.error_a - cross(f.input.gravity, f.tilt);
  const Vec3<T> moved = q.c + q.lag * error;
  const auto& s = f.settings;
  const T r = s.sigma_V * s.sigma_V;
  if (!f.running) {  // the first one
    const Vec3<T> d = flow_basis(f.alpha, f.beta).along;
    const T first = V - dot(d, moved);
    f.V = first > s.least_V ? first : s.least_V;
    asse_detail::forget_row(f, 0, r);
    f.running = true;
    asse_detail::report_angles(f, T(0));
    return true;
  }
  const auto b = flow_basis(f.alpha, f.beta);
  const Vec3<T> v = f.V * b.along + moved;
  const T h = std::sqrt(dot(v, v));
  if (!(h > T(0))) return ++f.rejected.outlying, false;
  const Vec3<T> d = (T(1) / h) * v;
  const Vec3<T> by_tilt = (-q.lag) * cross(d, f.input.gravity);
  const T H[AsseFilter<T>::n] = {dot(d, b.along),
                                 f.V * b.cos_beta * dot(d, b.by_alpha),
                                 f.V * dot(d, b.by_beta),
                                 by_tilt.x,
                                 by_tilt.y,
                                 by_tilt.z,
                                 q.lag * d.x,
                                 q.lag * d.y,
                                 q.lag * d.z};
  if (!asse_detail::measure(f, H, V - h, r)) {
    ++f.rejected.outlying;
    if (++f.outliers > AsseFilter<T>::kMostOutliers) asse_detail::forget_motion(f);
    return false;
  }
  f.outliers = 0;
  asse_detail::report_angles(f, T(0));
  return true;
}

// Takes up an angle of attack from elsewhere (a vane, a lift model) of standard deviation sigma.
template <class T>
inline bool add_alpha(AsseFilter<T>& f, T alpha, T sigma) {
  if (!std::isfinite(alpha) || !std::isfinite(sigma) || !(sigma > T(0)))
    return ++f.rejected.not_finite, false;
  const T H[AsseFilter<T>::n] = {T(0), T(1)};
  if (!f.running || !asse_detail::measure(f, H, alpha - f.alpha, sigma * sigma))
    return ++f.rejected.outlying, false;
  asse_detail::report_angles(f, T(0));
  return true;
}

template <class T>
inline AsseEstimate<T> estimate(const AsseFilter<T>& f) {
  AsseEstimate<T> out;
  out.V = f.V;
  out.alpha = f.alpha;
  out.beta = f.beta;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out.P[i][j] = f.P[i][j];
  out.observable_alpha = f.reported_alpha.observable;
  out.observable_beta = f.reported_beta.observable;
  return out;
}

}  // namespace alula
