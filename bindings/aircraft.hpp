#pragma once
// The aircraft as the equations of motion take it, with the tables that it looks at.
#include "alula/motion/aircraft_model.hpp"
#include "lookups.hpp"

struct Aircraft {
  alula::AircraftModel<double> model;
  std::shared_ptr<TableStore> lookups;  // of the aerodynamic model
  std::shared_ptr<TableStore> engines = std::make_shared<TableStore>();

  // After every change of what has states.
  void lay_out() {
    alula::prepare(model);
    if (model.layout.size > alula::kMaxStates)
      throw nb::value_error("the aircraft has more states than the core holds (24)");
  }
};

void bind_fly(nb::class_<Aircraft>& c);
void bind_fly_many(nb::class_<Aircraft>& c);
