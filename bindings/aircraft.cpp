// Building an aircraft: mass, aerodynamics, engines, actuators, stall, fuel, wind.
#include "aircraft.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <cstring>
#include <string>

#include "alula/motion/aircraft.hpp"

namespace {

using alula::Engine;
using alula::EngineKind;

alula::Mat3<double> mat3(const Matrix& m, const char* what) {
  if (m.shape(0) != 3 || m.shape(1) != 3) throw nb::value_error(what);
  alula::Mat3<double> out;
  for (std::size_t i = 0; i < 3; ++i) out.row[i] = {m(i, 0), m(i, 1), m(i, 2)};
  return out;
}

void build(Aircraft* self, double mass, Matrix inertia, Vector geometry, Vector reference_point,
           double gravity, bool stability_axes, const AeroTable& table, Vector values, bool wgs84) {
  const auto reference = vec3(geometry, "geometry: expected S, b, c");
  const auto point = vec3(reference_point, "reference_point: expected three numbers");
  const auto J = mat3(inertia, "inertia: expected shape (3, 3)");
  if (values.shape(0) != table.table.term_count)
    throw nb::value_error("values: one per term expected");
  new (self) Aircraft();
  auto& a = self->model;
  a.body = alula::mass_properties(mass, J);
  a.S = reference.x;
  a.b = reference.y;
  a.c = reference.z;
  a.reference_point = point;
  a.gravity = gravity;
  a.earth = wgs84 ? alula::Earth::wgs84 : alula::Earth::flat;
  a.stability_axes = stability_axes;
  a.table = table.table;
  std::memcpy(a.values.data(), values.data(), values.shape(0) * sizeof(double));
  self->lookups = table.lookups;
  a.lookups = table.lookups->views.data();
  self->lay_out();
}

Engine<double> engine_at(EngineKind kind, const Vector& point, const Vector& direction) {
  Engine<double> engine;
  engine.kind = kind;
  engine.point = vec3(point, "point: expected three numbers");
  engine.direction = vec3(direction, "direction: expected three numbers");
  return engine;
}

void add(Aircraft& self, const Engine<double>& engine) {
  if (!self.model.engines.push(engine)) throw nb::value_error("at most four engines");
  self.lay_out();
}

alula::Curve<double> curve(const Vector& x, const Vector& y, const char* what) {
  alula::Curve<double> out;
  if (x.shape(0) != y.shape(0) ||
      !alula::make_curve(x.data(), y.data(), static_cast<int>(x.shape(0)), out))
    throw nb::value_error(what);
  return out;
}

alula::Propeller<double> propeller(double diameter, double inertia, double sense, const Vector& J,
                                   const Vector& CT, const Vector& CP) {
  constexpr const char* what = "J, CT, CP: expected 1 to 24 points with increasing J";
  return {diameter, inertia, sense, curve(J, CT, what), curve(J, CP, what)};
}

void add_piston(Aircraft& self, Vector point, Vector direction, double diameter, double inertia,
                double sense, Vector J, Vector CT, Vector CP, Vector omega, Vector torque,
                double reduction, double gear_sense, double crank_inertia, double friction,
                double idle, double consumption) {
  auto engine = engine_at(EngineKind::piston, point, direction);
  engine.propeller = propeller(diameter, inertia, sense, J, CT, CP);
  auto& p = engine.piston;
  p.torque = curve(omega, torque, "torque: expected 1 to 24 points with increasing speed");
  p.reduction = reduction;
  p.gear_sense = gear_sense;
  p.crank_inertia = crank_inertia;
  p.friction = friction;
  p.idle = idle;
  p.consumption = consumption;
  add(self, engine);
}

void add_electric(Aircraft& self, Vector point, Vector direction, double diameter, double inertia,
                  double sense, Vector J, Vector CT, Vector CP, double k_V, double k_T,
                  double no_load_current, double resistance, double full_voltage,
                  double empty_voltage, double capacity, double most_current,
                  double most_regenerated_current) {
  auto engine = engine_at(EngineKind::electric, point, direction);
  engine.propeller = propeller(diameter, inertia, sense, J, CT, CP);
  engine.electric = {k_V,        k_T,          no_load_current,
                     resistance, full_voltage, empty_voltage,
                     capacity,   most_current, most_regenerated_current};
  add(self, engine);
}

void add_turbofan(Aircraft& self, Vector point, Vector direction, const TableArgument& idle,
                  const TableArgument& military, const std::optional<TableArgument>& maximum,
                  double military_at, double tau, double consumption, double angular_momentum,
                  double sense, double idle_speed) {
  auto engine = engine_at(EngineKind::turbofan, point, direction);
  auto& fan = engine.turbofan;
  auto& kept = *self.engines;
  kept.add(idle);
  fan.idle = kept.views.back();
  kept.add(military);
  fan.military = kept.views.back();
  if (maximum) {
    kept.add(*maximum);
    fan.maximum = kept.views.back();
  }
  fan.military_at = military_at;
  fan.tau = tau;
  fan.consumption = consumption;
  fan.angular_momentum = angular_momentum;
  fan.sense = sense;
  fan.idle_speed = idle_speed;
  add(self, engine);
}

void set_actuator(Aircraft& self, int control, double tau, double rate_limit, double low,
                  double high, double dead_band, double tau_down) {
  if (control < 0 || control >= alula::kControls) throw nb::value_error("control: 0 to 4");
  self.model.actuated[control] = true;
  self.model.actuators[static_cast<unsigned>(control)] = {tau,  rate_limit, low,
                                                          high, dead_band,  tau_down};
  self.lay_out();
}

void set_stall(Aircraft& self, double a1, double alpha_star, double tau1, double tau2,
               double CL_alpha, double alpha_0, double CD_X, double Cm_X, double y_station,
               double alpha_star_difference) {
  self.model.stalls = true;
  self.model.stall = {a1,      alpha_star, tau1, tau2,      CL_alpha,
                      alpha_0, CD_X,       Cm_X, y_station, alpha_star_difference};
  self.lay_out();
}

void set_fuel(Aircraft& self, double mass, Vector position, Matrix inertia) {
  self.model.burns = true;
  self.model.fuel = {mass, vec3(position, "position: expected three numbers"),
                     mat3(inertia, "inertia: expected shape (3, 3)")};
  self.lay_out();
}

void set_wind(Aircraft& self, Vector steady, Vector shear, double reference_height,
              bool logarithmic, double roughness, double ground) {
  self.model.wind = {vec3(steady, "steady: expected three numbers"),
                     vec3(shear, "shear: expected three numbers"),
                     reference_height,
                     logarithmic,
                     roughness,
                     ground};
}

std::vector<std::string> further_states(const Aircraft& self) {
  const auto& a = self.model;
  std::vector<std::string> names(static_cast<std::size_t>(a.layout.size - alula::kBodyStates));
  const auto name = [&](int place, std::string what) {
    if (place >= 0) names[static_cast<std::size_t>(place - alula::kBodyStates)] = std::move(what);
  };
  const bool several = a.engines.size() > 1;
  for (int i = 0; i < a.engines.size(); ++i)
    name(a.layout.engine[i],
         std::string(alula::has_propeller(a.engines[i].kind) ? "omega" : "power") +
             (several ? "_" + std::to_string(i + 1) : ""));
  name(a.layout.charge, "charge");
  const bool split = a.stalls && alula::separation_states(a.stall) == 2;
  name(a.layout.stall[0], split ? "X_left" : "X");
  if (split) name(a.layout.stall[1], "X_right");
  constexpr const char* controls[] = {"de", "da", "dr", "df", "dt"};
  for (int i = 0; i < alula::kControls; ++i) name(a.layout.actuator[i], controls[i]);
  name(a.layout.fuel, "fuel_used");
  return names;
}

}  // namespace

