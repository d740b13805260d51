// Flying the equations of motion, and what sensors make of the motion.
#include <cmath>
#include <cstring>

#include "alula/math/rk4.hpp"
#include "alula/motion/aircraft.hpp"
#include "alula/sensors/error_model.hpp"
#include "alula/sensors/lever_arm.hpp"
#include "bind.hpp"

namespace {

using alula::AircraftModel;
using alula::BodyInput;
using alula::BodyState;
using Model = AircraftModel<double>;
using alula::Vec3;

constexpr std::size_t kStates = alula::kBodyStates, kInputs = alula::kBodyInputs;
// ax ay az, pdot qdot rdot, V alpha beta mach rho, six coefficients
constexpr std::size_t kOutputs = 17;

Vec3<double> vec3(Vector a, const char* what) {
  if (a.shape(0) != 3) throw nb::value_error(what);
  return {a(0), a(1), a(2)};
}

void build(Model* self, double mass, Matrix inertia, Vector geometry, Vector reference_point,
           Vector thrust_point, Vector thrust_direction, Vector wind, double gravity,
           bool stability_axes, const alula::TermTable& table, Vector values) {
  if (inertia.shape(0) != 3 || inertia.shape(1) != 3)
    throw nb::value_error("inertia: expected shape (3, 3)");
  const Vec3<double> reference = vec3(geometry, "geometry: expected S, b, c");
  if (values.shape(0) != table.term_count) throw nb::value_error("values: one per term expected");
  alula::Mat3<double> J;
  for (std::size_t i = 0; i < 3; ++i) J.row[i] = {inertia(i, 0), inertia(i, 1), inertia(i, 2)};
  new (self) Model();
  self->body = alula::mass_properties(mass, J);
  self->S = reference.x;
  self->b = reference.y;
  self->c = reference.z;
  self->reference_point = vec3(reference_point, "reference_point: expected three numbers");
  self->thrust_point = vec3(thrust_point, "thrust_point: expected three numbers");
  self->thrust_direction = vec3(thrust_direction, "thrust_direction: expected three numbers");
  self->wind = vec3(wind, "wind: expected three numbers");
  self->gravity = gravity;
  self->stability_axes = stability_axes;
  self->table = table;
  std::memcpy(self->values.data(), values.data(), values.shape(0) * sizeof(double));
}

BodyInput<double> input_at(const Matrix& inputs, std::size_t row) {
  BodyInput<double> u;
  for (std::size_t j = 0; j < kInputs; ++j) u[j] = inputs(row, j);
  return u;
}

void write_outputs(const Model& a, const BodyState<double>& x, const BodyInput<double>& u,
                   double* out) {
  const auto R = alula::earth_to_body(alula::Quaternion<double>{x[3], x[4], x[5], x[6]});
  const auto load = alula::loads(x, u, a, R);
  const Vec3<double> w{x[10], x[11], x[12]};
  const auto dw = alula::angular_acceleration(a.body, load.moment, w);
  const double k = 1.0 / a.body.mass;
  const double row[11] = {k * load.force.x,
                          k * load.force.y,
                          k * load.force.z,
                          dw.x,
                          dw.y,
                          dw.z,
                          load.flow.V,
                          load.flow.alpha,
                          load.flow.beta,
                          load.mach,
                          load.air.density};
  std::memcpy(out, row, sizeof row);
  std::memcpy(out + 11, load.coefficients.data(), 6 * sizeof(double));
}

// Samples flown before the state stopped being finite; all of them where it never did. Inputs are
// straight lines between their samples.
std::size_t fly(const Model& a, Vector x0, Matrix inputs, double dt, int substeps, MatrixOut states,
                MatrixOut outputs) {
  const std::size_t n = inputs.shape(0);
  if (x0.shape(0) != kStates || inputs.shape(1) != kInputs || states.shape(1) != kStates ||
      outputs.shape(1) != kOutputs || states.shape(0) != n || outputs.shape(0) != n)
    throw nb::value_error("expected x0 (13), inputs (n, 6), states (n, 13), outputs (n, 17)");
  if (substeps < 1 || !(dt > 0.0)) throw nb::value_error("dt and substeps must be positive");
  nb::gil_scoped_release unlocked;
  BodyState<double> x;
  std::memcpy(x.data(), x0.data(), sizeof x);
  const double h = dt / substeps;
  for (std::size_t i = 0; i < n; ++i) {
    const BodyInput<double> now = input_at(inputs, i);
    double* state = &states(i, 0);
    std::memcpy(state, x.data(), sizeof x);
    write_outputs(a, x, now, &outputs(i, 0));
    double total = 0.0;
    for (std::size_t j = 0; j < kStates; ++j) total += x[j];
    if (!std::isfinite(total)) return i;
    if (i + 1 == n) break;
    const BodyInput<double> next = input_at(inputs, i + 1);
    for (int s = 0; s < substeps; ++s) {
      alula::rk4_step(
          [&](double t, const BodyState<double>& at, BodyState<double>& rate) {
            const double part = t / dt;
            BodyInput<double> u;
            for (std::size_t j = 0; j < kInputs; ++j) u[j] = now[j] + part * (next[j] - now[j]);
            rate = alula::derivative(t, at, u, a);
          },
          h * s, h, x);
    }
  }
  return n;
}

void rates(const Model& a, Vector x, Vector u, VectorOut dx, VectorOut y) {
  if (x.shape(0) != kStates || u.shape(0) != kInputs || dx.shape(0) != kStates ||
      y.shape(0) != kOutputs)
    throw nb::value_error("expected x (13), u (6), dx (13), y (17)");
  BodyState<double> state;
  BodyInput<double> input;
  std::memcpy(state.data(), x.data(), sizeof state);
  std::memcpy(input.data(), u.data(), sizeof input);
  const auto rate = alula::derivative(0.0, state, input, a);
  std::memcpy(dx.data(), rate.data(), sizeof rate);
  write_outputs(a, state, input, y.data());
}

Vec3<double> row3(const Matrix& m, std::size_t i) { return {m(i, 0), m(i, 1), m(i, 2)}; }

void check_three(const Matrix& m, std::size_t n) {
  if (m.shape(0) != n || m.shape(1) != 3) throw nb::value_error("expected arrays of shape (n, 3)");
}

void put(MatrixOut& out, std::size_t i, const Vec3<double>& v) {
  out(i, 0) = v.x;
  out(i, 1) = v.y;
  out(i, 2) = v.z;
}

}  // namespace

