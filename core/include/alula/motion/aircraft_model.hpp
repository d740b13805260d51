#pragma once
// What the equations of motion know of an aircraft. Read-only while it flies.
#include <array>

#include "alula/aero/stall.hpp"
#include "alula/aero/term_table.hpp"
#include "alula/motion/fuel.hpp"
#include "alula/motion/place.hpp"
#include "alula/motion/wind.hpp"
#include "alula/propulsion/engine.hpp"
#include "alula/sensors/actuator.hpp"

namespace alula {

// Positions are from the center of gravity as loaded, body axes, m. After a change of engines,
// actuators, stall or fuel, `layout` is to be set by layout_of.
template <class T>
struct AircraftModel {
  MassProperties<T> body;
  T S{1}, b{1}, c{1};
  Vec3<T> reference_point{};  // where the moment coefficients act

  Earth earth = Earth::flat;
  T gravity{T(kStandardGravity)};  // of the flat Earth, m/s2
  Wind<T> wind{};

  bool stability_axes = false;  // coefficients are CD CY CL instead of CX CY CZ
  TermTable table{};
  std::array<T, kMaxTerms> values{};
  TermRows<T> rows{};  // of table and values, for speed; empty: they are read themselves
  const Lookup<T>* lookups = nullptr;  // the tables that the steps name; the caller's
  bool washed = false;                 // whether the table asks for the slipstream; set by prepare
  bool stalls = false;
  Stall<T> stall{};

  Bounded<Engine<T>, kMaxEngines> engines{};
  bool actuated[kControls] = {};
  std::array<Actuator<T>, kControls> actuators{};
  bool burns = false;  // whether burned fuel changes the mass
  FuelLoad<T> fuel{};

  StateLayout layout{};
};

// The layout that a model asks for. Everything at once may ask for more than kMaxStates: the caller
// looks at `size`.
template <class T>
StateLayout layout_of(const AircraftModel<T>& a) {
  StateLayout layout;
  int next = kBodyStates;
  bool electric = false;
  for (int i = 0; i < a.engines.size(); ++i) {
    if (!has_state(a.engines[i].kind)) continue;
    layout.engine[i] = next++;
    electric = electric || a.engines[i].kind == EngineKind::electric;
  }
  if (electric) layout.charge = next++;
  if (a.stalls) {
    layout.stall[0] = layout.stall[1] = next++;
    if (separation_states(a.stall) == 2) layout.stall[1] = next++;
  }
  for (int i = 0; i < kControls; ++i)
    if (a.actuated[i]) layout.actuator[i] = next++;
  if (a.burns) layout.fuel = next++;
  layout.size = next;
  return layout;
}

template <class T>
void prepare(AircraftModel<T>& a) {
  a.layout = layout_of(a);
  a.rows = term_rows(a.table, a.values.data());
  a.washed = uses(a.table, kWash);
}

}  // namespace alula
