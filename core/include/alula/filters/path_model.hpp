#pragma once
// Flight path reconstruction as a table: which unknowns are estimated, which sensors there are,
// where they sit. Read-only while a filter runs; one instantiation serves every sensor set.
// Source: van den Hoek 2017, Eq. (3) to (7); Dittrich 2016, Eq. (3.1) to (3.4).
#include <alula/math/bounded.hpp>
#include <alula/math/capacity.hpp>
#include <alula/motion/point_kinematics.hpp>
#include <type_traits>

namespace alula {

// Unknowns shared by all sensors. A scale error e makes the sensor read (1 + e) times the truth,
// plus its bias.
enum PathUnknown {
  kBiasAx,
  kBiasAy,
  kBiasAz,
  kBiasP,
  kBiasQ,
  kBiasR,
  kScaleAx,
  kScaleAy,
  kScaleAz,
  kScaleP,
  kScaleQ,
  kScaleR,
  kWindNorth,
  kWindEast,
  kWindDown,
  kPathUnknowns
};

enum class Quantity : int {
  height,
  phi,
  theta,
  psi,
  airspeed,
  alpha,         // vane: atan(w/u) of the local air velocity
  alpha_linear,  // upwash on the angle at the inertial sensor, rotation added apart (v.d. Hoek (5))
  beta,          // asin(v/V) of the local air velocity
  beta_flank,    // vane on a vertical axis: atan(v/u)
  beta_linear,   // as alpha_linear, for asin(v/V)
  velocity_north,
  velocity_east,
  velocity_down,
  north,
  east,
};

// One sensor: reads reference + (1 + scale)(quantity - reference) + bias + noise. `position` is
// from the inertial sensor, body axes [m]. Slots are state indices, -1 where a number is fixed.
// For upwash the scale acts on the flow angle alone where the quantity is a `_linear` one.
template <class T>
struct PathSensor {
  Quantity quantity = Quantity::height;
  T position[3] = {0, 0, 0};
  T variance = 1;
  T reference = 0;
  T scale = 0, bias = 0;
  int scale_slot = -1, bias_slot = -1;
};

template <class T>
struct PathModel {
  int states = kMotionStates;   // all: motion, then constants
  int motion = kMotionStates;   // 7, or 9 with position
  int dynamic = kMotionStates;  // the first so many enter the rates: motion, inertial errors
  T gravity = T(9.80665);
  int slot[kPathUnknowns];      // state index or -1
  T fixed[kPathUnknowns] = {};  // value where there is no slot
  bool wind = false;
  T input_sigma[kInertialInputs] = {};
  T walk[kMaxStates] = {};  // random walk of the constants, unit per square root of a second
  Bounded<PathSensor<T>, kMaxOutputs> sensors;

