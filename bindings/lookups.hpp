#pragma once
// Lookup tables whose numbers the binding keeps, and the term table that names them.
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <deque>
#include <memory>
#include <tuple>
#include <utility>
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

  // Tables with the same breakpoints share them.
  void set_axis(alula::Lookup<double>& view, std::size_t k, const Vector& from) {
    const std::vector<double> axis(from.data(), from.data() + from.shape(0));
    std::size_t i = 0;
    while (i < axes.size() && *axes[i] != axis) ++i;
    if (i == axes.size()) axes.push_back(&numbers.emplace_back(axis));
    view.axis[k] = axes[i]->data();
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
      set_axis(view, i, given[i]);
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

// Numbers the axes that steps look up at the same slot, so that they share the search.
inline void share_axes(const alula::TermTable& table, std::vector<alula::Lookup<double>>& views) {
  std::vector<std::pair<const double*, int>> known;
  for (int i = 0; i < table.step_count; ++i) {
    const alula::Step& step = table.steps[static_cast<unsigned>(i)];
    if (step.operation != alula::Operation::lookup) continue;
    alula::Lookup<double>& view = views[step.table];
    const int slots[] = {step.a, step.b, step.c};
    for (std::size_t k = 0; k < static_cast<std::size_t>(view.axes); ++k) {
      const std::pair<const double*, int> key{view.axis[k], slots[k]};
      std::size_t at = 0;
      while (at < known.size() && known[at] != key) ++at;
      if (at == known.size()) known.push_back(key);
      view.shared[k] = static_cast<std::int8_t>(at < alula::kSharedAxes ? at : -1);
    }
  }
}

struct AeroTable {
  alula::TermTable table;
  std::shared_ptr<TableStore> lookups;
};
