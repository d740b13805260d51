#pragma once
// Dynamic stall by the point of separation: X is the part of the chord with attached flow.
#include <cmath>

#include "alula/math/limit.hpp"
#include "alula/math/vec3.hpp"

namespace alula {

// Increments are to a model that is right where flow is attached. Angles rad. Positive stall only.
template <class T>
struct Stall {
  T a1{0};          // 1/rad, steepness of separation over angle of attack
  T alpha_star{0};  // where half of the chord is separated in steady flow
  T tau1{1};        // s, lag of separation, above 0
  T tau2{0};        // s, delay of stall with the rate of angle of attack
  T CL_alpha{0};    // lift slope of the attached flow, 1/rad
  T alpha_0{0};     // zero lift
  T CD_X{0};        // drag that full separation adds
  T Cm_X{0};        // pitching moment that full separation adds
  // A wing in two halves, each with its X; 0: one X for the whole wing.
  T y_station{0};              // m from the plane of symmetry, where each half's lift acts
  T alpha_star_difference{0};  // right half's alpha_star less the left one's
};

template <class T>
constexpr int separation_states(const Stall<T>& s) {
  return s.y_station > T(0) ? 2 : 1;
}

// Which part of the wing an X belongs to.
enum class Wing : int { left = -1, whole = 0, right = 1 };

template <class S>
struct StallIncrements {
  S CL, CD;      // stability axes
  S Cl, Cm, Cn;  // body axes
};

// X in steady flow: (1 - tanh(a1 (alpha - alpha_star)))/2, as a logistic function that never
// overflows. The value for trim and for the initial state.
template <class S, class T>
S attached_part(const Stall<T>& s, const S& alpha, Wing wing = Wing::whole) {
  using std::exp;
  const T star = s.alpha_star + T(0.5) * T(static_cast<int>(wing)) * s.alpha_star_difference;
  const S z = (T(2) * s.a1) * (alpha - star);
  const auto behind = value_of(z) > T(0);
  const S e = exp(select(behind, S(-z), z));
  return select(behind, e, S(T(1))) / (T(1) + e);
}

// dX/dt, 1/s; alpha: local one of that part of the wing; alphadot: rad/s, as the forces at the
// present X make it, so that nothing has to be solved. Goman and Khrabrov, J. Aircraft 31, 1994,
// Eq. (6); Fischenberg, AIAA 95-3438.
template <class S, class T>
S separation_rate(const Stall<T>& s, const S& alpha, const S& alphadot, const S& X,
                  Wing wing = Wing::whole) {
  return (T(1) / s.tau1) * (attached_part(s, S(alpha - s.tau2 * alphadot), wing) - X);
}

// Angle of attack of a half wing: atan2(w + p y, u - r y) at y = +-y_station. v_air: velocity of
// the center of gravity against the air, rates: body axes, both less those of the air.
template <class S, class T>
S local_alpha(const Stall<T>& s, const Vec3<S>& v_air, const Vec3<S>& rates, Wing wing) {
  using std::atan2;
  const T y = T(static_cast<int>(wing)) * s.y_station;
  const S down = v_air.z + y * rates.x, forward = v_air.x - y * rates.z;
  const auto none = (value_of(down) == T(0)) & (value_of(forward) == T(0));
  return select(none, S(0), S(atan2(down, forward)));
}

// Below this X the root is replaced by a parabola with the same value and slope there.
inline constexpr double kSmallX = 1e-3;

// sqrt(X) of X within 0 and 1, with a finite slope at zero: for X below kSmallX it is
// sqrt(kSmallX) (3 x - x^2)/2, x = X/kSmallX, which departs by less than 0.006.
template <class S>
S root_of_separation(const S& X) {
  using std::sqrt;
  using T = decltype(value_of(X));
  const S inside = limited(X, T(0), T(1));
  const S x = T(1.0 / kSmallX) * inside;
  const S parabola = (T(0.5) * sqrt(T(kSmallX))) * (x * (T(3) - x));
  return select(value_of(inside) < T(kSmallX), parabola, S(sqrt(inside)));
}

// What separation takes from the lift: Kirchhoff's CL = CL_alpha (alpha - alpha_0) ((1 + sqrt
// X)/2)^2 less the attached one.
template <class S, class T>
S lift_lost(const Stall<T>& s, const S& alpha, const S& X) {
  const S half = T(0.5) * (T(1) + root_of_separation(X));
  return (s.CL_alpha * (half * half - T(1))) * (alpha - s.alpha_0);
}

// One X for the whole wing.
template <class S, class T>
StallIncrements<S> stall_increments(const Stall<T>& s, const S& alpha, const S& X) {
  const S separated = T(1) - limited(X, T(0), T(1));
  return {lift_lost(s, alpha, X), s.CD_X * separated, S(0), s.Cm_X * separated, S(0)};
}

// Two halves: alpha of the center of gravity (its direction turns lift and drag into body axes),
// local ones and X of each half; b: span, m, by which Cl and Cn are made dimensionless. A half that
// loses lift goes down, its drag yaws toward it.
template <class S, class T>
StallIncrements<S> stall_increments(const Stall<T>& s, const S& alpha, const S& alpha_left,
                                    const S& alpha_right, const S& X_left, const S& X_right, T b) {
  S sine, cosine;
  sincos(alpha, sine, cosine);
  const auto left = stall_increments(s, alpha_left, X_left);
  const auto right = stall_increments(s, alpha_right, X_right);
  const S lift = T(0.5) * (right.CL - left.CL), drag = T(0.5) * (right.CD - left.CD);
  const T arm = s.y_station / b;
  return {T(0.5) * (right.CL + left.CL), T(0.5) * (right.CD + left.CD),
          -arm * (lift * cosine + drag * sine), T(0.5) * (right.Cm + left.Cm),
          arm * (drag * cosine - lift * sine)};
}

}  // namespace alula
