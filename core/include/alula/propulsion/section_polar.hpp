#pragma once
// Lift and drag of a blade's section over angle of attack, Reynolds and Mach number.
#include <cmath>

namespace alula {

// By parameters as QPROP defines them (Drela 2007): lift c_l_0 + c_l_alpha alpha over
// sqrt(1 - Mach^2), held between its limits; drag a parabola about c_l_cd0 with a branch on either
// side, times (Reynolds/reynolds)^reynolds_power, and 2 sin^2 of the angle from c_l_cd0 where the
// lift is held. Or by a table (lines between, held outside), to which the two corrections apply.
template <class T>
struct SectionPolar {
  T c_l_0{0}, c_l_alpha{0};  // 1/rad
  T c_l_min{-10}, c_l_max{10};
  T c_d_0{0}, c_d_2_upper{0}, c_d_2_lower{0}, c_l_cd0{0};
  T c_d_stalled{2};  // 0: no drag is added where the lift is held
  T reynolds{1}, reynolds_power{0};
  bool mach_corrected = false;
  const T* alpha = nullptr;  // the table, kept by the caller; alpha increases, rad
  const T* c_l = nullptr;
  const T* c_d = nullptr;
  int points = 0;  // 0: by parameters
};

template <class T>
struct SectionLoads {
  T c_l, c_d;
};

// The parabola is the same for all sections that have c_d_2 alike; mach below 0.99 counts.
template <class T>
SectionLoads<T> section_loads(const SectionPolar<T>& p, T alpha, T reynolds, T mach) {
  const T limited = mach < T(0.99) ? mach : T(0.99);
  const T glauert = p.mach_corrected ? T(1) / std::sqrt(T(1) - limited * limited) : T(1);
  const T wear = p.reynolds_power == T(0) || !(reynolds > T(0))
                     ? T(1)
                     : std::pow(reynolds / p.reynolds, p.reynolds_power);
  if (p.points > 0) {
    int low = 0, high = p.points - 1;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (p.alpha[middle] <= alpha ? low : high) = middle;
    }
    T part = high > low ? (alpha - p.alpha[low]) / (p.alpha[high] - p.alpha[low]) : T(0);
    part = part < T(0) ? T(0) : (part < T(1) ? part : T(1));
    return {glauert * (p.c_l[low] + part * (p.c_l[high] - p.c_l[low])),
            wear * (p.c_d[low] + part * (p.c_d[high] - p.c_d[low]))};
  }
  T c_l = glauert * (p.c_l_0 + p.c_l_alpha * alpha);
  const bool held = c_l > p.c_l_max || c_l < p.c_l_min;
  c_l = c_l > p.c_l_max ? p.c_l_max : (c_l < p.c_l_min ? p.c_l_min : c_l);
  const T from = c_l - p.c_l_cd0;
  T c_d = wear * (p.c_d_0 + (from > T(0) ? p.c_d_2_upper : p.c_d_2_lower) * from * from);
  if (held && p.c_l_alpha > T(0)) {
    const T s = std::sin(alpha - (p.c_l_cd0 - p.c_l_0) / p.c_l_alpha);
    c_d += p.c_d_stalled * s * s;
  }
  return {c_l, c_d};
}

}  // namespace alula