void bind_aircraft(nb::module_& m) {
  auto c = nb::class_<Aircraft>(
      m, "AircraftModel",
      "A rigid aircraft with its aerodynamic model, engines and what else has states.\n"
      "Positions are from the center of gravity, body axes, m; geometry: S, b, c.");
  c.def("__init__", &build, nb::arg("mass"), nb::arg("inertia"), nb::arg("geometry"),
        nb::arg("reference_point"), nb::arg("gravity"), nb::arg("stability_axes"), nb::arg("table"),
        nb::arg("values"), nb::arg("wgs84") = false)
      .def(
          "add_given",
          [](Aircraft& self, Vector point, Vector direction, double share) {
            auto engine = engine_at(EngineKind::given, point, direction);
            engine.share = share;
            add(self, engine);
          },
          nb::arg("point"), nb::arg("direction"), nb::arg("share"),
          "An engine whose thrust is an input; share: its part of it.")
      .def("add_piston", &add_piston, nb::arg("point"), nb::arg("direction"), nb::arg("diameter"),
           nb::arg("inertia"), nb::arg("sense"), nb::arg("J"), nb::arg("CT"), nb::arg("CP"),
           nb::arg("omega"), nb::arg("torque"), nb::arg("reduction"), nb::arg("gear_sense"),
           nb::arg("crank_inertia"), nb::arg("friction"), nb::arg("idle"), nb::arg("consumption"),
           "A piston engine with propeller: see propulsion/piston.hpp and propeller.hpp.")
      .def("add_electric", &add_electric, nb::arg("point"), nb::arg("direction"),
           nb::arg("diameter"), nb::arg("inertia"), nb::arg("sense"), nb::arg("J"), nb::arg("CT"),
           nb::arg("CP"), nb::arg("k_V"), nb::arg("k_T"), nb::arg("no_load_current"),
           nb::arg("resistance"), nb::arg("full_voltage"), nb::arg("empty_voltage"),
           nb::arg("capacity"), nb::arg("most_current"), nb::arg("most_regenerated_current"),
           "An electric motor with propeller: see propulsion/electric.hpp and propeller.hpp.")
      .def("add_turbofan", &add_turbofan, nb::arg("point"), nb::arg("direction"), nb::arg("idle"),
           nb::arg("military"), nb::arg("maximum").none(), nb::arg("military_at"), nb::arg("tau"),
           nb::arg("consumption"), nb::arg("angular_momentum"), nb::arg("sense"),
           nb::arg("idle_speed"),
           "A turbofan; tables over Mach number and height, as TermTable takes them.")
      .def("set_actuator", &set_actuator, nb::arg("control"), nb::arg("tau"), nb::arg("rate_limit"),
           nb::arg("low"), nb::arg("high"), nb::arg("dead_band"), nb::arg("tau_down"),
           "The actuator of control 0 to 4: de da dr df dt.")
      .def("set_stall", &set_stall, nb::arg("a1"), nb::arg("alpha_star"), nb::arg("tau1"),
           nb::arg("tau2"), nb::arg("CL_alpha"), nb::arg("alpha_0"), nb::arg("CD_X"),
           nb::arg("Cm_X"), nb::arg("y_station"), nb::arg("alpha_star_difference"),
           "Separation of the flow: see aero/stall.hpp.")
      .def("set_fuel", &set_fuel, nb::arg("mass"), nb::arg("position"), nb::arg("inertia"),
           "Fuel aboard that burns: kg, its center, its inertia about it.")
      .def("set_wind", &set_wind, nb::arg("steady"), nb::arg("shear"), nb::arg("reference_height"),
           nb::arg("logarithmic"), nb::arg("roughness"), nb::arg("ground"),
           "Wind, NED, the way it blows to: see motion/wind.hpp.")
      .def_prop_ro("further_states", &further_states,
                   "Names of the states behind position, attitude, velocity and rates.")
      .def_prop_ro("state_count", [](const Aircraft& a) { return a.model.layout.size; })
      .def_prop_ro("input_count", [](const Aircraft&) { return alula::kFlightInputs; })
      .def_prop_ro("output_count", [](const Aircraft&) { return alula::kFlightOutputs; });
  bind_fly(c);
  bind_fly_many(c);
}
