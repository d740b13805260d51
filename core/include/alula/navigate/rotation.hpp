#pragma once
// Small and large turns of an attitude: rotation vectors, quaternions, matrices.
#include <cmath>

#include "alula/math/quaternion.hpp"

namespace alula {

template <class T>
constexpr Quaternion<T> conjugate(const Quaternion<T>& q) {
  return {q.w, -q.x, -q.y, -q.z};
}

// Unit norm, scalar part not negative: of the two quaternions of an attitude always the same one.
template <class T>
Quaternion<T> normalized(const Quaternion<T>& q) {
  T k = T(1) / std::sqrt(norm_squared(q));
  if (q.w < T(0)) k = -k;
  return {k * q.w, k * q.x, k * q.y, k * q.z};
}

// The turn by |a| (rad) about a: exp(a / 2).
template <class T>
Quaternion<T> quaternion_of_turn(const Vec3<T>& a) {
  const T squared = dot(a, a);
  if (squared < T(1e-3)) {  // series to the sixth power: 1e-14 of one
    const T h = T(0.25) * squared;
    const T s = T(0.5) * (T(1) - h * (T(1.0 / 6) - h * (T(1.0 / 120) - h * T(1.0 / 5040))));
    const T c = T(1) - h * (T(0.5) - h * (T(1.0 / 24) - h * T(1.0 / 720)));
    return {c, s * a.x, s * a.y, s * a.z};
  }
  const T angle = std::sqrt(squared), s = std::sin(T(0.5) * angle) / angle;
  return {std::cos(T(0.5) * angle), s * a.x, s * a.y, s * a.z};
}

// The shortest turn, |a| up to pi, whichever sign the quaternion has.
template <class T>
Vec3<T> turn_of_quaternion(const Quaternion<T>& q) {
  const T sign = q.w < T(0) ? T(-1) : T(1);
  const Vec3<T> v{sign * q.x, sign * q.y, sign * q.z};
  const T sine = std::sqrt(dot(v, v)), cosine = sign * q.w;
  const T k = sine > T(1e-4) ? T(2) * std::atan2(sine, cosine) / sine : T(2) / cosine;
  return k * v;
}

// Of R_BE (orthonormal), by the largest of the four parts (Shepperd 1978).
template <class T>
Quaternion<T> quaternion_from_rotation(const Mat3<T>& r) {
  const T a = r.row[0].x, b = r.row[1].y, c = r.row[2].z;
  Quaternion<T> q;
  if (a + b + c > T(0)) {
    q = {T(1) + a + b + c, r.row[1].z - r.row[2].y, r.row[2].x - r.row[0].z,
         r.row[0].y - r.row[1].x};
  } else if (a >= b && a >= c) {
    q = {r.row[1].z - r.row[2].y, T(1) + a - b - c, r.row[0].y + r.row[1].x,
         r.row[2].x + r.row[0].z};
  } else if (b >= c) {
    q = {r.row[2].x - r.row[0].z, r.row[0].y + r.row[1].x, T(1) - a + b - c,
         r.row[1].z + r.row[2].y};
  } else {
    q = {r.row[0].y - r.row[1].x, r.row[2].x + r.row[0].z, r.row[1].z + r.row[2].y,
         T(1) - a - b + c};
  }
  return normalized(q);
}

// Into (-pi, pi].
template <class T>
T wrapped(T angle) {
  constexpr T turn = T(6.283185307179586476925L);
  return angle - turn * std::ceil(angle / turn - T(0.5));
}

}  // namespace alula
