// The term table: built from small matrices, evaluated over arrays.
#include <cstdint>
#include <cstring>

#include "alula/aero/term_table.hpp"
#include "bind.hpp"

namespace {

using alula::TermTable;

// An index that came as a double, or 255 (never valid) where it is not a small whole number.
std::uint8_t index_from(double x) {
  return x >= 0.0 && x < 255.0 && x == static_cast<double>(static_cast<int>(x))
             ? static_cast<std::uint8_t>(x)
             : std::uint8_t{255};
}

void build(TermTable* self, Matrix steps, Matrix terms) {
  if (steps.shape(1) != 4 || terms.shape(1) != 2)
    throw nb::value_error("expected steps (m, 4) and terms (k, 2)");
  if (steps.shape(0) > alula::kMaxSteps || terms.shape(0) > alula::kMaxTerms)
    throw nb::value_error("the model has more steps or terms than the table holds");
  new (self) TermTable();  // zeroed, so that equal models are equal bytes
  self->step_count = static_cast<std::uint8_t>(steps.shape(0));
  self->term_count = static_cast<std::uint8_t>(terms.shape(0));
  for (std::size_t i = 0; i < steps.shape(0); ++i) {
    self->steps[i].operation = static_cast<alula::Operation>(index_from(steps(i, 0)));
    self->steps[i].a = index_from(steps(i, 1));
    self->steps[i].b = index_from(steps(i, 2));
    self->steps[i].knot = steps(i, 3);
  }
  for (std::size_t k = 0; k < terms.shape(0); ++k)
    self->terms[k] = {index_from(terms(k, 0)), index_from(terms(k, 1))};
  if (!alula::well_formed(*self))
    throw nb::value_error("a step or term refers to a slot that does not exist before it");
}

void evaluate(const TermTable& self, Vector values, Matrix variables, MatrixOut out) {
  if (values.shape(0) != self.term_count) throw nb::value_error("values: one per term expected");
  if (variables.shape(1) != alula::kVariables || out.shape(1) != alula::kCoefficients ||
      out.shape(0) != variables.shape(0))
    throw nb::value_error("expected variables (n, 13) and out (n, 6)");
  double slots[alula::kMaxSlots];
  for (std::size_t i = 0; i < variables.shape(0); ++i) {
    for (std::size_t j = 0; j < alula::kVariables; ++j) slots[j] = variables(i, j);
    alula::fill_slots(self, slots);
    const auto c = alula::coefficients(self, values.data(), slots);
    for (std::size_t j = 0; j < alula::kCoefficients; ++j) out(i, j) = c[j];
  }
}

}  // namespace

void bind_aero(nb::module_& m) {
  nb::class_<TermTable>(m, "TermTable",
                        "An aerodynamic model as steps (operation, a, b, knot) and terms\n"
                        "(coefficient, slot). Operations: 0 multiply, 1 absolute, 2 ramp.")
      .def("__init__", &build, nb::arg("steps"), nb::arg("terms"))
      .def("evaluate", &evaluate, nb::arg("values"), nb::arg("variables"), nb::arg("out"),
           "Coefficients (n, 6) for variables (n, 13): 1 V alpha beta phat qhat rhat de da dr df\n"
           "dt mach; values: one per term.")
      .def_prop_ro("term_count", [](const TermTable& t) { return int{t.term_count}; })
      .def_prop_ro("step_count", [](const TermTable& t) { return int{t.step_count}; });
}
