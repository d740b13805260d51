#pragma once
// Where each state of an aircraft stands. The first thirteen are there always; the others follow
// in the order of this file, and only where the aircraft has what they describe.
#include <array>

#include "alula/math/bounded.hpp"
#include "alula/math/capacity.hpp"

namespace alula {

// Position (flat Earth: NED; WGS-84: ECEF; m), quaternion to body axes (from NED; from ECEF),
// velocity against the Earth in body axes (m/s), rates against inertial space (rad/s).
enum BodyPlace : int { kPosition = 0, kAttitude = 3, kVelocity = 7, kRates = 10 };
inline constexpr int kBodyStates = 13;

template <class S>
using FlightState = Bounded<S, kMaxStates>;

// Inputs: de da dr df (rad), dt (0 to 1), thrust (N, of engines whose thrust is given), then the
// gust: velocity of the air in body axes (m/s) and its rates (rad/s).
inline constexpr int kControls = 5;
inline constexpr int kThrustInput = 5;
inline constexpr int kGustInput = 6;
inline constexpr int kFlightInputs = 12;
template <class S>
using FlightInput = std::array<S, kFlightInputs>;

inline constexpr int kMaxEngines = 4;

// Places of the states behind the first thirteen; -1: there is none.
struct StateLayout {
  int engine[kMaxEngines] = {-1, -1, -1, -1};      // rotor speed (rad/s), or lagged thrust of a jet
  int charge = -1;                                 // drawn from the battery, A s
  int stall[2] = {-1, -1};                         // separation point; of the left and right half
  int actuator[kControls] = {-1, -1, -1, -1, -1};  // positions of de da dr df dt
  int fuel = -1;                                   // burned, kg
  int size = kBodyStates;
};

}  // namespace alula
