#pragma once
// An aerodynamic model as a table: steps make products, absolute values, ramps, signs and looked-up
// values out of the base variables; terms add a value times one of these slots to a coefficient.
// In stability axes a step may take up the lift coefficient, for a drag of CD0 + K CL^2.
// Text is parsed to it outside the core; the same bytes serve host and target, and exporters walk
// them. Lookup tables are named by their number; their data lie beside the table, with the caller.
#include <array>
#include <cstdint>
#include <type_traits>

#include "alula/aero/lookup.hpp"
#include "alula/math/capacity.hpp"

namespace alula {

// Base variables, the first slots. Rates are pb/2V, qc/2V, rb/2V; angles rad; V m/s. Wash: what the
// propeller's slipstream has more of axial speed than the free stream, over V.
enum Variable : int {
  kOne,
  kV,
  kAlpha,
  kBeta,
  kPhat,
  kQhat,
  kRhat,
  kDe,
  kDa,
  kDr,
  kDf,
  kDt,
  kMach,
  kWash
};
inline constexpr int kVariables = 14;

// Body axes: CX CY CZ Cl Cm Cn. Stability axes: CD in the place of CX, CL in the place of CZ.
inline constexpr int kCoefficients = 6;
inline constexpr int kMaxSteps = 64;
inline constexpr int kMaxSlots = kVariables + kMaxSteps;

enum class Operation : std::uint8_t {
  multiply,  // slot a times slot b
  absolute,  // |slot a|
  ramp,      // slot a less the knot, where that is positive; else zero
  sign,      // -1, 0 or 1 by the sign of slot a
  lookup,    // lookup table number `table` at slots a, b, c; axes it does not have: slot 0
  lift,      // the lift coefficient; all of its terms have slots before this step
};
inline constexpr int kLift = 2, kDrag = 0;  // places of the coefficients in stability axes

struct Step {
  double knot;
  Operation operation;
  std::uint8_t a, b, c, table;
};

struct Term {
  std::uint8_t coefficient, slot;
};

struct TermTable {
  std::array<Step, kMaxSteps> steps;
  std::array<Term, kMaxTerms> terms;
  std::uint8_t step_count;
  std::uint8_t term_count;
};
static_assert(std::is_trivially_copyable_v<TermTable> && sizeof(TermTable) < 2048);

// Whether every step looks back only, and every index is inside its array. table_count: lookup
// tables that lie beside.
constexpr bool well_formed(const TermTable& table, int table_count = 0) {
  if (table.step_count > kMaxSteps || table.term_count > kMaxTerms) return false;
  for (int i = 0; i < table.step_count; ++i) {
    const Step& step = table.steps[static_cast<unsigned>(i)];
    const int own = kVariables + i;
    if (step.a >= own || step.b >= own || step.c >= own) return false;
    if (step.operation > Operation::lift) return false;
    if (step.operation == Operation::lift)
      for (int k = 0; k < table.term_count; ++k) {
        const Term& term = table.terms[static_cast<unsigned>(k)];
        if (term.coefficient == kLift && term.slot >= own) return false;
      }
    if (step.operation == Operation::lookup && step.table >= table_count) return false;
  }
  for (int k = 0; k < table.term_count; ++k) {
    const Term& term = table.terms[static_cast<unsigned>(k)];
    if (term.coefficient >= kCoefficients || term.slot >= kVariables + table.step_count)
      return false;
  }
  return true;
}

// Whether a base variable is used at all.
constexpr bool uses(const TermTable& table, Variable variable) {
  const auto is = [&](std::uint8_t slot) { return int{slot} == variable; };
  for (int i = 0; i < table.step_count; ++i) {
    const Step& step = table.steps[static_cast<unsigned>(i)];
    if (is(step.a) || is(step.b) || is(step.c)) return true;
  }
  for (int k = 0; k < table.term_count; ++k)
    if (is(table.terms[static_cast<unsigned>(k)].slot)) return true;
  return false;
}

// One coefficient: the terms that belong to it, at slots that are filled as far as they need.
template <class S, class T>
constexpr S coefficient(const TermTable& table, const T* values, const S* slots, int which) {
  S sum(0);
  for (int k = 0; k < table.term_count; ++k) {
    const Term& term = table.terms[static_cast<unsigned>(k)];
    if (term.coefficient == which) sum += values[k] * slots[term.slot];
  }
  return sum;
}

// Stands for the lift coefficient in a table that has no step of it.
struct NoLift {
  template <class S>
  constexpr S operator()(const S*) const {
    return S(0);
  }
};

namespace detail {

// Stands for the lookup tables of a model that has none.
struct NoLookups {
  template <class S, class T>
  constexpr S at(const Lookup<T>&, const S*, int, int, int) const {
    return S(0);
  }
};

template <class S, class T, class Lift, class Tables>
constexpr void fill_slots(const TermTable& table, S* slots, const Lookup<T>* tables, Lift& lift,
                          Tables&& looked_up) {
  for (int i = 0; i < table.step_count; ++i) {
    const Step& step = table.steps[static_cast<unsigned>(i)];
    const S& a = slots[step.a];
    S& out = slots[kVariables + i];
    switch (step.operation) {
      case Operation::multiply: out = a * slots[step.b]; break;
      case Operation::absolute: out = select(a < S(0), S(-a), a); break;
      case Operation::ramp: out = select(a > S(step.knot), S(a - S(step.knot)), S(0)); break;
      case Operation::sign: out = select(a > S(0), S(1), select(a < S(0), S(-1), S(0))); break;
      case Operation::lookup:
        out =
            looked_up.at(tables[step.table], static_cast<const S*>(slots), step.a, step.b, step.c);
        break;
      case Operation::lift: out = lift(static_cast<const S*>(slots)); break;
    }
  }
}

}  // namespace detail

// Fills the slots behind the base variables, which the caller has put into the first places.
// tables: the lookup tables that the steps name. lift(slots): the lift coefficient, which is called
// for where a step needs it.
template <class S, class T = double, class Lift = NoLift>
constexpr void fill_slots(const TermTable& table, S* slots, const Lookup<T>* tables = nullptr,
                          Lift&& lift = {}) {
  if (tables == nullptr)
    detail::fill_slots<S, T>(table, slots, nullptr, lift, detail::NoLookups{});
  else
    detail::fill_slots(table, slots, tables, lift, Lookups<S, T>{});
}

// The coefficients for given slots; values: one per term. A slot is at the same time the
// derivative of its coefficient with respect to the term's value.
template <class S, class T>
constexpr std::array<S, kCoefficients> coefficients(const TermTable& table, const T* values,
                                                    const S* slots) {
  std::array<S, kCoefficients> c{};
  for (S& zero : c) zero = S(0);
  for (int k = 0; k < table.term_count; ++k) {
    const Term& term = table.terms[static_cast<unsigned>(k)];
    c[term.coefficient] += values[k] * slots[term.slot];
  }
  return c;
}

// The same terms in rows of one for each coefficient, filled up with zeros: six sums that do not
// wait for one another, and no branch but the loop. The caller's to make once for a model.
template <class T>
struct TermRows {
  static constexpr int kRows = 12;  // a coefficient with more terms: the table itself is used
  int rows = 0;
  std::array<std::array<std::uint8_t, kCoefficients>, kRows> slot{};
  std::array<std::array<T, kCoefficients>, kRows> value{};
};

template <class T>
constexpr TermRows<T> term_rows(const TermTable& table, const T* values) {
  TermRows<T> out;
  std::array<int, kCoefficients> count{};
  for (int k = 0; k < table.term_count; ++k) {
    const Term& term = table.terms[static_cast<unsigned>(k)];
    const int row = count[term.coefficient]++;
    if (row >= TermRows<T>::kRows) return {};
    if (row >= out.rows) out.rows = row + 1;
    out.slot[static_cast<unsigned>(row)][term.coefficient] = term.slot;
    out.value[static_cast<unsigned>(row)][term.coefficient] = values[k];
  }
  return out;
}

template <class S, class T>
constexpr std::array<S, kCoefficients> coefficients(const TermRows<T>& terms, const S* slots) {
  S c0(0), c1(0), c2(0), c3(0), c4(0), c5(0);
  for (int i = 0; i < terms.rows; ++i) {
    const auto& slot = terms.slot[static_cast<unsigned>(i)];
    const auto& value = terms.value[static_cast<unsigned>(i)];
    c0 += value[0] * slots[slot[0]];
    c1 += value[1] * slots[slot[1]];
    c2 += value[2] * slots[slot[2]];
    c3 += value[3] * slots[slot[3]];
    c4 += value[4] * slots[slot[4]];
    c5 += value[5] * slots[slot[5]];
  }
  return {c0, c1, c2, c3, c4, c5};
}

}  // namespace alula
