#pragma once
// An engine in the airframe: its force, its moments with those of what turns in it, its own state.
#include <cstdint>

#include "alula/math/vec3.hpp"
#include "alula/motion/atmosphere.hpp"
#include "alula/propulsion/electric.hpp"
#include "alula/propulsion/piston.hpp"
#include "alula/propulsion/propeller.hpp"
#include "alula/propulsion/turbofan.hpp"

namespace alula {

enum class EngineKind : std::uint8_t { given, piston, electric, turbofan };

template <class T>
struct Engine {
  EngineKind kind = EngineKind::given;
  Vec3<T> point{};             // of the thrust's line of action, from the center of gravity, m
  Vec3<T> direction{1, 0, 0};  // unit vector of the thrust
  T share{1};                  // of the given thrust
  Propeller<T> propeller{};    // piston and electric
  Piston<T> piston{};
  Electric<T> electric{};
  Turbofan<T> turbofan{};
};

// Whether the engine has a state: the propeller's speed (rad/s, not below zero) or the power of a
// turbofan (0..1).
constexpr bool has_state(EngineKind kind) { return kind != EngineKind::given; }
constexpr bool has_propeller(EngineKind kind) {
  return kind == EngineKind::piston || kind == EngineKind::electric;
}

template <class S>
struct EngineLoads {
  Vec3<S> force{S(0), S(0), S(0)};   // N, body axes
  Vec3<S> moment{S(0), S(0), S(0)};  // N m about the center of gravity, body axes
  S state_rate{0};
  S current{0};    // A drawn from the battery: the rate of `charge`
  S fuel_flow{0};  // kg/s
  S thrust{0};     // N along the direction
};

// state: see has_state, anything for 'given'; throttle 0..1; given_thrust: N of all given engines
// together; v_air: velocity of the center of gravity against the air, w: body rates, body axes;
// charge: drawn from the battery so far, A s.
//
// Rotors have the angular momentum h along sense times direction. The airframe feels -w x h - dh/dt
// besides the air's torque on the propeller (Dittrich 2016, Eqs. (2.50), (2.51), the gyroscopic
// part with its sign corrected). Speeds are inertial ones about the rotor's axis, so h belongs to
// an inertia tensor of the airframe without the rotors' own axial inertia. A propeller that stands
// is not turned backwards.
template <class S, class T>
constexpr EngineLoads<S> engine_loads(const Engine<T>& e, const S& state, const S& throttle,
                                      const S& given_thrust, const Air<S>& air, const S& mach,
                                      const S& height, const Vec3<S>& v_air, const Vec3<S>& w,
                                      const S& charge) {
  EngineLoads<S> out;
  S along(0);     // moment along the direction: the air's torque and -dh/dt
  S momentum(0);  // h along the direction
  if (has_propeller(e.kind)) {
    const S axial = dot(v_air + cross(w, e.point), e.direction);
    const auto air_loads = propeller_loads(e.propeller, state, axial, air.density);
    T turning = e.propeller.inertia, carried = e.propeller.inertia;
    S shaft(0);
    if (e.kind == EngineKind::piston) {
      const auto piston = piston_loads(e.piston, state, throttle, air.density);
      shaft = piston.torque;
      out.fuel_flow = piston.fuel_flow;
      turning = turning_inertia(e.piston, e.propeller.inertia);
      carried = momentum_inertia(e.piston, e.propeller.inertia);
    } else {
      const auto electric = electric_loads(e.electric, state, throttle, charge);
      shaft = electric.torque;
      out.current = electric.current;
    }
    out.thrust = air_loads.thrust;
    out.state_rate = (T(1) / turning) * (shaft - air_loads.torque);
    const auto turns = (value_of(state) > T(0)) | (value_of(out.state_rate) > T(0));
    out.state_rate = select(turns, out.state_rate, S(0));
    along = -e.propeller.sense * (air_loads.torque + carried * out.state_rate);
    momentum = (e.propeller.sense * carried) * state;
  } else if (e.kind == EngineKind::turbofan) {
    const Turbofan<T>& fan = e.turbofan;
    out.thrust = turbofan_thrust(fan, state, mach, height);
    out.fuel_flow = fan.consumption * out.thrust;
    out.state_rate = turbofan_rate(fan, state, throttle);
    momentum = turbofan_momentum(fan, state);
    along = -(fan.sense * fan.angular_momentum * (T(1) - fan.idle_speed)) * out.state_rate;
  } else {
    out.thrust = e.share * given_thrust;
  }
  out.force = out.thrust * e.direction;
  out.moment = cross(e.point, out.force);
  if (has_state(e.kind))
    out.moment = out.moment + along * e.direction - momentum * cross(w, e.direction);
  return out;
}

}  // namespace alula
