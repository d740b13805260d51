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

struct Lookups {
  std::deque<std::vector<double>> numbers;  // never move
  std::vector<alula::Lookup<double>> views;

  const double* keep(const Vector& from) {
    return numbers.emplace_back(from.data(), from.data() + from.shape(0)).data();
  }

  void add(const TableArgument& table) {
    const auto& [axes, values, cubic, line] = table;
    if (axes.empty() || axes.size() > 3) throw nb::value_error("a table has one to three axes");
    alula::Lookup<double> view;
    std::size_t points = 1;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const std::size_t n = axes[i].shape(0);
      for (std::size_t k = 1; k < n; ++k)
        if (!(axes[i](k) > axes[i](k - 1)))
          throw nb::value_error("breakpoints of a table must increase");
      if (n < 2 || n > 100000) throw nb::value_error("an axis has two breakpoints at least");
      view.axis[i] = keep(axes[i]);
      view.size[i] = static_cast<int>(n);
      points *= n;
    }
    if (values.shape(0) != points) throw nb::value_error("a table has one value per point");
    view.axes = static_cast<int>(axes.size());
    view.values = keep(values);
    view.interpolation = cubic ? alula::Interpolation::cubic : alula::Interpolation::linear;
    view.outside = line ? alula::Outside::line : alula::Outside::hold;
    views.push_back(view);
  }
};

struct AeroTable {
  alula::TermTable table;
  std::shared_ptr<Lookups> lookups;
};
