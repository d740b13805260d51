#pragma once
// Angles of one moment from the airspeeds of a window, by the exact affine form: |v + c(tau)| is
// the airspeed at tau, one distance of the unknown point v from each known point -c(tau), |v| = V
// among them. Weighted least squares by Gauss and Newton over V, alpha, beta and, with what is
// known of them, an error of the acceleration (bias and tilt) and its drift (attitude and gyros).
#include "alula/airdata/asse_window.hpp"
#include "alula/math/cholesky.hpp"

namespace alula {

namespace asse_detail {

// The least-squares problem of one moment. Unknowns: error of the acceleration and its drift, each
// in units of its standard deviation, then V and V times the angles' changes.
template <class T>
struct WindowProblem {
  static constexpr int p = 6, n = 9, R = 12;

  int count = 0;
  Vec3<T> c[kMaxAsseSamples];
  T lag[kMaxAsseSamples], V[kMaxAsseSamples], weight[kMaxAsseSamples];
  T across = T(0), along = T(0), drift = T(0);  // standard deviations of the errors
  Vec3<T> down;
  T scale = T(1), prior = T(0), first_alpha = T(0), first_beta = T(0);
  T A[R][R], g[R];  // information and gradient at the last point looked at

  // Root of the covariance of the acceleration's error, times v: tilt works across gravity only.
  Vec3<T> root(const Vec3<T>& v) const {
    return across * v + ((along - across) * dot(down, v)) * down;
  }
};

template <class T>
inline void set_up(WindowProblem<T>& w, const AsseWindow<T>& f) {
  const auto& s = f.settings;
  w.count = f.count;
  T a2 = T(0);
  for (int i = 0; i < f.count; ++i) {
    const auto& k = sample(f, i);
    const auto moved = shift(f.track, k.point);
    w.c[i] = moved.c;
    w.lag[i] = moved.lag;
    w.V[i] = k.V;
    a2 += k.a2 / T(f.count);
  }
  const T g2 = dot(f.gravity, f.gravity), span = w.lag[0] > T(0) ? w.lag[0] : T(1);
  // Random walks of the velocity go as the constant error that drifts as far over the window.
  const T walk = T(3) / span * (s.density_a * s.density_a + s.density_wind * s.density_wind);
  const T along = s.sigma_a * s.sigma_a + walk;
  w.along = std::sqrt(along);
  w.across = std::sqrt(along + s.sigma_tilt * s.sigma_tilt * g2);
  if (g2 > T(0)) w.down = (T(1) / std::sqrt(g2)) * f.gravity;
  // Those of the acceleration, from attitude and gyros, as a straight line and what it leaves.
  const T tilt = s.tilt_time > T(0) ? T(2) * s.sigma_tilt * s.sigma_tilt * g2 / s.tilt_time : T(0);
  const T wander = tilt + s.density_w * s.density_w * a2;
  w.drift = std::sqrt(T(1.2) * wander / span + s.sigma_w * s.sigma_w * a2);
  for (int i = 0; i < f.count; ++i)
    w.weight[i] = T(1) / (sample(f, i).variance + wander * w.lag[i] * w.lag[i] * w.lag[i] / T(60));
  w.scale = sample(f, f.count - 1).V;
  const T widest = T(3) * s.first_sigma;  // what an angle may be in flight
  w.prior = T(1) / (w.scale * w.scale * widest * widest);
  w.first_alpha = s.first_alpha;
  w.first_beta = s.first_beta;
}

// Cost at x; A and g there.
template <class T>
inline T look_at(WindowProblem<T>& w, const T* x) {
  constexpr int p = WindowProblem<T>::p, R = WindowProblem<T>::R;
  const auto b = flow_basis(x[p + 1], x[p + 2]);
  const Vec3<T> velocity = x[p] * b.along;
  const Vec3<T> error = w.root({x[0], x[1], x[2]});
  const Vec3<T> change = (T(0.5) * w.drift) * Vec3<T>{x[3], x[4], x[5]};
  const Vec3<T> by_alpha = (x[p] * b.cos_beta / w.scale) * b.by_alpha;
  const Vec3<T> by_beta = (x[p] / w.scale) * b.by_beta;
  const T da = w.scale * (x[p + 1] - w.first_alpha), db = w.scale * (x[p + 2] - w.first_beta);
  T cost = w.prior * (da * da + db * db);
  for (auto& row : w.A) clear<R>(row);
  for (int i = 0; i < p; ++i) {
    w.A[i][i] = T(1);
    w.g[i] = -x[i];
    cost += x[i] * x[i];
  }
  w.A[p][p] = T(1e-8);
  w.A[p + 1][p + 1] = w.A[p + 2][p + 2] = w.prior;
  w.g[p] = T(0);
  w.g[p + 1] = -w.prior * da;
  w.g[p + 2] = -w.prior * db;
  for (int i = p + 3; i < R; ++i) w.g[i] = T(0);
  for (int k = 0; k < w.count; ++k) {
    const T lag = w.lag[k];
    const Vec3<T> v = velocity + w.c[k] + lag * (error + lag * change);
    const T h2 = dot(v, v);
    if (!(h2 > T(0))) continue;
    const T h = std::sqrt(h2), r = w.V[k] - h, half = T(0.5) * w.drift * lag * lag;
    const Vec3<T> d = (T(1) / h) * v, e = lag * w.root(d);
    const T row[R] = {e.x,
                      e.y,
                      e.z,
                      half * d.x,
                      half * d.y,
                      half * d.z,
                      dot(d, b.along),
                      dot(d, by_alpha),
                      dot(d, by_beta)};
    const T weight = w.weight[k];
    cost += weight * r * r;
    add_scaled<R>(w.g, weight * r, row);
    for (int i = 0; i < p + 3; ++i) add_scaled_from<R>(i, w.A[i], weight * row[i], row);
  }
  return cost;
}

// Covariance of V, alpha, beta: the last rows of the factor U alone hold their information.
template <class T>
inline void last_three(const T (*U)[WindowProblem<T>::R], T scale, T (*P)[3]) {
  constexpr int p = WindowProblem<T>::p;
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
      P[i][j] = unit[i] * unit[j] * v;
    }
}

}  // namespace asse_detail

