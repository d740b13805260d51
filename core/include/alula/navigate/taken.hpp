#pragma once
// What became of a sample that was handed to a navigation filter, and how often.
#include <cmath>

#include "alula/math/vec3.hpp"

namespace alula {

enum class Taken : int {
  kYes,
  kNotFinite,  // NaN or infinite: state untouched
  kBackwards,  // stamped before the filter's time, or a measurement after it: state untouched
  kGated,      // further off than chance allows: state untouched
  kTooOld,     // older than the filter remembers: state untouched
  kUnusable,   // says nothing here (no airspeed, filter not started): state untouched
  kGap,        // an inertial sample after a hole: taken, the hole bridged by growing variances
};
inline constexpr int kTakenKinds = 7;

struct Tally {
  unsigned of[kTakenKinds] = {};
};

constexpr Taken count(Tally& tally, Taken what) {
  ++tally.of[static_cast<int>(what)];
  return what;
}

template <class T>
bool finite(const Vec3<T>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace alula
