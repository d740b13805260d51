// The term table: built from small matrices, evaluated over arrays.
#include "alula/aero/term_table.hpp"

#include <cstdint>

#include "lookups.hpp"

namespace {

// An index that came as a double, or 255 (never valid) where it is not a small whole number.
std::uint8_t index_from(double x) {
  return x >= 0.0 && x < 255.0 && x == static_cast<double>(static_cast<int>(x))
             ? static_cast<std::uint8_t>(x)
             : std::uint8_t{255};
}

void build(AeroTable* made, Matrix steps, Matrix terms, const std::vector<TableArgument>& tables) {
  const std::size_t width = steps.shape(1);
  if ((width != 4 && width != 6) || terms.shape(1) != 2)
    throw nb::value_error("expected steps (m, 4 or 6) and terms (k, 2)");
  if (steps.shape(0) > alula::kMaxSteps || terms.shape(0) > alula::kMaxTerms)
    throw nb::value_error("the model has more steps or terms than the table holds");
  if (tables.size() > 255) throw nb::value_error("at most 255 lookup tables");
  auto lookups = std::make_shared<TableStore>();
  for (const TableArgument& table : tables) lookups->add(table);
  new (made) AeroTable{{}, lookups};
  alula::TermTable* self = &made->table;
  self->step_count = static_cast<std::uint8_t>(steps.shape(0));
  self->term_count = static_cast<std::uint8_t>(terms.shape(0));
  for (std::size_t i = 0; i < steps.shape(0); ++i) {
    self->steps[i].operation = static_cast<alula::Operation>(index_from(steps(i, 0)));
    self->steps[i].a = index_from(steps(i, 1));
    self->steps[i].b = index_from(steps(i, 2));
    self->steps[i].knot = steps(i, 3);
    self->steps[i].c = width == 6 ? index_from(steps(i, 4)) : std::uint8_t{0};
    self->steps[i].table = width == 6 ? index_from(steps(i, 5)) : std::uint8_t{0};
  }
  for (std::size_t k = 0; k < terms.shape(0); ++k)
    self->terms[k] = {index_from(terms(k, 0)), index_from(terms(k, 1))};
  if (!alula::well_formed(*self, static_cast<int>(tables.size())))
    throw nb::value_error("a step or term refers to a slot that does not exist before it");
  share_axes(*self, lookups->views);
}

void evaluate(const AeroTable& bound, Vector values, Matrix variables, MatrixOut out) {
  const alula::TermTable& self = bound.table;
  if (values.shape(0) != self.term_count) throw nb::value_error("values: one per term expected");
  if (variables.shape(1) != alula::kVariables || out.shape(1) != alula::kCoefficients ||
      out.shape(0) != variables.shape(0))
    throw nb::value_error("expected variables (n, 14) and out (n, 6)");
  double slots[alula::kMaxSlots];
  for (std::size_t i = 0; i < variables.shape(0); ++i) {
    for (std::size_t j = 0; j < alula::kVariables; ++j) slots[j] = variables(i, j);
    alula::fill_slots(self, slots, bound.lookups->views.data(), [&](const double* s) {
      return alula::coefficient(self, values.data(), s, alula::kLift);
    });
    const auto c = alula::coefficients(self, values.data(), slots);
    for (std::size_t j = 0; j < alula::kCoefficients; ++j) out(i, j) = c[j];
  }
}

}  // namespace

void bind_aero(nb::module_& m) {
  nb::class_<AeroTable>(
      m, "TermTable",
      "An aerodynamic model as steps (operation, a, b, knot) or (operation, a,\n"
      "b, knot, c, table) and terms (coefficient, slot). Operations: 0 multiply,\n"
      "1 absolute, 2 ramp, 3 sign, 4 lookup of table number `table` at slots a,\n"
      "b, c (0 for axes it does not have), 5 the lift coefficient. tables: (breakpoints of each "
      "axis,\n"
      "values row by row, cubic, continued by lines); their numbers are copied.")
      .def("__init__", &build, nb::arg("steps"), nb::arg("terms"),
           nb::arg("tables") = std::vector<TableArgument>())
      .def("evaluate", &evaluate, nb::arg("values"), nb::arg("variables"), nb::arg("out"),
           "Coefficients (n, 6) for variables (n, 14): 1 V alpha beta phat qhat rhat de da dr df\n"
           "dt mach wash; values: one per term.")
      .def_prop_ro("term_count", [](const AeroTable& t) { return int{t.table.term_count}; })
      .def_prop_ro("step_count", [](const AeroTable& t) { return int{t.table.step_count}; })
      .def_prop_ro("table_count", [](const AeroTable& t) { return t.lookups->views.size(); });
}