// The estimate at the track's last time from what the window holds. Nothing is observable with
// fewer than three samples.
template <class T>
inline AsseEstimate<T> solve(AsseWindow<T>& f) {
  using Problem = asse_detail::WindowProblem<T>;
  constexpr int p = Problem::p, n = Problem::n, R = Problem::R;
  const auto& s = f.settings;
  AsseEstimate<T> out;
  out.samples = f.count;
  const T dt = static_cast<T>(f.track.now - f.reported);
  f.reported = f.track.now;
  const auto lost = [&] {
    report(f.alpha, T(0), false, dt);
    report(f.beta, T(0), false, dt);
    return out;
  };
  if (f.count < 3) return lost();
  Problem w;
  asse_detail::set_up(w, f);
  T x[n]{};
  x[p] = w.scale;
  x[p + 1] = f.alpha.ever ? f.alpha.value : s.first_alpha;
  x[p + 2] = f.beta.ever ? f.beta.value : s.first_beta;
  T cost = asse_detail::look_at(w, x), U[R][R];
  bool settled = false;
  for (; out.iterations < 12; ++out.iterations) {
    T step[R];
    if (cholesky<R>(w.A, U, n) < 0) return lost();
    for (int i = 0; i < R; ++i) step[i] = w.g[i];
    alula::solve(U, step, n);
    T gain = T(0);  // of the cost, were it a parabola; 1: one standard deviation
    for (int i = 0; i < n; ++i) gain += step[i] * w.g[i];
    step[p + 1] /= w.scale;
    step[p + 2] /= w.scale;
    const T angle = std::fmax(std::fabs(step[p + 1]), std::fabs(step[p + 2]));
    settled = gain < T(1e-3);
    if (settled) {  // what this step leaves is far below the noise; U is that of the covariance
      for (int i = 0; i < n; ++i) x[i] += step[i];
      break;
    }
    T k = angle > T(0.3) ? T(0.3) / angle : T(1), then = cost, y[n];
    for (int tries = 0; tries < 4; ++tries, k *= T(0.3)) {
      for (int i = 0; i < n; ++i) y[i] = x[i] + k * step[i];
      then = asse_detail::look_at(w, y);
      if (then <= cost + T(1e-4)) break;
    }
    if (!(then <= cost + T(1e-4))) return lost();
    for (int i = 0; i < n; ++i) x[i] = y[i];
    cost = then;
  }
  if (!settled) return lost();
  asse_detail::last_three(U, w.scale, out.P);
  out.V = x[p];
  out.alpha = x[p + 1];
  out.beta = x[p + 2];
  const T most = s.limit * s.limit;
  out.observable_alpha = out.P[1][1] < most;
  out.observable_beta = out.P[2][2] < most;
  report(f.alpha, out.alpha, out.observable_alpha, dt);
  report(f.beta, out.beta, out.observable_beta, dt);
  return out;
}

}  // namespace alula
