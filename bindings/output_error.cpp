// Output error and filter error: one maneuver with its model, flown for the sums of a Gauss-Newton
// step, or filtered for its innovations.
#include "alula/estimate/output_error.hpp"

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "alula/estimate/filter_error.hpp"
#include "arrays.hpp"
#include "bind.hpp"
#include "lookups.hpp"

namespace {

using Numbers = nb::ndarray<nb::numpy, double>;
using Counts = nb::ndarray<nb::numpy, std::int64_t>;
using Integers = std::vector<int>;
constexpr auto kLongitudinal = alula::Axes::longitudinal;
constexpr auto kLateral = alula::Axes::lateral;
constexpr auto kSix = alula::Axes::six;

void require(bool good, const char* what) {
  if (!good) throw nb::value_error(what);
}

// A maneuver with copies of its arrays.
struct Maneuver {
  AeroTable aero;
  std::vector<double> t, inputs, measured;
  alula::MeasuredManeuver m;
  alula::Axes axes = kSix;

  alula::MeasuredManeuver view() const {
    alula::MeasuredManeuver v = m;
    v.table = &aero.table;
    v.lookups = aero.lookups->views.data();
    v.t = t.data();
    v.inputs = inputs.data();
    v.measured = measured.data();
    return v;
  }

  int fly(const double* values, const double* initial, const double* bias,
          alula::OutputErrorSums& sums) const {
    const alula::MeasuredManeuver v = view();
    if (axes == kLongitudinal)
      return alula::fly_maneuver<kLongitudinal>(v, values, initial, bias, sums);
    if (axes == kLateral) return alula::fly_maneuver<kLateral>(v, values, initial, bias, sums);
    return alula::fly_maneuver<kSix>(v, values, initial, bias, sums);
  }
};

template <alula::Axes axes>
bool has_state(int variable) {
  for (int state : alula::Kernel<axes>::state)
    if (state == variable) return true;
  return false;
}

// Whether the kernel of these axes has all that is asked for.
template <alula::Axes axes>
bool serves(const Maneuver& x) {
  for (int i = 0; i < alula::kMotionVariables; ++i)
    if (x.m.is_state[i] && !has_state<axes>(i)) return false;
  for (int k = 0; k < x.aero.table.term_count; ++k)
    if (alula::force_of<axes>(x.aero.table.terms[static_cast<unsigned>(k)].coefficient) < 0)
      return false;
  constexpr bool longitudinal = axes == kLongitudinal;
  for (int o = 0; o < x.m.outputs; ++o) {
    const int which = x.m.output[o];
    const bool symmetric =
        which == alula::kOutAx || which == alula::kOutAz || which == alula::kOutQdot;
    if (which < alula::kMotionVariables ? !has_state<axes>(which) : symmetric != longitudinal)
      return false;
  }
  return true;
}

void make(Maneuver* self, const AeroTable& aero, bool stability_axes, Vector reference, Vector body,
          Matrix inertia, Vector arm, const Integers& states, Vector pull, const Integers& outputs,
          Vector t, Matrix inputs, Matrix measured, int substeps) {
  require(reference.shape(0) == 3 && body.shape(0) == 2, "reference (S, b, c), body (mass, g)");
  require(inertia.shape(0) == 3 && inertia.shape(1) == 3, "inertia (3, 3)");
  require(pull.shape(0) == alula::kMotionVariables, "pull (8)");
  require(outputs.size() <= alula::kMeasuredOutputs, "at most 14 outputs");
  const std::size_t n = t.shape(0);
  require(n > 1 && inputs.shape(0) == n && inputs.shape(1) == alula::kManeuverInputs,
          "inputs (n, 28), n > 1");
  require(measured.shape(0) == n && measured.shape(1) == outputs.size(), "measured (n, outputs)");
  require(substeps >= 1 && substeps <= 1000, "substeps 1 to 1000");
  new (self) Maneuver{aero, {t.data(), t.data() + n}, {}, {}, {}, kSix};
  self->inputs.assign(inputs.data(), inputs.data() + inputs.size());
  self->measured.assign(measured.data(), measured.data() + measured.size());
  alula::MeasuredManeuver& m = self->m;
  m.stability_axes = stability_axes;
  m.S = reference(0), m.b = reference(1), m.c = reference(2);
  m.mass = body(0), m.gravity = body(1);
  for (std::size_t i = 0; i < 3; ++i)
    m.inertia.row[i] = {inertia(i, 0), inertia(i, 1), inertia(i, 2)};
  m.inertia_inverse = alula::inverse(m.inertia);
  m.arm = vec3(arm, "arm (3)");
  for (int state : states) {
    require(state >= 0 && state < alula::kMotionVariables, "a state is 0 to 7");
    m.is_state[state] = true;
  }
  for (int i = 0; i < alula::kMotionVariables; ++i) m.pull[i] = pull(static_cast<std::size_t>(i));
  m.substeps = substeps;
  m.samples = static_cast<int>(n);
  m.outputs = static_cast<int>(outputs.size());
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    require(outputs[o] >= 0 && outputs[o] < alula::kMeasuredOutputs, "an output is 0 to 13");
    m.output[o] = outputs[o];
  }
  std::fill_n(m.term_column, alula::kMaxTerms, -1);
  std::fill_n(m.initial_column, alula::kMotionVariables, -1);
  std::fill_n(m.bias_column, alula::kMeasuredOutputs, -1);
  self->axes = serves<kLongitudinal>(*self) ? kLongitudinal
               : serves<kLateral>(*self)    ? kLateral
                                            : kSix;
}

