// Flying several flights of one aircraft side by side.
#include <nanobind/stl/optional.h>

#include <algorithm>
#include <array>
#include <optional>

#include "aircraft.hpp"
#include "alula/motion/flights_run.hpp"

namespace {

using Counts = nb::ndarray<int, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

constexpr std::size_t kWindNumbers = 9;

alula::Wind<double> wind_of(const double* w, bool logarithmic) {
  return {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}, w[6], logarithmic, w[7], w[8]};
}

template <class A>
bool is(const A& a, std::size_t flights, std::size_t rows, std::size_t columns) {
  return a.shape(0) == flights && a.shape(1) == rows && a.shape(2) == columns;
}

void fly_many(const Aircraft& self, Matrix starts, Cube controls, Matrix winds, bool logarithmic,
              double dt, int substeps, CubeOut states, CubeOut outputs, CubeOut inputs,
              Counts flown, bool hold, const std::optional<Cube>& gusts) {
  const std::size_t k = starts.shape(0), m = starts.shape(1), n = states.shape(1);
  const bool fits = m == static_cast<std::size_t>(self.model.layout.size) && n > 0 &&
                    winds.shape(0) == k && winds.shape(1) == kWindNumbers && flown.shape(0) == k &&
                    is(states, k, n, m) && is(outputs, k, n, alula::kFlightOutputs) &&
                    is(inputs, k, n, alula::kFlightInputs) &&
                    (is(controls, k, n, 6) || is(controls, 1, n, 6)) &&
                    (!gusts || is(*gusts, k, n, 6) || is(*gusts, 1, n, 6));
  if (!fits)
    throw nb::value_error(
        "expected starts (k, state_count), controls (k or 1, n, 6), winds (k, 9), states (k, n,\n"
        "state_count), outputs (k, n, 24), inputs (k, n, 12), flown (k), gusts (k or 1, n, 6)");
  if (substeps < 1 || !(dt > 0.0)) throw nb::value_error("dt and substeps must be positive");
  nb::gil_scoped_release unlocked;
  const auto row_of = [n](const Cube& one_or_each, std::size_t flight) {
    return one_or_each.data() + (one_or_each.shape(0) == 1 ? 0 : flight) * n * 6;
  };
  constexpr int W = alula::kLanes;
  for (std::size_t first = 0; first < k; first += W) {
    alula::OneOfMany<double> flights[W];
    std::array<alula::OneOfMany<double>*, W> each;
    for (std::size_t w = 0; w < W; ++w) {
      // Lanes that are left over fly the last flight once more and write the same.
      const std::size_t i = std::min(first + w, k - 1);
      auto& f = flights[w];
      f.start = starts.data() + i * m;
      f.controls = row_of(controls, i);
      f.gusts = gusts ? row_of(*gusts, i) : nullptr;
      f.wind = wind_of(winds.data() + i * kWindNumbers, logarithmic);
      f.record = {states.data() + i * n * m, outputs.data() + i * n * alula::kFlightOutputs,
                  inputs.data() + i * n * alula::kFlightInputs};
      each[w] = &f;
    }
    alula::fly_side_by_side<W>(self.model, static_cast<int>(n), substeps, dt, hold, each);
    for (std::size_t w = 0; w < W; ++w) flown(std::min(first + w, k - 1)) = flights[w].flown;
  }
}

}  // namespace

void bind_fly_many(nb::class_<Aircraft>& c) {
  c.def("fly_many", &fly_many, nb::arg("starts"), nb::arg("controls"), nb::arg("winds"),
        nb::arg("logarithmic"), nb::arg("dt"), nb::arg("substeps"), nb::arg("states"),
        nb::arg("outputs"), nb::arg("inputs"), nb::arg("flown"), nb::arg("hold") = false,
        nb::arg("gusts") = nb::none(),
        "Fly k flights side by side, each as `fly` would: starts (k, state_count), controls and\n"
        "gusts (k or 1, n, 6), winds (k, 9): steady, shear, reference height, roughness, ground;\n"
        "write states (k, n, state_count), outputs (k, n, 24), inputs (k, n, 12), and the numbers\n"
        "of samples before a state stopped being finite into flown (k).");
}
