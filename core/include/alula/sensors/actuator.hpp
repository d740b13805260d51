#pragma once
// An actuator between a command and a control surface or throttle.
#include <limits>

#include "alula/math/limit.hpp"

namespace alula {

// Positions in the control's unit: rad, or the throttle's fraction.
template <class T>
struct Actuator {
  T tau{0.05};      // s, lag, above 0
  T rate_limit{0};  // per s; 0 or infinite: none
  T low{-std::numeric_limits<T>::max()}, high{std::numeric_limits<T>::max()};
  T dead_band{0};  // full width about the command within which it stands still
  T tau_down{0};   // s, lag where the position decreases; 0: tau. A speed controller's run-down.
};

// Rate of the position. The command is held within the limits, so the position comes and stays
// within them. Continuous; slopes end where a limit acts.
template <class S, class T>
constexpr S actuator_rate(const Actuator<T>& a, const S& position, const S& command) {
  S error = limited(command, a.low, a.high) - position;
  if (a.dead_band > T(0)) {
    const T half = T(0.5) * a.dead_band;
    error -= limited(error, -half, half);
  }
  S rate = (T(1) / a.tau) * error;
  if (a.tau_down > T(0))
    rate = select(value_of(error) < T(0), S((T(1) / a.tau_down) * error), rate);
  return a.rate_limit > T(0) ? limited(rate, -a.rate_limit, a.rate_limit) : rate;
}

}  // namespace alula
