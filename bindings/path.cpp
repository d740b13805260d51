// Flight path reconstruction: the model as a table, the filters and the open-loop integration.
#include "bind.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <alula/filters/iterated.hpp>
#include <alula/filters/path_run.hpp>
#include <alula/filters/square_root_unscented.hpp>
#include <memory>
#include <stdexcept>

#include "arrays.hpp"

using namespace alula;
using Model = PathModel<double>;

namespace {

using Result = nb::typed<nb::dict, nb::str, nb::any>;  // arrays and counts by name

int row_of(const char* what, std::size_t found, int expected) {
  if (static_cast<int>(found) != expected)
    throw std::invalid_argument(std::string(what) + ": expected " + std::to_string(expected) +
                                " columns, got " + std::to_string(found));
  return expected;
}

void add_sensor(Model& model, int quantity, const std::vector<double>& position, double sigma,
                double reference, double scale, double bias, int scale_slot, int bias_slot) {
  PathSensor<double> s;
  s.quantity = static_cast<Quantity>(quantity);
  for (int i = 0; i < 3; ++i) s.position[i] = position.at(static_cast<std::size_t>(i));
  s.variance = sigma * sigma;
  s.reference = reference;
  s.scale = scale;
  s.bias = bias;
  s.scale_slot = scale_slot;
  s.bias_slot = bias_slot;
  if (!model.sensors.push(s))
    throw std::invalid_argument("at most " + std::to_string(kMaxOutputs) + " sensors");
}

// What a run of a filter takes and gives besides its histories.
struct Run {
  const double *x0, *sigma0;  // (states) the constants' prior
  bool smooth;
  double* filtered;          // (samples, states) before smoothing, where smoothed
  double* final_covariance;  // (states, states)
  int done = 0, reached = 0, repairs = 0, unsettled = 0;
};
using Runner = void (*)(const Model&, const PathRecord<double>&, const PathHistory<double>&, Run&);

template <class Filter>
void run_rows(const Model& model, const PathRecord<double>& record,
              const PathHistory<double>& history, Run& run) {
  const int n = model.states;
  auto filter = std::make_unique<Filter>();
  for (int i = 0; i < n; ++i) {
    filter->x[i] = run.x0[i];
    filter->P[i][i] = run.sigma0[i] * run.sigma0[i];
  }
  run.done = run_filter(*filter, model, record, history);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      run.final_covariance[i * n + j] = filter->P[i < j ? i : j][i < j ? j : i];
  run.repairs = filter->repairs;
  if constexpr (requires { filter->unsettled; }) run.unsettled = filter->unsettled;
  if (!run.smooth || run.done < record.samples) return;
  std::copy(history.x, history.x + record.samples * n, run.filtered);
  run.reached = run_smoother(*filter, model, record, history);
}

Result run_all(Runner runner, const Model& model, Vector t, Matrix inputs, Matrix readings,
               nb::ndarray<const int, nb::ndim<1>, nb::c_contig> start, Matrix initial, Vector x0,
               Vector sigma0, bool smooth, bool keep_covariance) {
  const int samples = static_cast<int>(t.shape(0)), n = model.states, ny = model.sensors.size();
  row_of("inputs", inputs.shape(1), kInertialInputs);
  row_of("readings", readings.shape(1), ny);
  row_of("initial", initial.shape(1), 2 * model.motion);
  row_of("x0", x0.shape(0), n);
  if (samples == 0 || start.shape(0) != t.shape(0) || inputs.shape(0) != t.shape(0) ||
      readings.shape(0) != t.shape(0) || start.data()[0] != 0)
    throw std::invalid_argument(
        "t, inputs, readings, start: expected one row a sample, start[0] 0");
  const bool all = smooth || keep_covariance;
  Array<double> x({samples, n}), covariance({all ? samples : 0, n * (n + 1) / 2}),
      innovation({samples, ny}), deviation({samples, ny}), nis({samples}),
      filtered({smooth ? samples : 0, n}), final_covariance({n, n});
  const PathRecord<double> record{samples,         t.data(),     inputs.data(),
                                  readings.data(), start.data(), initial.data()};
  const PathHistory<double> history{x.data(), all ? covariance.data() : nullptr, innovation.data(),
                                    deviation.data(), nis.data()};
  Run run{x0.data(), sigma0.data(), smooth, filtered.data(), final_covariance.data()};
  {
    nb::gil_scoped_release release;
    runner(model, record, history, run);
  }
  Result out;
  if (smooth && run.done == samples) out["x_filtered"] = filtered.numpy();
  out["x"] = x.numpy();
  out["covariance"] = covariance.numpy();
  out["innovation"] = innovation.numpy();
  out["deviation"] = deviation.numpy();
  out["nis"] = nis.numpy();
  out["final_covariance"] = final_covariance.numpy();
  out["done"] = run.done;
  out["reached"] = run.reached;
  out["repairs"] = run.repairs;
  out["unsettled"] = run.unsettled;
  return out;
}

// A filter of the core as a function of Python's. `chosen`: which rows hold the model.
template <Runner (*chosen)(const Model&)>
Result run(const Model& model, Vector t, Matrix inputs, Matrix readings,
           nb::ndarray<const int, nb::ndim<1>, nb::c_contig> start, Matrix initial, Vector x0,
           Vector sigma0, bool smooth, bool keep_covariance) {
  return run_all(chosen(model), model, t, inputs, readings, start, initial, x0, sigma0, smooth,
                 keep_covariance);
}

// The shorter rows where they hold the states: for the filters that run by default.
template <template <class, int> class Filter>
Runner fitting(const Model& model) {
  return short_rows(model) ? &run_rows<Filter<double, kShortRow>>
                           : &run_rows<Filter<double, kLongRow>>;
}

// The longer ones always: a tenth slower, and half the code.
template <template <class, int> class Filter>
Runner one_size(const Model&) {
  return &run_rows<Filter<double, kLongRow>>;
}

nb::ndarray<nb::numpy, double> readings_of(const Model& model, Matrix inputs, Matrix x) {
  const int samples = static_cast<int>(x.shape(0)), ny = model.sensors.size();
  row_of("inputs", inputs.shape(1), kInertialInputs);
  row_of("x", x.shape(1), model.states);
  if (inputs.shape(0) != x.shape(0))
    throw std::invalid_argument("inputs: expected one row a state");
  Array<double> out({samples, ny});
  for (int k = 0; k < samples; ++k) {
    const double* state = x.data() + k * model.states;
    double m[kInertialInputs], wind[3];
    true_inputs(model, state, inputs.data() + k * kInertialInputs, m);
    for (int i = 0; i < 3; ++i) wind[i] = unknown(model, state, kWindNorth + i);
    const PathAir<double> air = path_air(model, state, wind, m);
    for (int s = 0; s < ny; ++s) out.data()[k * ny + s] = path_output(model.sensors[s], state, air);
  }
  return out.numpy();
}

Result open_loop(const Model& model, Vector t, Matrix inputs, Vector x0, std::optional<Matrix> held,
                 bool jacobian) {
  const int samples = static_cast<int>(t.shape(0)), n = model.states, ny = model.sensors.size();
  row_of("inputs", inputs.shape(1), kInertialInputs);
  row_of("x0", x0.shape(0), n);
  if (inputs.shape(0) != t.shape(0))
    throw std::invalid_argument("inputs: expected one row a sample");
  if (held && (held->shape(0) != t.shape(0) || row_of("held", held->shape(1), model.motion) == 0))
    throw std::invalid_argument("held: expected one row a sample");
  const int rows = jacobian ? samples : 0;
  Array<double> motion({samples, model.motion}), readings({samples, ny}),
      motion_jacobian({rows, model.motion, n}), readings_jacobian({rows, ny, n});
  {
    nb::gil_scoped_release release;
    run_open_loop(model, t.data(), inputs.data(), samples, x0.data(), held ? held->data() : nullptr,
                  motion.data(), readings.data(), jacobian ? motion_jacobian.data() : nullptr,
                  jacobian ? readings_jacobian.data() : nullptr);
  }
  Result out;
  out["motion"] = motion.numpy();
  out["readings"] = readings.numpy();
  out["motion_jacobian"] = motion_jacobian.numpy();
  out["readings_jacobian"] = readings_jacobian.numpy();
  return out;
}

}  // namespace

