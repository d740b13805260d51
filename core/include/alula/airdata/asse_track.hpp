#pragma once
// The exact affine form. v' = a - w x v is linear in v, so that seen in the body axes of t, which
// do not turn, the velocity at another time is v(t) + c(tau) with c = -(integral of a from tau to
// t): a rotation and a shift, whatever the window. The track integrates both from rates and
// accelerations and keeps the recent past.
#include "alula/airdata/asse.hpp"

namespace alula {

// Velocity gained, in axes that do not turn.
template <class T>
struct TrackPoint {
  T t{0};          // s, from the track's origin
  Vec3<T> gained;  // integral of a since the origin, m/s
};

// Where the velocity vector was before t, in the body axes of t.
template <class T>
struct Shift {
  T lag;      // s, t - tau
  Vec3<T> c;  // v(tau) = v(t) + c
};

template <class T>
struct AsseTrack {
  static constexpr int kPoints = 64;

  TrackPoint<T> past[kPoints];
  int first = 0, count = 0;
  double origin = 0.0;  // s: everything in past and here is relative to it
  double now = 0.0;     // s
  TrackPoint<T> here;
  // Rows: from body axes now into those of the origin.
  Mat3<T> turned{{{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}}};
  Vec3<T> a, w;  // at `here`
  bool started = false;

  const TrackPoint<T>& point(int i) const { return past[(first + i) % kPoints]; }
  TrackPoint<T>& point(int i) { return past[(first + i) % kPoints]; }
};

// Rotation matrix of a rotation vector; columns of the sine and cosine parts by series when small.
template <class T>
inline Mat3<T> rotation(const Vec3<T>& r) {
  const T s = dot(r, r);
  T A, B;
  if (s < T(1e-2)) {
    A = T(1) - s / T(6) * (T(1) - s / T(20) * (T(1) - s / T(42)));
    B = T(0.5) - s / T(24) * (T(1) - s / T(30) * (T(1) - s / T(56)));
  } else {
    const T angle = std::sqrt(s);
    A = std::sin(angle) / angle;
    B = (T(1) - std::cos(angle)) / s;
  }
  const T x = r.x, y = r.y, z = r.z;
  return {{{T(1) - B * (y * y + z * z), B * x * y - A * z, B * x * z + A * y},
           {B * x * y + A * z, T(1) - B * (x * x + z * z), B * y * z - A * x},
           {B * x * z - A * y, B * y * z + A * x, T(1) - B * (x * x + y * y)}}};
}

template <class T>
constexpr Vec3<T> back(const Mat3<T>& m, const Vec3<T>& v) {  // m' v
  return v.x * m.row[0] + v.y * m.row[1] + v.z * m.row[2];
}

template <class T>
constexpr Mat3<T> product(const Mat3<T>& a, const Mat3<T>& b) {
  return {{back(b, a.row[0]), back(b, a.row[1]), back(b, a.row[2])}};
}

template <class T>
inline void start(AsseTrack<T>& track, double t, const Vec3<T>& a, const Vec3<T>& w) {
  track = AsseTrack<T>{};
  track.origin = track.now = t;
  track.a = a;
  track.w = w;
  track.started = true;
  track.past[0] = track.here;
  track.count = 1;
}

// A point seen from the body axes and the velocity of now.
template <class T>
inline TrackPoint<T> seen_from_here(const AsseTrack<T>& track, const TrackPoint<T>& p) {
  return {p.t - track.here.t, back(track.turned, p.gained - track.here.gained)};
}

// Puts the origin here, so that nothing grows with time. Call seen_from_here first on every point
// that is kept elsewhere.
template <class T>
inline void put_origin_here(AsseTrack<T>& track) {
  for (int i = 0; i < track.count; ++i) track.point(i) = seen_from_here(track, track.point(i));
  track.origin = track.now;
  track.here = {};
  track.turned = {{{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}}};
}

// Goes on to a later time t, s, where the acceleration is a and the rates w, both lines in between:
// rotation with the coning term, integral by Simpson's rule in turning axes.
template <class T>
inline void advance(AsseTrack<T>& track, double t, const Vec3<T>& a, const Vec3<T>& w) {
  const T dt = static_cast<T>(t - track.now);
  const Vec3<T> coning = dt * dt / T(12) * cross(track.w, w);
  // The first half has the mean of its own rates and an eighth of the coning.
  const Vec3<T> half = dt / T(8) * (T(3) * track.w + w) + T(0.125) * coning;
  const Vec3<T> whole = dt / T(2) * (track.w + w) + coning;
  const Mat3<T> R = rotation(whole);
  const Vec3<T> middle = rotation(half) * (T(0.5) * (track.a + a));
  auto& h = track.here;
  track.now = t;
  h.t = static_cast<T>(t - track.origin);
  h.gained = h.gained + dt / T(6) * (track.turned * (track.a + T(4) * middle + R * a));
  track.turned = product(track.turned, R);
  track.a = a;
  track.w = w;
  if (track.count < AsseTrack<T>::kPoints) {
    track.point(track.count++) = h;
  } else {
    track.past[track.first] = h;
    track.first = (track.first + 1) % AsseTrack<T>::kPoints;
  }
}

// From a point of the same origin, in the body axes of now.
template <class T>
inline Shift<T> shift(const AsseTrack<T>& track, const TrackPoint<T>& p) {
  const auto q = seen_from_here(track, p);
  return {-q.t, q.gained};
}

// The point at time t, s, of the recent past, on lines between steps; false where it is not kept.
template <class T>
inline bool find(const AsseTrack<T>& track, double t, TrackPoint<T>& p) {
  const T when = static_cast<T>(t - track.origin);
  if (!track.started || !(t <= track.now + 1e-6)) return false;
  int i = track.count - 1;
  for (; i > 0 && track.point(i).t > when; --i) {}
  const auto& low = track.point(i);
  if (when < low.t) return false;
  if (i == track.count - 1) {
    p = low;
    return true;
  }
  const auto& high = track.point(i + 1);
  const T f = (when - low.t) / (high.t - low.t);
  p = {when, low.gained + f * (high.gained - low.gained)};
  return true;
}

}  // namespace alula