void bind_simulate(nb::module_& m) {
  nb::class_<Model>(m, "AircraftModel",
                    "A rigid aircraft with its aerodynamic model; positions from the center of\n"
                    "gravity, body axes; geometry: S, b, c.")
      .def("__init__", &build, nb::arg("mass"), nb::arg("inertia"), nb::arg("geometry"),
           nb::arg("reference_point"), nb::arg("thrust_point"), nb::arg("thrust_direction"),
           nb::arg("wind"), nb::arg("gravity"), nb::arg("stability_axes"), nb::arg("table"),
           nb::arg("values"))
      .def("fly", &fly, nb::arg("x0"), nb::arg("inputs"), nb::arg("dt"), nb::arg("substeps"),
           nb::arg("states"), nb::arg("outputs"),
           "Fly from x0 (13) under inputs (n, 6) with RK4; write states (n, 13) and outputs\n"
           "(n, 17); return the number of samples before the state stopped being finite.")
      .def("rates", &rates, nb::arg("x"), nb::arg("u"), nb::arg("dx"), nb::arg("y"),
           "State rates dx (13) and outputs y (17) at one state and input.");

  m.def(
      "quaternion_from_euler",
      [](double phi, double theta, double psi, VectorOut out) {
        if (out.shape(0) != 4) throw nb::value_error("out: expected four numbers");
        const auto q = alula::quaternion_from_euler(phi, theta, psi);
        out(0) = q.w;
        out(1) = q.x;
        out(2) = q.y;
        out(3) = q.z;
      },
      nb::arg("phi"), nb::arg("theta"), nb::arg("psi"), nb::arg("out"),
      "Quaternion (4,), scalar first, of Euler angles 3-2-1, rad.");
  m.def(
      "attitudes",
      [](Matrix states, MatrixOut euler, CubeOut rotation) {
        const std::size_t n = states.shape(0);
        if (states.shape(1) != kStates || euler.shape(0) != n || euler.shape(1) != 3 ||
            rotation.shape(0) != n || rotation.shape(1) != 3 || rotation.shape(2) != 3)
          throw nb::value_error("expected states (n, 13), euler (n, 3), rotation (n, 3, 3)");
        for (std::size_t i = 0; i < n; ++i) {
          const alula::Quaternion<double> q{states(i, 3), states(i, 4), states(i, 5), states(i, 6)};
          put(euler, i, alula::euler_from_quaternion(q));
          const auto R = alula::earth_to_body(q);
          for (std::size_t j = 0; j < 3; ++j) {
            rotation(i, j, 0) = R.row[j].x;
            rotation(i, j, 1) = R.row[j].y;
            rotation(i, j, 2) = R.row[j].z;
          }
        }
      },
      nb::arg("states"), nb::arg("euler"), nb::arg("rotation"),
      "Euler angles phi theta psi (n, 3), rad, and R_BE (n, 3, 3) of states (n, 13).");
  m.def(
      "specific_force_at",
      [](Matrix f, Matrix w, Matrix w_dot, Vector r, MatrixOut out) {
        const Vec3<double> at = vec3(r, "r: expected three numbers");
        const std::size_t n = out.shape(0);
        check_three(f, n);
        check_three(w, n);
        check_three(w_dot, n);
        for (std::size_t i = 0; i < n; ++i)
          put(out, i, alula::specific_force_at(row3(f, i), row3(w, i), row3(w_dot, i), at));
      },
      nb::arg("f"), nb::arg("w"), nb::arg("w_dot"), nb::arg("r"), nb::arg("out"),
      "Specific force (n, 3) at r from the center of gravity.");
  m.def(
      "velocity_at",
      [](Matrix v, Matrix w, Vector r, MatrixOut out) {
        const Vec3<double> at = vec3(r, "r: expected three numbers");
        const std::size_t n = out.shape(0);
        check_three(v, n);
        check_three(w, n);
        for (std::size_t i = 0; i < n; ++i)
          put(out, i, alula::velocity_at(row3(v, i), row3(w, i), at));
      },
      nb::arg("v"), nb::arg("w"), nb::arg("r"), nb::arg("out"),
      "Velocity (n, 3) at r from the center of gravity.");
  m.def(
      "readings",
      [](Vector truth, Vector normal, double scale, double bias, double sigma, double step,
         VectorOut out) {
        if (truth.shape(0) != out.shape(0) || normal.shape(0) != out.shape(0))
          throw nb::value_error("expected arrays of one length");
        const alula::SensorError<double> error{scale, bias, sigma, step};
        for (std::size_t i = 0; i < out.shape(0); ++i)
          out(i) = alula::reading(error, truth(i), normal(i));
      },
      nb::arg("truth"), nb::arg("normal"), nb::arg("scale"), nb::arg("bias"), nb::arg("sigma"),
      nb::arg("step"), nb::arg("out"), "What a sensor with these errors reads.");
}
