#pragma once
// Lookup tables whose numbers the binding keeps, and the term table that names them.
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <deque>
#include <memory>
#include <tuple>
#include <vector>

#include "alula/aero/term_table.hpp"
#include "bind.hpp"

// Breakpoints of each axis, values row by row, cubic, continued by lines.
using TableArgument = std::tuple<std::vector<Vector>, Vector, bool, bool>;

struct TableStore {
  std::deque<std::vector<double>> numbers;  // never move
  std::vector<const std::vector<double>*> axes;
  std::vector<alula::Lookup<double>> views;

  const double* keep(const Vector& from) {
    return numbers.emplace_back(from.data(), from.data() + from.shape(0)).data();
  }

  // Tables with the same breakpoints share them, and so the search in them.
  const double* keep_axis(const Vector& from) {
    const std::vector<double> axis(from.data(), from.data() + from.shape(0));
    for (const auto& known : axes)
      if (*known == axis) return known->data();
    axes.push_back(&numbers.emplace_back(axis));
    return axes.back()->data();
  }

  void add(const TableArgument& table) {
    const auto& [given, values, cubic, line] = table;
    if (given.empty() || given.size() > 3) throw nb::value_error("a table has one to three axes");
    alula::Lookup<double> view;
    std::size_t points = 1;
    for (std::size_t i = 0; i < given.size(); ++i) {
      const std::size_t n = given[i].shape(0);
      for (std::size_t k = 1; k < n; ++k)
        if (!(given[i](k) > given[i](k - 1)))
          throw nb::value_error("breakpoints of a table must increase");
      if (n < 2 || n > 100000) throw nb::value_error("an axis has two breakpoints at least");
      view.axis[i] = keep_axis(given[i]);
      view.size[i] = static_cast<int>(n);
      points *= n;
    }
    if (values.shape(0) != points) throw nb::value_error("a table has one value per point");
    view.axes = static_cast<int>(given.size());
    view.values = keep(values);
    view.interpolation = cubic ? alula::Interpolation::cubic : alula::Interpolation::linear;
    view.outside = line ? alula::Outside::line : alula::Outside::hold;
    views.push_back(view);
  }
};

struct AeroTable {
  alula::TermTable table;
  std::shared_ptr<TableStore> lookups;
};
