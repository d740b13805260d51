// The linear Kalman filter and its smoother over a record.
#include <alula/filters/linear.hpp>
#include <memory>

#include "arrays.hpp"
#include "bind.hpp"

using namespace alula;

namespace {

using Result = nb::typed<nb::dict, nb::str, nb::any>;  // arrays and counts by name

template <int Columns>
void copy(Matrix from, double (*to)[Columns], int rows, int columns, const char* what) {
  if (static_cast<int>(from.shape(0)) != rows || static_cast<int>(from.shape(1)) != columns)
    throw nb::value_error(what);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) to[i][j] = from.data()[i * columns + j];
}

Result linear_filter(Matrix transition, Matrix input, Matrix process, Matrix output, Matrix noise,
                     Matrix u, Matrix z, Vector x0, Matrix P0, bool smooth) {
  auto system = std::make_unique<LinearSystem<double>>();
  const int n = static_cast<int>(transition.shape(0)), ny = static_cast<int>(output.shape(0)),
            nu = static_cast<int>(input.shape(1)), samples = static_cast<int>(z.shape(0));
  if (n < 1 || n > kMaxStates || ny < 1 || ny > kMaxOutputs || nu > kMaxOutputs || samples < 1)
    throw nb::value_error("states, inputs or outputs beyond the capacity, or no sample");
  system->states = n;
  system->inputs = nu;
  system->outputs = ny;
  copy(transition, system->transition, n, n, "transition: expected (states, states)");
  copy(input, system->input, n, nu, "input: expected (states, inputs)");
  copy(process, system->process, n, n, "process: expected (states, states)");
  copy(output, system->output, ny, n, "output: expected (outputs, states)");
  copy(noise, system->noise, ny, ny, "noise: expected (outputs, outputs)");
  if (static_cast<int>(x0.shape(0)) != n || static_cast<int>(z.shape(1)) != ny ||
      u.shape(0) != z.shape(0) || static_cast<int>(u.shape(1)) != nu)
    throw nb::value_error("x0, u, z: expected (states,), (samples, inputs), (samples, outputs)");
  auto filter = std::make_unique<Linear<double>>();
  copy(P0, filter->P, n, n, "P0: expected (states, states)");
  for (int i = 0; i < n; ++i) filter->x[i] = x0.data()[i];
  Array<double> x({samples, n}), P({samples, n, n}), e({samples, ny}), d({samples, ny}),
      nis({samples});
  int done = 0, reached = 0;
  {
    nb::gil_scoped_release release;
    done = run_linear(*filter, *system, samples, u.data(), z.data(), x.data(), P.data(), e.data(),
                      d.data(), nis.data());
    if (smooth && done == samples)
      reached = smooth_linear(*filter, *system, samples, u.data(), x.data(), P.data());
  }
  Result out;
  out["x"] = x.numpy();
  out["covariance"] = P.numpy();
  out["innovation"] = e.numpy();
  out["deviation"] = d.numpy();
  out["nis"] = nis.numpy();
  out["done"] = done;
  out["reached"] = reached;
  return out;
}

}  // namespace

void bind_linear_filter(nb::module_& m) {
  m.def("linear_filter", &linear_filter, nb::arg("transition"), nb::arg("input"),
        nb::arg("process"), nb::arg("output"), nb::arg("noise"), nb::arg("u"), nb::arg("z"),
        nb::arg("x0"), nb::arg("P0"), nb::arg("smooth") = false,
        "Linear Kalman filter over z (samples, outputs), NaN for none, from x0 and P0 before the\n"
        "first reading; process is Lambda Q Lambda'. `done` < samples where it lost its "
        "covariance.");
}
