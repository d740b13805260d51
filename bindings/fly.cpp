// Flying an aircraft, its rates and its exact linearization.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <cmath>
#include <cstring>
#include <optional>
#include <tuple>

#include "aircraft.hpp"
#include "alula/motion/flight_run.hpp"
#include "alula/motion/jacobian.hpp"
#include "alula/motion/settle.hpp"
#include "arrays.hpp"

namespace {

using Flags = nb::ndarray<const bool, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using State = alula::FlightState<double>;
using Input = alula::FlightInput<double>;

State state_from(const Aircraft& self, const Vector& x) {
  State state;
  state.length = self.model.layout.size;
  if (x.shape(0) != static_cast<std::size_t>(state.length))
    throw nb::value_error("x: one number per state expected (state_count)");
  std::memcpy(state.data.data(), x.data(), x.shape(0) * sizeof(double));
  return state;
}

// Six numbers are controls in still air.
Input input_from(const Vector& u) {
  if (u.shape(0) != 6 && u.shape(0) != alula::kFlightInputs)
    throw nb::value_error("u: expected 6 or 12 numbers");
  Input input{};
  std::memcpy(input.data(), u.data(), u.shape(0) * sizeof(double));
  return input;
}

void expect(bool as_expected, const char* what) {
  if (!as_expected) throw nb::value_error(what);
}

template <class A>
bool is(const A& a, std::size_t rows, std::size_t columns) {
  return a.shape(0) == rows && a.shape(1) == columns;
}

int fly(const Aircraft& self, Vector x0, Matrix controls, double dt, int substeps, MatrixOut states,
        MatrixOut outputs, MatrixOut inputs, bool hold, const std::optional<Matrix>& gusts,
        const std::optional<Vector>& turbulence, const std::optional<Matrix>& normals,
        const std::optional<Matrix>& gains, const std::optional<Matrix>& limits,
        const std::optional<Matrix>& references, const std::optional<Flags>& active) {
  const std::size_t n = controls.shape(0);
  const State x = state_from(self, x0);
  expect(is(controls, n, 6) && n > 0, "controls: expected (n, 6)");
  expect(is(states, n, x0.shape(0)) && is(outputs, n, alula::kFlightOutputs) &&
             is(inputs, n, alula::kFlightInputs),
         "expected states (n, state_count), outputs (n, 24), inputs (n, 12)");
  expect(substeps >= 1 && dt > 0.0, "dt and substeps must be positive");
  alula::FlightPlan<double> plan;
  plan.samples = static_cast<int>(n);
  plan.substeps = substeps;
  plan.dt = dt;
  plan.controls = controls.data();
  plan.hold = hold;
  if (gusts) {
    expect(is(*gusts, n, 6), "gusts: expected (n, 6)");
    plan.gusts = gusts->data();
  }
  alula::Dryden<double> dryden;
  if (turbulence) {
    const std::size_t steps = (n - 1) * static_cast<std::size_t>(substeps) + 1;
    expect(turbulence->shape(0) == 3 && normals && is(*normals, steps, alula::kDrydenNormals),
           "expected turbulence (span, W20, sigma), normals ((n - 1) substeps + 1, 8)");
    dryden = {(*turbulence)(0), (*turbulence)(1), (*turbulence)(2)};
    plan.turbulence = &dryden;
    plan.normals = normals->data();
  }
  alula::Pilot<double> pilot;
  if (gains) {
    expect(is(*gains, alula::kControls, alula::kSights) && limits &&
               is(*limits, alula::kControls, 2) && references &&
               is(*references, n, alula::kSights) && active && active->shape(0) == n,
           "expected gains (5, 10), limits (5, 2), references (n, 10), active (n)");
    for (std::size_t i = 0; i < alula::kControls; ++i) {
      for (std::size_t j = 0; j < alula::kSights; ++j) pilot.gain[i][j] = (*gains)(i, j);
      pilot.low[i] = (*limits)(i, 0);
      pilot.high[i] = (*limits)(i, 1);
    }
    plan.pilot = &pilot;
    plan.references = references->data();
    plan.active = reinterpret_cast<const unsigned char*>(active->data());
  }
  nb::gil_scoped_release unlocked;
  return alula::fly(self.model, x, plan,
                    alula::FlightRecord<double>{states.data(), outputs.data(), inputs.data()});
}

void rates(const Aircraft& self, Vector x, Vector u, VectorOut dx, VectorOut y) {
  expect(dx.shape(0) == x.shape(0) && y.shape(0) == alula::kFlightOutputs,
         "expected dx like x, y (24)");
  State rate;
  alula::FlightOutput<double> output;
  alula::derivative_and_outputs(state_from(self, x), input_from(u), self.model, rate, output);
  std::memcpy(dx.data(), rate.data.data(), dx.shape(0) * sizeof(double));
  std::memcpy(y.data(), output.data(), sizeof output);
}

using Numpy = nb::ndarray<nb::numpy, double>;
using Jacobians = std::tuple<Numpy, Numpy, Numpy, Numpy>;

Jacobians jacobian(const Aircraft& self, Vector x, Vector u) {
  const int n = self.model.layout.size;
  Array<double> A({n, n}), B({n, alula::kFlightInputs});
  Array<double> C({alula::kFlightOutputs, n}), D({alula::kFlightOutputs, alula::kFlightInputs});
  alula::jacobian(state_from(self, x), input_from(u), self.model, A.data(), B.data(), C.data(),
                  D.data());
  return {A.numpy(), B.numpy(), C.numpy(), D.numpy()};
}

// The first thirteen states, and charge and fuel, as given; the others as they settle.
void settle(const Aircraft& self, Vector x, Vector u, VectorOut out) {
  const auto n = static_cast<std::size_t>(self.model.layout.size);
  expect((x.shape(0) == alula::kBodyStates || x.shape(0) == n) && out.shape(0) == n,
         "expected x (13 or state_count), out (state_count)");
  State state;
  std::memcpy(state.data.data(), x.data(), x.shape(0) * sizeof(double));
  alula::settle(self.model, input_from(u), state);
  std::memcpy(out.data(), state.data.data(), n * sizeof(double));
}

}  // namespace

