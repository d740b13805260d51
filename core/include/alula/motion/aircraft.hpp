#pragma once
// The equations of motion of an aircraft: dx/dt = f(t, x, u, params), and what it feels.
#include "alula/motion/loads.hpp"

namespace alula {

// Outputs: specific force ax ay az (m/s2), pdot qdot rdot (rad/s2), V alpha beta mach density,
// six coefficients, force (N) and moment (N m, about the center of gravity) of the engines, thrust.
inline constexpr int kFlightOutputs = 24;
template <class S>
using FlightOutput = std::array<S, kFlightOutputs>;

// Rates of the body's states and what comes with them. M: scalar of the mass properties.
template <class S, class M>
void body_rate(const FlightState<S>& x, const Place<S>& at, const Loads<S>& load,
               const MassProperties<M>& body, const Vec3<S>& moment, FlightState<S>& rate) {
  const Vec3<S> v{x[7], x[8], x[9]}, w{x[10], x[11], x[12]};
  const Vec3<S> position = transposed_times(at.R_BE, v);
  const Quaternion<S> turn = attitude_rate(Quaternion<S>{x[3], x[4], x[5], x[6]}, w - at.earth_rate,
                                           S(1));  // pull 1/s: slow and stable
  // Coriolis' acceleration counts the Earth's rate twice, once in w already.
  const Vec3<S> dv =
      velocity_rate((M(1) / body.mass) * load.force, at.gravity, v, w + at.earth_rate);
  const Vec3<S> dw = angular_acceleration(body, moment, w);
  // One by one: an array in between would be written in pieces and read as a whole, and wait.
  rate[0] = position.x;
  rate[1] = position.y;
  rate[2] = position.z;
  rate[3] = turn.w;
  rate[4] = turn.x;
  rate[5] = turn.y;
  rate[6] = turn.z;
  rate[7] = dv.x;
  rate[8] = dv.y;
  rate[9] = dv.z;
  rate[10] = dw.x;
  rate[11] = dw.y;
  rate[12] = dw.z;
}

// How the wind grows with height, 1/s: the slope of wind_at.
template <class S, class T>
Vec3<S> wind_slope(const Wind<T>& wind, const S& height) {
  Vec3<S> slope{S(wind.shear.x), S(wind.shear.y), S(wind.shear.z)};
  if (!wind.logarithmic) return slope;
  using std::log;
  const S z = height - wind.ground;
  const T low(kLowestProfile), high(kHighestProfile);
  const T reference = limited(wind.reference_height - wind.ground, low, high);
  const auto grows = (value_of(z) > low) & (value_of(z) < high);
  const S factor = S(1) / (log(reference / wind.roughness) * select(grows, z, S(1)));
  return slope + select(grows, factor, S(0)) * wind.steady;
}

// How fast the angle of attack changes, rad/s; the gust's own rate of change is not known and left
// out, wind that grows with height is in.
template <class S, class A>
S alpha_rate(const FlightState<S>& x, const Wind<A>& wind, const Place<S>& at, const Loads<S>& load,
             const FlightState<S>& rate) {
  const Vec3<S> v{x[7], x[8], x[9]}, w{x[10], x[11], x[12]};
  const Vec3<S> dv{rate[7], rate[8], rate[9]};
  const S climb = -dot(Vec3<S>{at.R_BN.row[0].z, at.R_BN.row[1].z, at.R_BN.row[2].z}, v);
  const Vec3<S> dv_air =
      dv + cross(w, v - load.v_air) - at.R_BN * (climb * wind_slope(wind, at.height));
  const S plane = load.v_air.x * load.v_air.x + load.v_air.z * load.v_air.z;
  const auto flows = plane > S(kLeastAirspeed * kLeastAirspeed);
  const S turn = load.v_air.x * dv_air.z - load.v_air.z * dv_air.x;
  return select(flows, S(turn / select(flows, plane, S(1))), S(0));
}

// Rates of all states, from the loads.
template <class S, class T, class A>
void state_rate(const FlightState<S>& x, const FlightInput<S>& u, const AircraftModel<T>& a,
                const Wind<A>& wind, const Place<S>& at, const Loads<S>& load,
                FlightState<S>& rate) {
  const StateLayout& layout = a.layout;
  rate.length = layout.size;
  if (!a.burns) {
    body_rate(x, at, load, a.body, load.moment, rate);
  } else {
    const auto now = after_burning(a.body, a.fuel, x[layout.fuel]);
    body_rate(x, at, load, now.body, load.moment - cross(now.shift, load.force), rate);
  }
  if (layout.size == kBodyStates) return;
  for (int i = 0; i < a.engines.size(); ++i)
    if (layout.engine[i] >= 0) rate[layout.engine[i]] = load.engine_rate[i];
  if (layout.charge >= 0) rate[layout.charge] = load.current;
  if (a.stalls) {
    const S alpha_dot = alpha_rate(x, wind, at, load, rate);
    const int halves = separation_states(a.stall);
    for (int i = 0; i < halves; ++i) {
      const Wing wing = halves == 1 ? Wing::whole : i == 0 ? Wing::left : Wing::right;
      const S alpha =
          halves == 1 ? load.flow.alpha : local_alpha(a.stall, load.v_air, load.w_air, wing);
      const int place = layout.stall[i];
      rate[place] = separation_rate(a.stall, alpha, alpha_dot, x[place], wing);
    }
  }
  for (int i = 0; i < kControls; ++i) {
    const int place = layout.actuator[i];
    const auto j = static_cast<unsigned>(i);
    if (place >= 0) rate[place] = actuator_rate(a.actuators[j], x[place], u[j]);
  }
  if (layout.fuel >= 0)
    rate[layout.fuel] = select(x[layout.fuel] < S(a.fuel.mass), load.fuel_flow, S(0));
}

// The outputs that belong to loads and to the rate that came of them.
template <class S, class T>
FlightOutput<S> outputs_of(const FlightState<S>& x, const AircraftModel<T>& a, const Loads<S>& load,
                           const FlightState<S>& rate) {
  Vec3<S> moment = load.engine_moment;
  S mass(a.body.mass);
  if (a.burns) {
    const auto now = after_burning(a.body, a.fuel, x[a.layout.fuel]);
    mass = now.body.mass;
    moment = moment - cross(now.shift, load.engine_force);
  }
  const S k = S(1) / mass;
  const auto& c = load.coefficients;
  return {k * load.force.x,
          k * load.force.y,
          k * load.force.z,
          rate[10],
          rate[11],
          rate[12],
          load.flow.V,
          load.flow.alpha,
          load.flow.beta,
          load.mach,
          load.air.density,
          c[0],
          c[1],
          c[2],
          c[3],
          c[4],
          c[5],
          load.engine_force.x,
          load.engine_force.y,
          load.engine_force.z,
          moment.x,
          moment.y,
          moment.z,
          load.thrust};
}

// The rate in a given wind.
template <class S, class T, class A>
void derivative_in(const Wind<A>& wind, const FlightState<S>& x, const FlightInput<S>& u,
                   const AircraftModel<T>& params, FlightState<S>& rate) {
  const Place<S> at = place(x, params.earth, params.gravity);
  state_rate(x, u, params, wind, at, loads(x, u, params, wind, at), rate);
}

// The same with the outputs.
template <class S, class T, class A>
void derivative_and_outputs_in(const Wind<A>& wind, const FlightState<S>& x,
                               const FlightInput<S>& u, const AircraftModel<T>& params,
                               FlightState<S>& rate, FlightOutput<S>& y) {
  const Place<S> at = place(x, params.earth, params.gravity);
  const Loads<S> load = loads(x, u, params, wind, at);
  state_rate(x, u, params, wind, at, load, rate);
  y = outputs_of(x, params, load, rate);
}

// dx/dt = f(t, x, u, params); nothing in it depends on time.
template <class S, class T>
void derivative(T /*t*/, const FlightState<S>& x, const FlightInput<S>& u,
                const AircraftModel<T>& params, FlightState<S>& rate) {
  derivative_in(params.wind, x, u, params, rate);
}

template <class S, class T>
FlightState<S> derivative(T t, const FlightState<S>& x, const FlightInput<S>& u,
                          const AircraftModel<T>& params) {
  FlightState<S> rate;
  derivative(t, x, u, params, rate);
  return rate;
}

// The same with the outputs.
template <class S, class T>
void derivative_and_outputs(const FlightState<S>& x, const FlightInput<S>& u,
                            const AircraftModel<T>& params, FlightState<S>& rate,
                            FlightOutput<S>& y) {
  derivative_and_outputs_in(params.wind, x, u, params, rate, y);
}

}  // namespace alula