void bind_path(nb::module_& m) {
  m.attr("MAX_STATES") = kMaxStates;
  m.attr("MAX_OUTPUTS") = kMaxOutputs;
  nb::class_<Model>(m, "PathModel", "Which unknowns and sensors a reconstruction has.")
      .def(nb::init<>())
      .def_rw("states", &Model::states)
      .def_rw("motion", &Model::motion)
      .def_rw("dynamic", &Model::dynamic)
      .def_rw("gravity", &Model::gravity)
      .def_rw("wind", &Model::wind)
      .def(
          "set_unknown",
          [](Model& s, int k, int slot, double fixed) {
            if (k < 0 || k >= kPathUnknowns || slot >= kMaxStates)
              throw std::invalid_argument("unknown or slot out of range");
            s.slot[k] = slot;
            s.fixed[k] = fixed;
          },
          nb::arg("unknown"), nb::arg("slot"), nb::arg("fixed") = 0.0)
      .def(
          "set_walk",
          [](Model& s, int state, double walk) {
            if (state < 0 || state >= kMaxStates) throw std::invalid_argument("state out of range");
            s.walk[state] = walk;
          },
          nb::arg("state"), nb::arg("walk"))
      .def(
          "set_input_sigma",
          [](Model& s, const std::vector<double>& sigma) {
            for (int i = 0; i < kInertialInputs; ++i)
              s.input_sigma[i] = sigma.at(static_cast<std::size_t>(i));
          },
          nb::arg("sigma"))
      .def("add_sensor", &add_sensor, nb::arg("quantity"), nb::arg("position"), nb::arg("sigma"),
           nb::arg("reference") = 0.0, nb::arg("scale") = 0.0, nb::arg("bias") = 0.0,
           nb::arg("scale_slot") = -1, nb::arg("bias_slot") = -1);

  const char* doc =
      "Filter a record: t (n,), inputs (n, 6), readings (n, sensors) with NaN for none, start "
      "(n,)\n"
      "the row of `initial` where a maneuver begins and -1 elsewhere, initial (maneuvers, 2 "
      "motion)\n"
      "values and standard deviations, x0 and sigma0 (states,) the constants' prior. Returns\n"
      "histories; `done` < n where the filter lost its covariance, `unsettled` updates whose\n"
      "iteration did not converge.";
  const auto filter = [&m, doc](const char* name, auto function) {
    m.def(name, function, nb::arg("model"), nb::arg("t"), nb::arg("inputs"), nb::arg("readings"),
          nb::arg("start"), nb::arg("initial"), nb::arg("x0"), nb::arg("sigma0"),
          nb::arg("smooth") = false, nb::arg("keep_covariance") = false, doc);
  };
  filter("path_ekf", &run<fitting<Extended>>);
  filter("path_iekf", &run<one_size<Iterated>>);
  filter("path_ukf", &run<fitting<Unscented>>);
  filter("path_srukf", &run<one_size<SquareRootUnscented>>);
  m.def(
      "path_readings", &readings_of, nb::arg("model"), nb::arg("inputs"), nb::arg("x"),
      "What the sensors read (n, sensors) under measured inputs (n, 6) and states x (n, states).");
  m.def("path_open_loop", &open_loop, nb::arg("model"), nb::arg("t"), nb::arg("inputs"),
        nb::arg("x0"), nb::arg("held") = nb::none(), nb::arg("jacobian") = true,
        "Integrate the kinematics from x0 without using a measurement, with exact Jacobians.");
}
