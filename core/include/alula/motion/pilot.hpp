#pragma once
// A linear pilot: deflections in proportion to what differs from what he wants to see.
#include "alula/motion/aircraft.hpp"

namespace alula {

// What he sees: V alpha beta (against the air), p q r, phi theta psi, h.
enum Sight : int {
  kSeeV,
  kSeeAlpha,
  kSeeBeta,
  kSeeP,
  kSeeQ,
  kSeeR,
  kSeePhi,
  kSeeTheta,
  kSeePsi,
  kSeeH
};
inline constexpr int kSights = 10;

// u = u_given + gain (reference - sight), within the control's limits (rad, dt 0 to 1).
template <class T>
struct Pilot {
  T gain[kControls][kSights] = {};
  T low[kControls] = {}, high[kControls] = {};
};

template <class T>
std::array<T, kSights> sight(const FlightState<T>& x, const FlightInput<T>& u,
                             const AircraftModel<T>& a) {
  const Place<T> at = place(x, a.earth, a.gravity);
  const Vec3<T> gust{u[kGustInput], u[kGustInput + 1], u[kGustInput + 2]};
  const Vec3<T> v = Vec3<T>{x[7], x[8], x[9]} - at.R_BN * wind_at(a.wind, at.height) - gust;
  const FlowAngles<T> flow = flow_angles(v);
  const Vec3<T> euler = euler_from_rotation(at.R_BN);
  return {flow.V, flow.alpha, flow.beta, x[10], x[11], x[12], euler.x, euler.y, euler.z, at.height};
}

// Adds his deflections to the controls of the input.
template <class T>
void steer(const Pilot<T>& pilot, const std::array<T, kSights>& seen, const T* reference,
           FlightInput<T>& u) {
  constexpr T turn = T(6.283185307179586476925L);
  for (int i = 0; i < kControls; ++i) {
    T more(0);
    bool used = false;
    for (int j = 0; j < kSights; ++j) {
      if (pilot.gain[i][j] == T(0)) continue;
      used = true;
      T off = reference[j] - seen[static_cast<unsigned>(j)];
      if (j == kSeePhi || j == kSeePsi) off -= turn * std::nearbyint(off / turn);
      more += pilot.gain[i][j] * off;
    }
    if (!used) continue;
    T& c = u[static_cast<unsigned>(i)];
    c += more;
    if (c < pilot.low[i]) c = pilot.low[i];
    if (c > pilot.high[i]) c = pilot.high[i];
  }
}

}  // namespace alula
