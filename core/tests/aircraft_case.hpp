#pragma once
// A light aircraft for tests: bare, or with everything that has a state.
#include "alula/motion/flight_run.hpp"

namespace aircraft_case {

template <class T>
alula::AircraftModel<T> light_aircraft() {
  alula::AircraftModel<T> a;
  a.body = alula::mass_properties(
      T(560),
      alula::Mat3<T>{{{T(655), T(0), T(-30)}, {T(0), T(723), T(0)}, {T(-30), T(0), T(1139)}}});
  a.S = T(10.6);
  a.b = T(8.65);
  a.c = T(1.25);
  a.reference_point = {T(0.1), T(0), T(0.05)};
  a.wind.steady = {T(4), T(-3), T(0)};
  a.stability_axes = true;
  alula::Engine<T> given;
  given.point = {T(1.6), T(0), T(-0.05)};
  a.engines.push(given);
  struct Entry {
    int coefficient, slot;
    double value;
  };
  using namespace alula;
  const Entry entries[] = {{0, kOne, .051},          {0, kAlpha, .69},        {2, kOne, .488},
                           {2, kAlpha, 5.07},        {2, kDe, .473},          {4, kOne, -.1},
                           {4, kAlpha, -.43},        {4, kQhat, -25.},        {4, kDe, -2.08},
                           {1, kBeta, -.55},         {3, kPhat, -.47},        {3, kBeta, -.085},
                           {5, kBeta, .08},          {5, kRhat, -.11},        {0, kVariables, .5},
                           {1, kVariables + 1, .01}, {1, kVariables + 2, .02}};
  a.table.steps[0] = {0.0, Operation::multiply, kAlpha, kAlpha, 0, 0};
  a.table.steps[1] = {0.0, Operation::absolute, kBeta, 0, 0, 0};
  a.table.steps[2] = {0.05, Operation::ramp, kAlpha, 0, 0, 0};
  a.table.step_count = 3;
  for (const Entry& e : entries) {
    a.values[a.table.term_count] = T(e.value);
    a.table.terms[a.table.term_count++] = {static_cast<std::uint8_t>(e.coefficient),
                                           static_cast<std::uint8_t>(e.slot)};
  }
  prepare(a);
  return a;
}

// Piston engine, electric motor, split stall, two actuators, fuel, a lookup table, shear.
struct Full {
  alula::AircraftModel<double> a = light_aircraft<double>();
  double breakpoints[4] = {-0.2, 0.0, 0.15, 0.4}, table[4] = {0.0, 0.01, 0.03, 0.01};
  alula::Lookup<double> lookup;

  Full() {
    using namespace alula;
    lookup.axis[0] = breakpoints;
    lookup.size[0] = 4;
    lookup.values = table;
    lookup.axes = 1;
    lookup.interpolation = Interpolation::cubic;
    a.lookups = &lookup;
    a.table.steps[3] = {0.0, Operation::lookup, kAlpha, 0, 0, 0};
    a.table.steps[4] = {0.0, Operation::sign, kBeta, 0, 0, 0};
    a.table.step_count = 5;
    a.values[a.table.term_count] = 1.0;
    a.table.terms[a.table.term_count++] = {0, kVariables + 3};
    a.values[a.table.term_count] = 0.01;
    a.table.terms[a.table.term_count++] = {3, kVariables + 4};

    const double J[] = {0, .2, .4, .6, .8, 1.0}, CT[] = {.11, .105, .09, .065, .03, -.02};
    const double CP[] = {.05, .052, .05, .043, .028, .0}, speed[] = {0, 200, 300, 450, 600};
    const double torque[] = {80, 110, 125, 128, 118};
    Engine<double> piston;
    piston.kind = EngineKind::piston;
    piston.point = {1.6, 0.1, -0.05};
    piston.propeller = {1.7, 0.3, 1.0, {}, {}};
    make_curve(J, CT, 6, piston.propeller.CT);
    make_curve(J, CP, 6, piston.propeller.CP);
    make_curve(speed, torque, 5, piston.piston.torque);
    piston.piston.reduction = 2.43;
    piston.piston.gear_sense = -1;
    piston.piston.crank_inertia = 0.05;
    piston.piston.friction = 12;
    piston.piston.idle = 0.1;
    piston.piston.consumption = 8e-8;
    Engine<double> electric = piston;
    electric.kind = EngineKind::electric;
    electric.point = {-0.5, -1.2, 0.2};
    electric.electric = {20.0, 0.05, 1.0, 0.05, 50.0, 40.0, 36000.0, 200.0, 0.0};
    a.engines.push(piston);
    a.engines.push(electric);

    a.stalls = true;
    a.stall = {22.0, 0.2, 0.15, 0.1, 5.07, -0.09, 0.1, -0.1, 2.0, 0.02};
    a.actuated[0] = a.actuated[4] = true;
    a.actuators[0] = {0.05, 2.0, -0.4, 0.4, 0.0, 0.0};
    a.actuators[4] = {0.2, 0.0, 0.0, 1.0, 0.0, 0.4};
    a.burns = true;
    a.fuel = {60.0, {0.1, 0.05, 0.2}, {{{30, 0, 0}, {0, 2, 0}, {0, 0, 31}}}};
    a.wind.shear = {0.01, -0.02, 0.0};
    a.wind.reference_height = 500.0;
    prepare(a);
  }
  Full(const Full&) = delete;
  Full& operator=(const Full&) = delete;
};

template <class T>
alula::FlightState<T> level_flight() {
  alula::FlightState<T> x;
  x.length = alula::kBodyStates;
  const double start[] = {0, 0, -900, .999, .02, .03, .01, 45, 1, 1.5, .1, .05, -.05};
  for (int i = 0; i < alula::kBodyStates; ++i) x[i] = T(start[i]);
  return x;
}

// The same at 40 degrees north, 10 east.
inline alula::FlightState<double> over_wgs84(alula::FlightState<double> x) {
  const auto r = alula::ecef(0.7, 0.17, -x[2]);
  const auto q = alula::north_east_down_attitude(0.7, 0.17) *
                 alula::Quaternion<double>{x[3], x[4], x[5], x[6]};
  const double start[] = {r.x, r.y, r.z, q.w, q.x, q.y, q.z};
  for (int i = 0; i < 7; ++i) x[i] = start[i];
  return x;
}

}  // namespace aircraft_case
