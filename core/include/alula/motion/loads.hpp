#pragma once
// What acts on the aircraft at one instant, gravity apart: air, aerodynamics, engines.
#include "alula/motion/aircraft_model.hpp"
#include "alula/motion/atmosphere.hpp"

namespace alula {

// Forces and moments in body axes; moments about the center of gravity as loaded.
template <class S>
struct Loads {
  Air<S> air;
  Vec3<S> v_air, w_air;  // velocity (m/s) and rates (rad/s) against the air, body axes
  FlowAngles<S> flow;
  S mach;
  std::array<S, kCoefficients> coefficients;  // as the model gives them, stall included
  Vec3<S> force, moment;                      // of all
  Vec3<S> engine_force, engine_moment;        // of the engines alone
  S thrust;                                   // N, sum over the engines along their directions
  S engine_rate[kMaxEngines];                 // of the engines' states
  S current, fuel_flow;                       // A, kg/s
};

// Below this airspeed (m/s) there are no flow angles, and no aerodynamic force either.
inline constexpr double kLeastAirspeed = 1e-3;

// A control as the aircraft has it: where there is an actuator, its position.
template <class S, class T>
const S& control(const FlightState<S>& x, const FlightInput<S>& u, const AircraftModel<T>& a,
                 int i) {
  const int at = a.layout.actuator[i];
  return at < 0 ? u[static_cast<unsigned>(i)] : x[at];
}

// Adds to the coefficients what separated flow takes. sine, cosine: of the angle of attack.
template <class S, class T>
void add_stall(const FlightState<S>& x, const AircraftModel<T>& a, const S& sine, const S& cosine,
               Loads<S>& out) {
  const S &left = x[a.layout.stall[0]], &right = x[a.layout.stall[1]];
  const StallIncrements<S> more =
      separation_states(a.stall) == 1
          ? stall_increments(a.stall, out.flow.alpha, left)
          : stall_increments(
                a.stall, out.flow.alpha, local_alpha(a.stall, out.v_air, out.w_air, Wing::left),
                local_alpha(a.stall, out.v_air, out.w_air, Wing::right), left, right, a.b);
  auto& C = out.coefficients;
  if (a.stability_axes) {
    C[0] += more.CD;
    C[2] += more.CL;
  } else {
    C[0] += more.CL * sine - more.CD * cosine;
    C[2] -= more.CL * cosine + more.CD * sine;
  }
  C[3] += more.Cl;
  C[4] += more.Cm;
  C[5] += more.Cn;
}

// What the slipstream of the first propeller has more of axial speed than the free stream, over V;
// 0 where there is no propeller. Pusztai 2018, Eq. (2.10); where the blades brake it is left a
// fifth of the axial speed, his lowest ratio, and in flow from behind the propeller blows as at
// rest. w: rates as the engines take them.
template <class S, class T>
S wash(const FlightState<S>& x, const AircraftModel<T>& a, const Vec3<S>& v_air, const Vec3<S>& w,
       const S& density, const S& V) {
  using std::sqrt;
  constexpr double kPi = 3.14159265358979323846;
  for (int i = 0; i < a.engines.size(); ++i) {
    const Engine<T>& e = a.engines[i];
    if (!has_propeller(e.kind)) continue;
    const S& omega = x[a.layout.engine[i]];
    const S u0 = dot(v_air + cross(w, e.point), e.direction);
    const S ahead = select(value_of(u0) > T(0), u0, S(0));
    const T R = T(0.5) * e.propeller.diameter;
    const S thrust = propeller_loads(e.propeller, omega, u0, density).thrust;
    const S square = ahead * ahead + (T(2.0 / kPi) / (R * R)) * thrust / density;
    const S least = T(0.04) * ahead * ahead;
    const auto blows = value_of(square) > value_of(least) + T(1e-9);
    const S U_i = select(blows, S(sqrt(select(blows, square, S(1)))), S(T(0.2) * ahead));
    return (U_i - u0) / V;
  }
  return S(0);
}

// Adds the aerodynamic force and moment. w_inertial: rates as the engines take them.
template <class S, class T>
void add_aerodynamics(const FlightState<S>& x, const FlightInput<S>& u, const AircraftModel<T>& a,
                      const Vec3<S>& w_inertial, Loads<S>& out) {
  using std::sqrt;
  const Vec3<S>&v = out.v_air, &w = out.w_air;
  const S speed_squared = dot(v, v);
  const auto flows = speed_squared > S(kLeastAirspeed * kLeastAirspeed);
  if (!any(flows)) {
    out.flow = {S(0), S(0), S(0)};
    out.mach = S(0);
    for (S& c : out.coefficients) c = S(0);
    return;
  }
  out.flow = flow_angles(v);
  out.mach = out.flow.V / out.air.speed_of_sound;

  const S half_over_V = S(0.5) / out.flow.V;
  const S span = half_over_V * a.b, chord = half_over_V * a.c;
  S slots[kMaxSlots];
  slots[kOne] = S(1);
  slots[kV] = out.flow.V;
  slots[kAlpha] = out.flow.alpha;
  slots[kBeta] = out.flow.beta;
  slots[kPhat] = w.x * span;
  slots[kQhat] = w.y * chord;
  slots[kRhat] = w.z * span;
  for (int i = 0; i < kControls; ++i) slots[kDe + i] = control(x, u, a, i);
  slots[kMach] = out.mach;
  slots[kWash] = a.washed ? wash(x, a, v, w_inertial, out.air.density, out.flow.V) : S(0);
  fill_slots(a.table, slots, a.lookups,
             [&](const S* s) { return coefficient(a.table, a.values.data(), s, kLift); });
  auto& C = out.coefficients;
  C = a.rows.rows > 0 ? coefficients(a.rows, slots) : coefficients(a.table, a.values.data(), slots);

  const S plane = sqrt(v.x * v.x + v.z * v.z);
  const auto ahead = plane > S(kLeastAirspeed);  // else alpha is taken as zero
  const S inverse = S(1) / plane;
  const S cosine = select(ahead, S(inverse * v.x), S(1));
  const S sine = select(ahead, S(inverse * v.z), S(0));
  if (a.stalls) add_stall(x, a, sine, cosine, out);
  S CX = C[0], CZ = C[2];
  if (a.stability_axes) {
    CX = C[2] * sine - C[0] * cosine;
    CZ = -(C[2] * cosine) - C[0] * sine;
  }
  const S pressure_area = (S(0.5) * out.air.density * speed_squared) * a.S;
  const Vec3<S> aero{pressure_area * CX, pressure_area * C[1], pressure_area * CZ};
  const Vec3<S> about_reference{pressure_area * a.b * C[3], pressure_area * a.c * C[4],
                                pressure_area * a.b * C[5]};
  out.force = out.force + aero;
  out.moment = out.moment + about_reference + cross(a.reference_point, aero);
  if (all(flows)) return;
  // Flights side by side, some of them without flow.
  const auto only = [&flows](S& value) { value = select(flows, value, S(0)); };
  for (S* value : {&out.flow.V, &out.flow.alpha, &out.flow.beta, &out.mach, &out.force.x,
                   &out.force.y, &out.force.z, &out.moment.x, &out.moment.y, &out.moment.z})
    only(*value);
  for (S& c : C) only(c);
}

// Adds what the engines do. w: rates against inertial space.
template <class S, class T>
void add_engines(const FlightState<S>& x, const FlightInput<S>& u, const AircraftModel<T>& a,
                 const Vec3<S>& w, const S& height, Loads<S>& out) {
  const Vec3<S> none{S(0), S(0), S(0)};
  out.engine_force = out.engine_moment = none;
  out.thrust = out.current = out.fuel_flow = S(0);
  if (a.engines.size() == 0) return;
  const S& throttle = control(x, u, a, kControls - 1);
  const S charge = a.layout.charge < 0 ? S(0) : x[a.layout.charge];
  for (int i = 0; i < a.engines.size(); ++i) {
    const int at = a.layout.engine[i];
    const auto one = engine_loads(a.engines[i], at < 0 ? S(0) : x[at], throttle, u[kThrustInput],
                                  out.air, out.mach, height, out.v_air, w, charge);
    out.engine_force = out.engine_force + one.force;
    out.engine_moment = out.engine_moment + one.moment;
    out.engine_rate[i] = one.state_rate;
    out.thrust += one.thrust;
    out.current += one.current;
    out.fuel_flow += one.fuel_flow;
  }
  out.force = out.force + out.engine_force;
  out.moment = out.moment + out.engine_moment;
}

// wind: of the model, or flights side by side each their own.
template <class S, class T, class A>
Loads<S> loads(const FlightState<S>& x, const FlightInput<S>& u, const AircraftModel<T>& a,
               const Wind<A>& wind, const Place<S>& at) {
  const Vec3<S> v{x[7], x[8], x[9]}, w{x[10], x[11], x[12]};
  const Vec3<S> gust{u[kGustInput], u[kGustInput + 1], u[kGustInput + 2]};
  const Vec3<S> gust_rates{u[kGustInput + 3], u[kGustInput + 4], u[kGustInput + 5]};
  Loads<S> out;
  out.air = standard_atmosphere(at.height);
  out.v_air = v - at.R_BN * wind_at(wind, at.height) - gust;
  out.w_air = w - at.earth_rate - gust_rates;
  out.force = out.moment = {S(0), S(0), S(0)};
  add_aerodynamics(x, u, a, w, out);
  add_engines(x, u, a, w, at.height, out);
  return out;
}

}  // namespace alula