  PathModel() {
    for (int& s : slot) s = -1;
  }
};

template <class T>
inline bool at_inertial_sensor(const PathSensor<T>& s) {
  return s.position[0] == T(0) && s.position[1] == T(0) && s.position[2] == T(0);
}

// Calls step(N) with the number of motion states as a constant. With position there are seldom few
// states, so that only the long rows serve them: half the code.
template <int R, class T, class Step>
inline bool by_motion(const PathModel<T>& model, Step step) {
  if (model.motion == kMotionStates) return step(std::integral_constant<int, kMotionStates>{});
  if constexpr (R == kLongRow)
    return step(std::integral_constant<int, kMotionStatesWithPosition>{});
  else
    return false;
}

// Whether the short rows hold the model; otherwise the long ones do.
template <class T>
inline bool short_rows(const PathModel<T>& model) {
  return model.states < kShortRow && model.motion == kMotionStates;
}

// The value of an unknown under state x.
template <class S, class T>
inline S unknown(const PathModel<T>& model, const S* x, int k) {
  return model.slot[k] >= 0 ? x[model.slot[k]] : S(model.fixed[k]);
}

// Inputs m (6) freed from bias and scale error, those from `first` on: 0 is all, 3 the rates.
// Dittrich 2016, Eq. (3.1), (3.2).
template <class S, class T>
inline void true_inputs(const PathModel<T>& model, const S* x, const T* measured, S* m,
                        int first = 0) {
  for (int i = first; i < kInertialInputs; ++i) {
    m[i] = S(measured[i]) - unknown(model, x, kBiasAx + i);
    if (model.slot[kScaleAx + i] >= 0 || model.fixed[kScaleAx + i] != T(0))
      m[i] = m[i] / (S(T(1)) + unknown(model, x, kScaleAx + i));
  }
}

// The state that a sensor reads as it is, -1 where it takes arithmetic.
template <class T>
inline int plain_state(const PathSensor<T>& sensor) {
  if (sensor.scale_slot >= 0 || sensor.bias_slot >= 0 || sensor.scale != T(0) ||
      sensor.bias != T(0))
    return -1;
  switch (sensor.quantity) {
    case Quantity::phi: return kPhi;
    case Quantity::theta: return kTheta;
    case Quantity::psi: return kPsi;
    case Quantity::height: return at_inertial_sensor(sensor) ? kHeight : -1;
    default: return -1;
  }
}

// What all sensors share at one instant: air velocity of the inertial sensor in body axes with its
// magnitude, and the rates.
template <class S>
struct PathAir {
  S u, v, w, p, q, r, speed;
};

// Air-relative velocity at the inertial sensor: v_B - R_BE wind.
template <class S, class T>
inline PathAir<S> path_air(const PathModel<T>& model, const S* y, const S* wind, const S* m) {
  PathAir<S> a{y[kU], y[kV], y[kW], m[3], m[4], m[5], S(T(0))};
  if (model.wind) {
    S sp, cp, st, ct, sy, cy;
    sincos(y[kPhi], sp, cp);
    sincos(y[kTheta], st, ct);
    sincos(y[kPsi], sy, cy);
    const S along = wind[0] * cy + wind[1] * sy, across = wind[1] * cy - wind[0] * sy;
    const S tilted = along * st + wind[2] * ct;
    a.u -= along * ct - wind[2] * st;
    a.v -= across * cp + tilted * sp;
    a.w -= tilted * cp - across * sp;
  }
  a.speed = sqrt(a.u * a.u + a.v * a.v + a.w * a.w);
  return a;
}

// The quantity that a sensor would read without scale error and bias, at its own place: local
// velocity v + w x r. For `_linear` angles also `induced`, the part that upwash leaves alone.
template <class S, class T>
inline S path_quantity(const PathSensor<T>& sensor, const S* y, const PathAir<S>& air, S& induced) {
  induced = S(T(0));
  switch (sensor.quantity) {  // what takes no arithmetic
    case Quantity::phi: return y[kPhi];
    case Quantity::theta: return y[kTheta];
    case Quantity::psi: return y[kPsi];
    case Quantity::height:
      if (at_inertial_sensor(sensor)) return y[kHeight];
      break;
    case Quantity::airspeed:
      if (at_inertial_sensor(sensor)) return air.speed;
      break;
    default: break;
  }
  const S x(sensor.position[0]), ry(sensor.position[1]), z(sensor.position[2]);
  const S du = air.q * z - air.r * ry, dv = air.r * x - air.p * z, dw = air.p * ry - air.q * x;
  switch (sensor.quantity) {
    case Quantity::airspeed: {
      const S u = air.u + du, v = air.v + dv, w = air.w + dw;
      return sqrt(u * u + v * v + w * w);
    }
    case Quantity::alpha: return atan2(air.w + dw, air.u + du);
    case Quantity::beta: {
      const S u = air.u + du, v = air.v + dv, w = air.w + dw;
      return atan2(v, sqrt(u * u + w * w));
    }
    case Quantity::beta_flank: return atan2(air.v + dv, air.u + du);
    case Quantity::alpha_linear: {
      induced = dw / air.speed;
      return atan2(air.w, air.u);
    }
    case Quantity::beta_linear: {
      induced = dv / air.speed;
      return atan2(air.v, sqrt(air.u * air.u + air.w * air.w));
    }
    default: break;
  }

  // Velocity or position in Earth axes of a point that is not the inertial sensor.
  S sp, cp, st, ct, sy, cy;
  const bool velocity = sensor.quantity == Quantity::velocity_north ||
                        sensor.quantity == Quantity::velocity_east ||
                        sensor.quantity == Quantity::velocity_down;
  S bx = x, by = ry, bz = z;  // body components of the vector to rotate
  if (velocity) {
    bx = y[kU] + du;
    by = y[kV] + dv;
    bz = y[kW] + dw;
  }
  sincos(y[kPhi], sp, cp);
  sincos(y[kTheta], st, ct);
  const S side = by * sp + bz * cp;
  if (sensor.quantity == Quantity::height) return y[kHeight] + bx * st - side * ct;
  if (sensor.quantity == Quantity::velocity_down) return side * ct - bx * st;
  sincos(y[kPsi], sy, cy);
  const S forward = bx * ct + side * st, right = by * cp - bz * sp;
  if (sensor.quantity == Quantity::velocity_north) return forward * cy - right * sy;
  if (sensor.quantity == Quantity::velocity_east) return forward * sy + right * cy;
  if (sensor.quantity == Quantity::north) return y[kNorth] + forward * cy - right * sy;
  return y[kEast] + forward * sy + right * cy;
}

// The reading of sensor i under the whole state x.
template <class S, class T>
inline S path_output(const PathSensor<T>& sensor, const S* x, const PathAir<S>& air) {
  S induced;
  const S true_value = path_quantity(sensor, x, air, induced);
  if (sensor.scale_slot < 0 && sensor.bias_slot < 0 && sensor.scale == T(0) && sensor.bias == T(0))
    return true_value + induced;
  const S scale = sensor.scale_slot >= 0 ? x[sensor.scale_slot] : S(sensor.scale);
  const S bias = sensor.bias_slot >= 0 ? x[sensor.bias_slot] : S(sensor.bias);
  const S reference(sensor.reference);
  return true_value + scale * (true_value - reference) + induced + bias;
}

// Attitude readings may be a turn away from the continuous state.
template <class T>
inline T wrapped(Quantity quantity, T innovation) {
  if (quantity != Quantity::phi && quantity != Quantity::psi) return innovation;
  constexpr T turn = T(6.283185307179586476925);
  return innovation - turn * std::nearbyint(innovation / turn);
}

}  // namespace alula
