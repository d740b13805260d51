#pragma once
// The wind that does not change with time, and the discrete gust.
#include <cmath>

#include "alula/math/limit.hpp"
#include "alula/math/vec3.hpp"

namespace alula {

// North, east, down; the way it blows to. Heights m above the same datum as the caller's.
template <class T>
struct Wind {
  Vec3<T> steady{};          // m/s at the reference height (everywhere without shear and profile)
  Vec3<T> shear{};           // m/s per m of height above the reference height
  T reference_height{0};     // m
  bool logarithmic = false;  // `steady` grows with the logarithm of height above ground
  T roughness{0.0457};  // m: 0.15 ft near the ground, else 2 ft = 0.6096 m (MIL-F-8785C, 3.7.3.2)
  T ground{0};          // m, height of the ground
};

// The logarithmic profile holds from 3 to 1000 ft above ground and is held outside.
inline constexpr double kLowestProfile = 0.9144, kHighestProfile = 304.8;

// Wind at a height, m/s: steady ln(z/z0)/ln(z_ref/z0) + shear (h - h_ref).
template <class S, class T>
Vec3<S> wind_at(const Wind<T>& wind, const S& height) {
  using std::log;
  const S above = height - wind.reference_height;
  Vec3<S> out{S(wind.steady.x), S(wind.steady.y), S(wind.steady.z)};
  if (wind.logarithmic) {
    const T low(kLowestProfile), high(kHighestProfile);
    const T reference = limited(wind.reference_height - wind.ground, low, high);
    const S z = limited(height - wind.ground, low, high);
    const S factor = log((T(1) / wind.roughness) * z) * (T(1) / log(reference / wind.roughness));
    out = factor * wind.steady;
  }
  return out + above * wind.shear;
}

// One minus cosine: MIL-F-8785C, 3.7.1.3; with `returns`, there and back over twice the length, as
// CS 25.341 (a)(2) has it. amplitude: velocity of the air, body axes, m/s, toward plus.
template <class T>
struct CosineGust {
  Vec3<T> amplitude{};
  T start{0};            // s, when the aircraft enters
  T length{1};           // m from zero to the full amplitude
  T speed{1};            // m/s, airspeed at entry: distance is speed times time
  bool returns = false;  // else the amplitude stays
};

template <class T>
Vec3<T> gust_at(const CosineGust<T>& gust, T t) {
  const T part = gust.speed * (t - gust.start) / gust.length;
  const T end = gust.returns ? T(2) : T(1);
  if (!(part > T(0)) || (gust.returns && part >= end)) return {T(0), T(0), T(0)};
  const T size = part >= end ? T(1) : T(0.5) * (T(1) - std::cos(T(3.14159265358979324) * part));
  return size * gust.amplitude;
}

}  // namespace alula
