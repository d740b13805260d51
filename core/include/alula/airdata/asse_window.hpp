#pragma once
// Angles of one moment from the airspeeds of a window, by the exact affine form: |v + c(tau)| is the
// airspeed at tau, one distance of the unknown point v from each known point -c(tau), |v| = V among
// them. Weighted least squares by Gauss and Newton over V, alpha, beta and, with what is known of
// them, an error of the acceleration (bias and tilt), its drift, and an error of the gyros.
#include "alula/airdata/asse_settings.hpp"
#include "alula/airdata/asse_track.hpp"
#include "alula/math/cholesky.hpp"

namespace alula {

inline constexpr int kMaxAsseSamples = 32;

template <class T>
struct AsseSample {
  TrackPoint<T> point;
  T V{0};
  T variance{0};  // of V, m2/s2
};

template <class T>
struct AsseWindow {
  AsseSettings<T> settings;
  int capacity = 20;  // samples kept, at most kMaxAsseSamples
  AsseTrack<T> track;
  AsseSample<T> samples[kMaxAsseSamples];
  int first = 0, count = 0;
  AsseSample<T> block;  // sums of the airspeeds of the block so far
  int in_block = 0;
  double block_start = 0.0;
  Vec3<T> gravity;
  ReportedAngle<T> alpha, beta;
  double reported = 0.0;  // s, time of the last solution
  double last_V = 0.0;    // s, time of the last airspeed
  bool any_V = false;
  AsseRejected rejected;
};

namespace asse_detail {

template <class T>
inline AsseSample<T>& sample(AsseWindow<T>& f, int i) {
  return f.samples[(f.first + i) % kMaxAsseSamples];
}
template <class T>
inline const AsseSample<T>& sample(const AsseWindow<T>& f, int i) {
  return f.samples[(f.first + i) % kMaxAsseSamples];
}

// Where the window has only its track again.
template <class T>
inline void forget(AsseWindow<T>& f) {
  f.first = f.count = f.in_block = 0;
  f.block = {};
}

}  // namespace asse_detail

// Takes up rates and accelerations; false where they were rejected and nothing has changed.
template <class T>
inline bool advance(AsseWindow<T>& f, const AsseInput<T>& u) {
  if (!is_finite(u)) return ++f.rejected.not_finite, false;
  const Vec3<T> a = air_acceleration(u.f, u.gravity, u.wind_rate);
  if (f.track.started) {
    const double now = f.track.origin + static_cast<double>(f.track.here.t);
    const T dt = static_cast<T>(u.t - now);
    if (!(dt > T(0))) return ++f.rejected.backward, false;
    if (dt <= f.settings.longest_gap) {
      advance(f.track, dt, a, u.w);
      f.gravity = u.gravity;
      return true;
    }
    ++f.rejected.gaps;
  }
  start(f.track, u.t, a, u.w);
  f.gravity = u.gravity;
  asse_detail::forget(f);
  return true;
}

// Takes up the airspeed V measured at t, s, not after the last `advance` and not older than the
// track's past; false where it was rejected.
template <class T>
inline bool add_airspeed(AsseWindow<T>& f, double t, T V) {
  if (!std::isfinite(t) || !std::isfinite(V)) return ++f.rejected.not_finite, false;
  if (!(V > f.settings.least_V)) return ++f.rejected.slow, false;
  const double when = t - static_cast<double>(f.settings.delay);
  TrackPoint<T> p;
  if ((f.any_V && !(t > f.last_V)) || !find(f.track, when, p)) return ++f.rejected.backward, false;
  f.last_V = t;
  f.any_V = true;
  auto& b = f.block;
  if (f.in_block == 0) f.block_start = when;
  b.point.t += p.t;
  b.point.gained = b.point.gained + p.gained;
  b.point.way = b.point.way + p.way;
  b.V += V;
  ++f.in_block;
  if (when - f.block_start < static_cast<double>(f.settings.block) * (1.0 - 1e-6) &&
      f.settings.block > T(0))
    return true;
  // The mean of distances to neighboring points is the distance to their mean, but for their
  // spread across it, a few mm/s.
  const T k = T(1) / T(f.in_block);
  AsseSample<T> s{{k * b.point.t, k * b.point.gained, k * b.point.way}, k * b.V,
                  k * f.settings.sigma_V * f.settings.sigma_V};
  const int most = f.capacity < kMaxAsseSamples ? f.capacity : kMaxAsseSamples;
  if (f.count >= most) {
    f.first = (f.first + 1) % kMaxAsseSamples;
    --f.count;
  }
  asse_detail::sample(f, f.count++) = s;
  f.block = {};
  f.in_block = 0;
  for (int i = 0; i < f.count; ++i) {
    auto& kept = asse_detail::sample(f, i).point;
    kept = seen_from_here(f.track, kept);
  }
  put_origin_here(f.track);
  return true;
}

// The estimate at the track's last time from what the window holds. Nothing is observable with
// fewer than three samples.
template <class T>
inline AsseEstimate<T> solve(AsseWindow<T>& f) {
  constexpr int p = 9, n = 12, R = 12;  // errors, then V, alpha, beta
  const auto& s = f.settings;
  AsseEstimate<T> out;
  out.samples = f.count;
  const double now = f.track.origin + static_cast<double>(f.track.here.t);
  const T dt = static_cast<T>(now - f.reported);
  f.reported = now;
  const auto lost = [&] {
    report(f.alpha, T(0), false, dt);
    report(f.beta, T(0), false, dt);
    return out;
  };
  if (f.count < 3) return lost();

  Shift<T> shifts[kMaxAsseSamples];
  T weight[kMaxAsseSamples];
  for (int i = 0; i < f.count; ++i) {
    const auto& k = asse_detail::sample(f, i);
    shifts[i] = shift(f.track, k.point);
  }
  // What the acceleration may be wrong by: bias every way, tilt across gravity, and the random
  // walk of sensors and wind as the constant error that drifts as far over the window.
  const T g2 = dot(f.gravity, f.gravity), span = shifts[0].lag > T(0) ? shifts[0].lag : T(1);
  const T walk = T(3) / span * (s.density_a * s.density_a + s.density_wind * s.density_wind);
  const T along = s.sigma_a * s.sigma_a + walk, across = along + s.sigma_tilt * s.sigma_tilt * g2;
  const T sigma_along = std::sqrt(along), sigma_across = std::sqrt(across);
  const T sigma_w = std::sqrt(s.sigma_w * s.sigma_w + T(3) / span * s.density_w * s.density_w);
  // The attitude's error changes over the window: as a straight line, and what that leaves.
  const T drift = s.tilt_time > T(0) ? T(2) * s.sigma_tilt * s.sigma_tilt * g2 / s.tilt_time : T(0);
  const T sigma_drift = std::sqrt(T(1.2) * drift / span);
  const Vec3<T> down = g2 > T(0) ? (T(1) / std::sqrt(g2)) * f.gravity : Vec3<T>{};
  const auto root = [&](const Vec3<T>& v) {  // root of the error's covariance, times v
    return sigma_across * v + ((sigma_along - sigma_across) * dot(down, v)) * down;
  };

  for (int i = 0; i < f.count; ++i) {
    const T lag = shifts[i].lag;
    weight[i] = T(1) / (asse_detail::sample(f, i).variance + drift * lag * lag * lag / T(60));
  }

  T x[n]{};  // in units of one standard deviation, then V, alpha, beta
  const auto& last = asse_detail::sample(f, f.count - 1);
  x[p] = last.V;
  x[p + 1] = f.alpha.ever ? f.alpha.value : s.first_alpha;
  x[p + 2] = f.beta.ever ? f.beta.value : s.first_beta;
  T A[R][R], U[R][R];
  const T scale = x[p], widest = T(3) * s.first_sigma;
  const auto residuals = [&](const T* at, bool rows, T* g) {
    const auto b = flow_basis(at[p + 1], at[p + 2]);
    const Vec3<T> error = root({at[0], at[1], at[2]}), turn = sigma_w * Vec3<T>{at[3], at[4], at[5]};
    const Vec3<T> change = (T(0.5) * sigma_drift) * Vec3<T>{at[6], at[7], at[8]};
    const T da = scale * (at[p + 1] - s.first_alpha), db = scale * (at[p + 2] - s.first_beta);
    const T prior = T(1) / (scale * scale * widest * widest);
    T cost = prior * (da * da + db * db);
    for (int i = 0; i < p; ++i) cost += at[i] * at[i];
    if (rows) {
      for (auto& row : A)
        for (T& v : row) v = T(0);
      for (int i = 0; i < p; ++i) A[i][i] = T(1);
      A[p][p] = T(1e-8);
      A[p + 1][p + 1] = A[p + 2][p + 2] = prior;
      for (int i = 0; i < p; ++i) g[i] = -at[i];
      g[p] = T(0);
      g[p + 1] = -prior * da;
      g[p + 2] = -prior * db;
    }
    for (int k = 0; k < f.count; ++k) {
      const auto& q = shifts[k];
      const Vec3<T> v = at[p] * b.along + q.c + q.lag * (error + q.lag * change) -
                        cross(turn, q.by_gyro);
      const T h = std::sqrt(dot(v, v)), r = asse_detail::sample(f, k).V - h;
      cost += weight[k] * r * r;
      if (!rows || !(h > T(0))) continue;
      const Vec3<T> d = (T(1) / h) * v, e = q.lag * root(d), w = sigma_w * cross(d, q.by_gyro);
      const Vec3<T> c = (T(0.5) * sigma_drift * q.lag * q.lag) * d;
      const T row[R] = {e.x, e.y, e.z, w.x, w.y, w.z, c.x, c.y, c.z, dot(d, b.along),
                        at[p] * b.cos_beta * dot(d, b.by_alpha) / scale,
                        at[p] * dot(d, b.by_beta) / scale};
      for (int i = 0; i < n; ++i) {
        const T f_i = weight[k] * row[i];
        g[i] += f_i * r;
        for (int j = i; j < n; ++j) A[i][j] += f_i * row[j];
      }
    }
    return cost;
  };

  T g[R]{}, cost = residuals(x, true, g);
  bool settled = false;
  for (; out.iterations < 8 && !settled; ++out.iterations) {
    if (cholesky<R>(A, U, n) < 0) return lost();
    T step[R]{};
    for (int i = 0; i < n; ++i) step[i] = g[i];
    alula::solve(U, step, n);
    step[p + 1] /= scale;
    step[p + 2] /= scale;
    const T angle = std::fmax(std::fabs(step[p + 1]), std::fabs(step[p + 2]));
    T k = angle > T(0.3) ? T(0.3) / angle : T(1), then = cost;
    T y[n];
    for (int tries = 0; tries < 5; ++tries, k *= T(0.3)) {
      for (int i = 0; i < n; ++i) y[i] = x[i] + k * step[i];
      then = residuals(y, false, g);
      if (then <= cost * (T(1) + (sizeof(T) == 8 ? T(1e-12) : T(1e-4)))) break;
    }
    if (!std::isfinite(then)) return lost();
    for (int i = 0; i < n; ++i) x[i] = y[i];
    settled = angle < (sizeof(T) == 8 ? T(1e-7) : T(1e-4));
    cost = residuals(x, true, g);
  }
  if (cholesky<R>(A, U, n) < 0) return lost();
  // The last rows of U alone hold the information of the last unknowns.
  T W[3][3]{};
  for (int c = 0; c < 3; ++c)
    for (int i = c; i >= 0; --i) {
      T v = i == c ? T(1) : T(0);
      for (int j = i + 1; j <= c; ++j) v -= U[p + i][p + j] * W[j][c];
      W[i][c] = v / U[p + i][p + i];
    }
  const T unit[3] = {T(1), T(1) / scale, T(1) / scale};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      T v = T(0);
      for (int c = 0; c < 3; ++c) v += W[i][c] * W[j][c];
      out.P[i][j] = unit[i] * unit[j] * v;
    }
  out.V = x[p];
  out.alpha = x[p + 1];
  out.beta = x[p + 2];
  const T most = s.limit * s.limit;
  out.observable_alpha = settled && out.P[1][1] < most;
  out.observable_beta = settled && out.P[2][2] < most;
  report(f.alpha, out.alpha, out.observable_alpha, dt);
  report(f.beta, out.beta, out.observable_beta, dt);
  return out;
}

}  // namespace alula
