#pragma once
// A propeller of fixed pitch: thrust and torque by coefficients over the advance ratio.
#include "alula/math/curve.hpp"

namespace alula {

// J = V/(n D), n in rev/s; CT = thrust/(rho n^2 D^4), CP = power/(rho n^3 D^5).
template <class T>
struct Propeller {
  T diameter{1};  // m
  T inertia{0};   // kg m2 about its axis, with what turns with it one to one
  T sense{1};  // +1: clockwise seen from behind, angular momentum along +direction; -1: other way
  Curve<T> CT{}, CP{};
};

template <class S>
struct PropellerLoads {
  S thrust;  // N, along the direction of the engine
  S torque;  // N m that the shaft must give; negative where the propeller windmills
};

// n^2 times a coefficient over J. Outside the knots the coefficient is a line in J, and n^2 J is
// n V/D, so nothing is divided by n there: zero where the propeller stands, with finite slopes.
template <class S, class T>
constexpr S times_speed_squared(const Curve<T>& c, const S& n, const S& V_over_D, const S& J) {
  if (c.count == 0) return S(0);
  const auto speed = value_of(n), advance = value_of(V_over_D);
  const auto between =
      (advance < c.last() * speed) & (advance >= c.first() * speed) & (speed > T(0));
  S outside(0);
  if (!all(between)) {
    const auto& low = c.piece[0];
    const auto& high = c.piece[static_cast<unsigned>(c.count - 1)];
    const auto before = (advance < c.first() * speed) & (advance < c.last() * speed);
    const S at_zero =
        select(before, S(low[0] - low[1] * c.first()), S(high[0] - high[1] * c.last()));
    outside = n * (n * at_zero + select(before, S(low[1]), S(high[1])) * V_over_D);
  }
  if (!any(between)) return outside;
  return select(between, S(n * n * curve(c, J)), outside);
}

// omega: rad/s, axial_speed: of the hub against the air along the direction, m/s, density: kg/m3.
// Dittrich 2016, Eq. (2.48). A propeller that stands gives neither thrust nor torque, and the drag
// of its blades then is the airframe's; below zero speed it counts as standing.
template <class S, class T>
constexpr PropellerLoads<S> propeller_loads(const Propeller<T>& p, const S& omega,
                                            const S& axial_speed, const S& density) {
  constexpr double kTurn = 6.283185307179586;
  const S n = T(1.0 / kTurn) * select(value_of(omega) < T(0), S(0), omega);
  const S V_over_D = (T(1) / p.diameter) * axial_speed;
  const T D2 = p.diameter * p.diameter;
  const S scale = (D2 * D2) * density;
  const S J = V_over_D / select(value_of(n) > T(0), n, S(1));
  return {scale * times_speed_squared(p.CT, n, V_over_D, J),
          T(1.0 / kTurn) * p.diameter * scale * times_speed_squared(p.CP, n, V_over_D, J)};
}

}  // namespace alula