void columns(Maneuver& self, int count, const Integers& terms, Vector weights,
             const Integers& initial, const Integers& bias) {
  alula::MeasuredManeuver& m = self.m;
  require(count >= 0 && count <= alula::kMaxParameters, "at most 64 parameters");
  require(static_cast<int>(terms.size()) == self.aero.table.term_count &&
              weights.shape(0) == terms.size(),
          "terms, weights: one per term");
  require(initial.size() == alula::kMotionVariables, "initial (8)");
  require(static_cast<int>(bias.size()) == m.outputs, "bias: one per output");
  for (const Integers* list : {&terms, &initial, &bias})
    for (int column : *list) require(column >= -1 && column < count, "a column that is not there");
  m.columns = count;
  std::copy(terms.begin(), terms.end(), m.term_column);
  std::copy(weights.data(), weights.data() + weights.shape(0), m.term_weight);
  std::copy(initial.begin(), initial.end(), m.initial_column);
  std::copy(bias.begin(), bias.end(), m.bias_column);
}

void check(const Maneuver& self, Vector values, Vector initial, Vector bias) {
  require(static_cast<int>(values.shape(0)) == self.aero.table.term_count, "values: one per term");
  require(initial.shape(0) == alula::kMotionVariables, "initial (8)");
  require(static_cast<int>(bias.shape(0)) == self.m.outputs, "bias: one per output");
}

std::tuple<int, Numbers, Numbers, Numbers, Counts> sums(const Maneuver& self, Vector values,
                                                        Vector initial, Vector bias) {
  check(self, values, initial, bias);
  const int ny = self.m.outputs, k = self.m.columns, rows = alula::rows_of(ny);
  std::vector<double> products(static_cast<std::size_t>(k * k * rows)),
      slopes(static_cast<std::size_t>(k * rows));
  alula::OutputErrorSums s;
  s.information = products.data();
  s.gradient = slopes.data();
  const int flown = self.fly(values.data(), initial.data(), bias.data(), s);
  Array<double> information({ny, k, k}), gradient({ny, k}), squares({ny});
  Array<std::int64_t> counts({ny});
  for (int o = 0; o < ny; ++o) {
    squares.data()[o] = s.squares[o];
    counts.data()[o] = s.counts[o];
    double* full = information.data() + o * k * k;
    for (int i = 0; i < k; ++i) {
      gradient.data()[o * k + i] = s.gradient[i * rows + o];
      for (int j = i; j < k; ++j)
        full[i * k + j] = full[j * k + i] = s.information[(i * k + j) * rows + o];
    }
  }
  return {flown, information.numpy(), gradient.numpy(), squares.numpy(), counts.numpy()};
}

std::tuple<int, Numbers, Numbers> flight(const Maneuver& self, Vector values, Vector initial,
                                         Vector bias, bool sensitivity) {
  check(self, values, initial, bias);
  const int n = self.m.samples, ny = self.m.outputs;
  Array<double> y({n, ny}), slopes({sensitivity ? n : 0, ny, self.m.columns});
  alula::OutputErrorSums s;
  s.predicted = y.data();
  if (sensitivity) s.sensitivity = slopes.data();
  const int flown = self.fly(values.data(), initial.data(), bias.data(), s);
  return {flown, y.numpy(), slopes.numpy()};
}