void bind_fly(nb::class_<Aircraft>& c) {
  c.def("fly", &fly, nb::arg("x0"), nb::arg("controls"), nb::arg("dt"), nb::arg("substeps"),
        nb::arg("states"), nb::arg("outputs"), nb::arg("inputs"), nb::arg("hold") = false,
        nb::arg("gusts") = nb::none(), nb::arg("turbulence") = nb::none(),
        nb::arg("normals") = nb::none(), nb::arg("gains") = nb::none(),
        nb::arg("limits") = nb::none(), nb::arg("references") = nb::none(),
        nb::arg("active") = nb::none(),
        "Fly from x0 (state_count) under controls (n, 6) with RK4; write states (n,\n"
        "state_count), outputs (n, 24) and inputs (n, 12) as flown; return the number of samples\n"
        "before the state stopped being finite. hold: controls stay between samples, else lines.\n"
        "gusts (n, 6); turbulence (span, W20, sigma) with normals ((n - 1) substeps + 1, 8); a\n"
        "pilot: gains (5, 10), limits (5, 2), references (n, 10), active (n).")
      .def("rates", &rates, nb::arg("x"), nb::arg("u"), nb::arg("dx"), nb::arg("y"),
           "State rates dx (state_count) and outputs y (24) at one state and input (6 or 12).")
      .def("jacobian", &jacobian, nb::arg("x"), nb::arg("u"),
           "A (n, n), B (n, 12), C (24, n), D (24, 12), exact, at a state and an input.")
      .def("settle", &settle, nb::arg("x"), nb::arg("u"), nb::arg("out"),
           "The state with rotors, power, separation and actuators as they come to rest in this\n"
           "motion; x: 13 states or all.");
}
