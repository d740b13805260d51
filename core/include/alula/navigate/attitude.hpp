#pragma once
// Attitude from two vectors known in Earth axes: gravity and the magnetic field.
// Pusztai 2018, Eq. (3.23) to (3.28); (3.26) is missing there and is derived here.
#include <cmath>

#include "alula/navigate/rotation.hpp"

namespace alula {

// Gravity in body axes, m/s2, from specific force f, rates w (rad/s) and velocity v (m/s, body):
// v_dot + w x v - f, Eq. (3.23). v_dot is taken for zero where it is not known.
template <class T>
constexpr Vec3<T> gravity_seen(const Vec3<T>& f, const Vec3<T>& w, const Vec3<T>& v,
                               const Vec3<T>& v_dot = {}) {
  return v_dot + cross(w, v) - f;
}

// How far gravity as seen is to be believed, 0 to 1: Eq. (3.28b), with a_0 = 10.
template <class T>
T acceleration_gain(const Vec3<T>& gravity_B, T gravity, T a_0 = T(10)) {
  const T gain = T(1) - a_0 * std::abs(std::sqrt(dot(gravity_B, gravity_B)) / gravity - T(1));
  return gain > T(0) ? gain : T(0);
}

// Bank and pitch that put gravity straight down, rad.
template <class T>
Vec3<T> levelled(const Vec3<T>& g) {
  return {std::atan2(g.y, g.z), std::atan2(-g.x, std::sqrt(g.y * g.y + g.z * g.z)), T(0)};
}

// Heading against true north, rad, from the field in body axes at a bank and pitch: Eq. (3.27).
// The levelled field is T_1' B_B, T_1 the part of R_BE that bank and pitch make.
template <class T>
T magnetic_heading(T phi, T theta, const Vec3<T>& B_B, const Vec3<T>& B_E) {
  const T cx = std::cos(phi), sx = std::sin(phi), cy = std::cos(theta), sy = std::sin(theta);
  const T north = cy * B_B.x + sx * sy * B_B.y + cx * sy * B_B.z;
  const T east = cx * B_B.y - sx * B_B.z;
  return wrapped(std::atan2(B_E.y, B_E.x) - std::atan2(east, north));
}

template <class T>
struct VectorAttitude {
  Mat3<T> R_BE;
  bool valid;  // false where a vector vanishes or both are parallel
};

// R_BE from gravity and field, both weighted alike: Eq. (3.24). Earth's gravity is {0, 0, 1}.
template <class T>
VectorAttitude<T> attitude_from_vectors(const Vec3<T>& g_B, const Vec3<T>& B_B,
                                        const Vec3<T>& B_E) {
  struct Base {
    Vec3<T> a, b, c;
    bool valid;
  };
  const auto base = [](const Vec3<T>& g, const Vec3<T>& B) -> Base {
    const T g_length = std::sqrt(dot(g, g)), B_length = std::sqrt(dot(B, B));
    const Vec3<T> across = cross(g, B);
    const T size = std::sqrt(dot(across, across));
    if (!(size > T(1e-4) * g_length * B_length)) return {{}, {}, {}, false};
    Vec3<T> middle = (T(1) / g_length) * g + (T(1) / B_length) * B;
    middle = (T(1) / std::sqrt(dot(middle, middle))) * middle;
    const Vec3<T> second = (T(1) / size) * across;
    return {middle, second, cross(middle, second), true};
  };
  const Base e = base({T(0), T(0), T(1)}, B_E), v = base(g_B, B_B);
  if (!e.valid || !v.valid) return {{}, false};
  const auto row = [&](T a, T b, T c) { return a * e.a + b * e.b + c * e.c; };
  return {{{row(v.a.x, v.b.x, v.c.x), row(v.a.y, v.b.y, v.c.y), row(v.a.z, v.b.z, v.c.z)}}, true};
}

template <class T>
struct MeasuredAttitude {
  Vec3<T> euler;  // phi theta psi, rad
  T gain;         // acceleration gain, 0 to 1
  bool heading;   // false: psi says nothing, the field is disturbed or not there
  bool valid;     // false: no gravity to be seen (free fall)
};

// Bank and pitch from (3.24), heading from (3.27). A field whose size is off by more than
// `most_disturbed` of Earth's, or whose angle to gravity is off by 0.2 rad, says nothing.
template <class T>
MeasuredAttitude<T> measured_attitude(const Vec3<T>& g_B, const Vec3<T>& B_B, const Vec3<T>& B_E,
                                      T gravity, T most_disturbed = T(0.15)) {
  MeasuredAttitude<T> out{{}, T(0), false, false};
  const T g_size = std::sqrt(dot(g_B, g_B));
  if (!(g_size > T(0.1) * gravity)) return out;
  out.valid = true;
  out.gain = acceleration_gain(g_B, gravity);
  out.euler = levelled(g_B);
  const T size = std::sqrt(dot(B_B, B_B)), there = std::sqrt(dot(B_E, B_E));
  if (!(there > T(0)) || !(std::abs(size - there) <= most_disturbed * there)) return out;
  const T cosine = dot(g_B, B_B) / (g_size * size), expected = B_E.z / there;
  const auto angle = [](T c) { return std::acos(c > T(1) ? T(1) : c < T(-1) ? T(-1) : c); };
  if (std::abs(angle(cosine) - angle(expected)) > T(0.2)) return out;
  const VectorAttitude<T> both = attitude_from_vectors(g_B, B_B, B_E);
  if (!both.valid) return out;
  out.euler = euler_from_rotation(both.R_BE);
  out.euler.z = magnetic_heading(out.euler.x, out.euler.y, B_B, B_E);
  out.heading = true;
  return out;
}

}  // namespace alula
