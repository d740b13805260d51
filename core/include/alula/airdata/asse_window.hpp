#pragma once
// Angles of one moment from the airspeeds of a window, by the exact affine form: |v + c(tau)| is
// the airspeed at tau, one distance of the unknown point v from each known point -c(tau), |v| = V
// among them. Weighted least squares by Gauss and Newton over V, alpha, beta and, with what is
// known of them, an error of the acceleration (bias and tilt), its drift, and an error of the
// gyros.
#include "alula/airdata/asse_settings.hpp"
#include "alula/airdata/asse_track.hpp"

namespace alula {

inline constexpr int kMaxAsseSamples = 32;

template <class T>
struct AsseSample {
  TrackPoint<T> point;
  T V{0};
  T variance{0};  // of V, m2/s2
  T a2{0};        // square of the acceleration then, m2/s4
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
    const T dt = static_cast<T>(u.t - f.track.now);
    if (!(dt > T(0))) return ++f.rejected.backward, false;
    if (dt <= f.settings.longest_gap) {
      advance(f.track, u.t, a, u.w);
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
  b.V += V;
  ++f.in_block;
  if (when - f.block_start < static_cast<double>(f.settings.block) * (1.0 - 1e-6) &&
      f.settings.block > T(0))
    return true;
  // The mean of distances to neighboring points is the distance to their mean, but for their
  // spread across it, a few mm/s.
  const T k = T(1) / T(f.in_block);
  const AsseSample<T> s{{k * b.point.t, k * b.point.gained},
                        k * b.V,
                        k * f.settings.sigma_V * f.settings.sigma_V,
                        dot(f.track.a, f.track.a)};
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

}  // namespace alula
