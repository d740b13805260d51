#pragma once
// Attitude as a quaternion: the rotation that takes Earth axes (NED) into body axes.
#include <cmath>

#include "alula/math/vec3.hpp"

namespace alula {

template <class S>
struct Quaternion {
  S w{}, x{}, y{}, z{};
};

template <class S>
constexpr S norm_squared(const Quaternion<S>& q) {
  return q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
}

// R_BE, so that v_B = R_BE v_E; a rotation where the quaternion has unit norm.
template <class S>
constexpr Mat3<S> earth_to_body(const Quaternion<S>& q) {
  const S ww = q.w * q.w, xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const S xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const S wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  const S a = xy + wz, b = xz - wy, c = xy - wz, d = yz + wx, e = xz + wy, f = yz - wx;
  return {{{ww + xx - yy - zz, a + a, b + b},
           {c + c, ww - xx + yy - zz, d + d},
           {e + e, f + f, ww - xx - yy + zz}}};
}

// R_BE' v_B: from body into Earth axes.
template <class A, class B>
constexpr Vec3<Product<A, B>> transposed_times(const Mat3<A>& m, const Vec3<B>& v) {
  return v.x * m.row[0] + v.y * m.row[1] + v.z * m.row[2];
}

// Two turns, the first `a`: earth_to_body(a * b) is earth_to_body(b) earth_to_body(a).
template <class S>
constexpr Quaternion<S> operator*(const Quaternion<S>& a, const Quaternion<S>& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

// Rate of the quaternion for body rates w (rad/s). The last part draws the norm back to one with
// rate `pull` (1/s) and does not turn the attitude (Stevens and Lewis, 2nd ed., section 1.3).
template <class S>
constexpr Quaternion<S> attitude_rate(const Quaternion<S>& q, const Vec3<S>& w, const S& pull) {
  const S half(0.5);
  const S k = half * pull * (S(1) - norm_squared(q));
  return {k * q.w - half * (w.x * q.x + w.y * q.y + w.z * q.z),
          k * q.x + half * (w.x * q.w + w.z * q.y - w.y * q.z),
          k * q.y + half * (w.y * q.w - w.z * q.x + w.x * q.z),
          k * q.z + half * (w.z * q.w + w.y * q.x - w.x * q.y)};
}

// From Euler angles 3-2-1 (yaw psi, then pitch theta, then roll phi), rad.
template <class S>
Quaternion<S> quaternion_from_euler(const S& phi, const S& theta, const S& psi) {
  using std::cos;
  using std::sin;
  const S half(0.5);
  const S cx = cos(half * phi), sx = sin(half * phi), cy = cos(half * theta);
  const S sy = sin(half * theta), cz = cos(half * psi), sz = sin(half * psi);
  return {cx * cy * cz + sx * sy * sz, sx * cy * cz - cx * sy * sz, cx * sy * cz + sx * cy * sz,
          cx * cy * sz - sx * sy * cz};
}

// Euler angles {phi, theta, psi}, rad, of R_BE; psi in (-pi, pi]. Pitch comes from atan2, so that
// rounding at plus or minus 90 degrees gives no NaN.
template <class S>
Vec3<S> euler_from_rotation(const Mat3<S>& r) {
  using std::atan2;
  using std::sqrt;
  const S c = sqrt(r.row[0].x * r.row[0].x + r.row[0].y * r.row[0].y);
  return {atan2(r.row[1].z, r.row[2].z), atan2(-r.row[0].z, c), atan2(r.row[0].y, r.row[0].x)};
}

template <class S>
Vec3<S> euler_from_quaternion(const Quaternion<S>& q) {
  return euler_from_rotation(earth_to_body(q));
}

}  // namespace alula
