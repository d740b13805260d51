#pragma once
// An engine with a propeller of 1.7 m for the tests of propulsion.
#include "alula/propulsion/engine.hpp"

namespace alula_test {

using alula::EngineKind;
using alula::Vec3;
using Engine = alula::Engine<double>;

inline const double kJ[] = {0.0, 0.2, 0.4, 0.6, 0.8, 1.0};
inline const double kCT[] = {0.11, 0.10, 0.08, 0.052, 0.02, -0.02};
inline const double kCP[] = {0.05, 0.05, 0.046, 0.036, 0.019, -0.005};

inline Engine with_propeller(EngineKind kind, double sense = 1.0) {
  Engine e;
  e.kind = kind;
  e.propeller.diameter = 1.7;
  e.propeller.inertia = 0.6;
  e.propeller.sense = sense;
  alula::make_curve(kJ, kCT, 6, e.propeller.CT);
  alula::make_curve(kJ, kCP, 6, e.propeller.CP);
  const double speed[] = {0.0, 200.0, 500.0, 600.0}, torque[] = {90.0, 110.0, 128.0, 121.0};
  alula::make_curve(speed, torque, 4, e.piston.torque);
  e.piston.reduction = 2.43;
  e.piston.crank_inertia = 0.05;
  e.piston.friction = 15.0;
  e.piston.idle = 0.08;
  e.piston.consumption = 7.5e-8;
  e.electric = {22.5, 0.0444, 1.2, 0.1282, 42.0, 36.0, 14400.0, 90.0, 0.0};
  return e;
}

template <class S>
alula::EngineLoads<S> at(const Engine& e, S state, S throttle, const Vec3<S>& v, const Vec3<S>& w,
                         double height = 0.0) {
  const auto air = alula::standard_atmosphere(S(height));
  return alula::engine_loads(e, state, throttle, S(1000.0), air, S(0.3), S(height), v, w, S(100.0));
}

}  // namespace alula_test
