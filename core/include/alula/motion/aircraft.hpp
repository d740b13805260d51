#pragma once
// The equations of motion of an aircraft: rigid body, flat Earth, standard atmosphere, steady
// wind, aerodynamic model as a term table, one thrust with its line of action.
#include <array>

#include "alula/aero/term_table.hpp"
#include "alula/math/capacity.hpp"
#include "alula/motion/atmosphere.hpp"
#include "alula/motion/flat_earth.hpp"
#include "alula/motion/rigid_body.hpp"

namespace alula {

// State: position NED (m), attitude quaternion, ground velocity in body axes (m/s), body rates.
inline constexpr int kBodyStates = 13;
template <class S>
using BodyState = std::array<S, kBodyStates>;

// Input: de da dr df (rad), dt, thrust (N).
inline constexpr int kBodyInputs = 6;
template <class S>
using BodyInput = std::array<S, kBodyInputs>;

// Read-only while it flies. Positions are from the center of gravity, body axes, m.
template <class T>
struct AircraftModel {
  MassProperties<T> body;
  T S{1}, b{1}, c{1};
  Vec3<T> reference_point{};          // where the moment coefficients act
  Vec3<T> thrust_point{};             // a point of the thrust's line of action
  Vec3<T> thrust_direction{1, 0, 0};  // unit vector
  Vec3<T> wind{};                     // NED, the way it blows to
  T gravity{T(kStandardGravity)};
  bool stability_axes = false;  // coefficients are CD CY CL instead of CX CY CZ
  TermTable table{};
  std::array<T, kMaxTerms> values{};
};

// What acts on the aircraft at one instant; forces and moments in body axes about the center of
// gravity, gravity apart.
template <class S>
struct Loads {
  Air<S> air;
  FlowAngles<S> flow;
  S mach;
  std::array<S, kCoefficients> coefficients;  // as the model gives them
  Vec3<S> force, moment;
};

// Below this airspeed (m/s) there are no flow angles, and no aerodynamic force either.
inline constexpr double kLeastAirspeed = 1e-3;

template <class S, class T>
Loads<S> loads(const BodyState<S>& x, const BodyInput<S>& u, const AircraftModel<T>& a,
               const Mat3<S>& R_BE) {
  using std::sqrt;
  const Vec3<S> w{x[10], x[11], x[12]};
  Loads<S> out;
  out.air = standard_atmosphere(-x[2]);
  const Vec3<S> v = air_velocity(R_BE, Vec3<S>{x[7], x[8], x[9]}, a.wind);
  const Vec3<S> thrust = u[5] * a.thrust_direction;
  out.force = thrust;
  out.moment = cross(a.thrust_point, thrust);

  const S speed_squared = dot(v, v);
  if (!(speed_squared > S(kLeastAirspeed * kLeastAirspeed))) {
    out.flow = {S(0), S(0), S(0)};
    out.mach = S(0);
    out.coefficients = {};
    return out;
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
  for (int i = 0; i < 5; ++i) slots[kDe + i] = u[static_cast<unsigned>(i)];
  slots[kMach] = out.mach;
  fill_slots(a.table, slots);
  out.coefficients = coefficients(a.table, a.values.data(), slots);

  const auto& C = out.coefficients;
  S CX = C[0], CZ = C[2];
  if (a.stability_axes) {
    const S plane = sqrt(v.x * v.x + v.z * v.z);
    const bool along_y = !(plane > S(kLeastAirspeed));  // then alpha is taken as zero
    const S cosine = along_y ? S(1) : v.x / plane, sine = along_y ? S(0) : v.z / plane;
    CX = C[2] * sine - C[0] * cosine;
    CZ = -(C[2] * cosine) - C[0] * sine;
  }
  const S pressure_area = (S(0.5) * out.air.density * speed_squared) * a.S;
  const Vec3<S> aero{pressure_area * CX, pressure_area * C[1], pressure_area * CZ};
  const Vec3<S> about_reference{pressure_area * a.b * C[3], pressure_area * a.c * C[4],
                                pressure_area * a.b * C[5]};
  out.force = out.force + aero;
  out.moment = out.moment + about_reference + cross(a.reference_point, aero);
  return out;
}

// Rate of the state for loads that are known.
template <class S, class T>
void state_rate(const BodyState<S>& x, const Loads<S>& load, const AircraftModel<T>& a,
                const Mat3<S>& R_BE, BodyState<S>& rate) {
  const Vec3<S> v{x[7], x[8], x[9]}, w{x[10], x[11], x[12]};
  const Vec3<S> position = transposed_times(R_BE, v);
  const Quaternion<S> turn =
      attitude_rate(Quaternion<S>{x[3], x[4], x[5], x[6]}, w, S(1));  // pull 1/s: slow and stable
  const Vec3<S> dv =
      velocity_rate((T(1) / a.body.mass) * load.force, gravity_in_body(R_BE, S(a.gravity)), v, w);
  const Vec3<S> dw = angular_acceleration(a.body, load.moment, w);
  rate = {position.x, position.y, position.z, turn.w, turn.x, turn.y, turn.z,
          dv.x,       dv.y,       dv.z,       dw.x,   dw.y,   dw.z};
}

// dx/dt = f(t, x, u, params); nothing in it depends on time.
template <class S, class T>
BodyState<S> derivative(T /*t*/, const BodyState<S>& x, const BodyInput<S>& u,
                        const AircraftModel<T>& params) {
  const Mat3<S> R_BE = earth_to_body(Quaternion<S>{x[3], x[4], x[5], x[6]});
  BodyState<S> rate;
  state_rate(x, loads(x, u, params, R_BE), params, R_BE, rate);
  return rate;
}

}  // namespace alula