std::tuple<bool, Numbers, Numbers, Numbers> innovations(const Maneuver& self, Matrix values,
                                                        Matrix initial, Matrix process,
                                                        Matrix noise) {
  const std::size_t count = values.shape(0);
  require(static_cast<int>(values.shape(1)) == self.aero.table.term_count &&
              initial.shape(1) == alula::kMotionVariables &&
              process.shape(1) == alula::kMotionVariables &&
              static_cast<int>(noise.shape(1)) == self.m.outputs,
          "values (m, terms), initial (m, 8), process (m, 8), noise (m, outputs)");
  require(initial.shape(0) == count && process.shape(0) == count && noise.shape(0) == count,
          "one row of each for every filter");
  const int n = self.m.samples, ny = self.m.outputs, filters = static_cast<int>(count);
  Array<double> y({filters, n, ny}), v({filters, n, ny}), S({filters, n, ny, ny});
  const alula::MeasuredManeuver m = self.view();
  const auto pass = self.axes == kLongitudinal ? alula::filter_maneuver<kLongitudinal>
                    : self.axes == kLateral    ? alula::filter_maneuver<kLateral>
                                               : alula::filter_maneuver<kSix>;
  bool whole = true;
  {
    nb::gil_scoped_release release;
    for (int i = 0; i < filters && whole; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const long rows = static_cast<long>(i) * n * ny;
      whole = pass(m, &values(row, 0), &initial(row, 0), &process(row, 0), &noise(row, 0),
                   y.data() + rows, v.data() + rows, S.data() + rows * ny) == n;
    }
  }
  return {whole, v.numpy(), S.numpy(), y.numpy()};
}

}  // namespace

void bind_output_error(nb::module_& m) {
  nb::class_<Maneuver>(
      m, "ManeuverFit",
      "One maneuver and the model whose values are asked for. reference: S, b, c. body: mass\n"
      "(kg), gravity. arm: from the CG to the moments' reference point. states: indices into\n"
      "V alpha beta p q r phi theta; the others come from the inputs. pull (8): 1/s. outputs:\n"
      "indices into the same eight and ax ay az pdot qdot rdot. inputs (n, 28): the eight as\n"
      "measured, de da dr df dt, density, 1 / speed of sound, force (3), moment (3), measured\n"
      "coefficients (6), unused. measured (n, outputs): NaN where there is none. Copies are kept.")
      .def("__init__", &make, nb::arg("aero"), nb::arg("stability_axes"), nb::arg("reference"),
           nb::arg("body"), nb::arg("inertia"), nb::arg("arm"), nb::arg("states"), nb::arg("pull"),
           nb::arg("outputs"), nb::arg("t"), nb::arg("inputs"), nb::arg("measured"),
           nb::arg("substeps") = 1)
      .def("columns", &columns, nb::arg("count"), nb::arg("terms"), nb::arg("weights"),
           nb::arg("initial"), nb::arg("bias"),
           "Which column of the parameters each term, initial variable (8) and output's bias is;\n"
           "-1: fixed. A term's slope by its column is its weight.")
      .def("sums", &sums, nb::arg("values"), nb::arg("initial"), nb::arg("bias"),
           "Samples flown (fewer than all: diverged), and by output: information (k, k),\n"
           "gradient (k,), squared residuals, samples.")
      .def("flight", &flight, nb::arg("values"), nb::arg("initial"), nb::arg("bias"),
           nb::arg("sensitivity") = true,
           "Samples flown, outputs (n, outputs), their slopes (n, outputs, k), or (0, ...).")
      .def("innovations", &innovations, nb::arg("values"), nb::arg("initial"), nb::arg("process"),
           nb::arg("noise"),
           "Of m extended filters: values (m, terms), initial and intensity F F' of the process\n"
           "noise (m, 8), variance of the sensors (m, outputs). Whether all came to the end,\n"
           "innovations, their covariances, predicted outputs.")
      .def_prop_ro("axes", [](const Maneuver& x) {
        return x.axes == kLongitudinal ? "longitudinal" : x.axes == kLateral ? "lateral" : "six";
      });
}
