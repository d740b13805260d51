// Attitudes, and what sensors make of a motion.
#include <nanobind/stl/tuple.h>

#include <tuple>

#include "alula/math/quaternion.hpp"
#include "alula/motion/place.hpp"
#include "alula/motion/tumbling.hpp"
#include "alula/motion/wind.hpp"
#include "alula/sensors/error_model.hpp"
#include "alula/sensors/lever_arm.hpp"
#include "bind.hpp"

namespace {

using alula::Mat3;
using alula::Quaternion;
using alula::Vec3;

Vec3<double> row3(const Matrix& m, std::size_t i) { return {m(i, 0), m(i, 1), m(i, 2)}; }

void check_three(const Matrix& m, std::size_t n) {
  if (m.shape(0) != n || m.shape(1) != 3) throw nb::value_error("expected arrays of shape (n, 3)");
}

void put(MatrixOut& out, std::size_t i, const Vec3<double>& v) {
  out(i, 0) = v.x;
  out(i, 1) = v.y;
  out(i, 2) = v.z;
}

void put(VectorOut& out, const Quaternion<double>& q) {
  if (out.shape(0) != 4) throw nb::value_error("out: expected four numbers");
  out(0) = q.w;
  out(1) = q.x;
  out(2) = q.y;
  out(3) = q.z;
}

// Euler angles and rotation from north, east, down; for WGS-84 also latitude, longitude, height.
void attitudes(Matrix states, MatrixOut euler, CubeOut rotation, MatrixOut where, bool wgs84) {
  const std::size_t n = states.shape(0);
  if (states.shape(1) < alula::kBodyStates || euler.shape(0) != n || euler.shape(1) != 3 ||
      rotation.shape(0) != n || rotation.shape(1) != 3 || rotation.shape(2) != 3 ||
      where.shape(0) != n || where.shape(1) != 3)
    throw nb::value_error(
        "expected states (n, 13 or more), euler (n, 3), rotation (n, 3, 3), where (n, 3)");
  alula::FlightState<double> x;
  x.length = alula::kBodyStates;
  for (std::size_t i = 0; i < n; ++i) {
    for (int j = 0; j < alula::kBodyStates; ++j) x[j] = states(i, static_cast<std::size_t>(j));
    const auto at = alula::place(x, wgs84 ? alula::Earth::wgs84 : alula::Earth::flat, 0.0);
    put(euler, i, alula::euler_from_rotation(at.R_BN));
    for (std::size_t j = 0; j < 3; ++j) {
      rotation(i, j, 0) = at.R_BN.row[j].x;
      rotation(i, j, 1) = at.R_BN.row[j].y;
      rotation(i, j, 2) = at.R_BN.row[j].z;
    }
    if (wgs84) {
      const auto g = alula::geodetic(Vec3<double>{x[0], x[1], x[2]});
      put(where, i,
          {std::atan2(g.sin_latitude, g.cos_latitude), std::atan2(g.sin_longitude, g.cos_longitude),
           g.height});
    } else {
      put(where, i, {x[0], x[1], at.height});
    }
  }
}

}  // namespace

void bind_simulate(nb::module_& m) {
  m.def(
      "quaternion_from_euler",
      [](double phi, double theta, double psi, VectorOut out) {
        put(out, alula::quaternion_from_euler(phi, theta, psi));
      },
      nb::arg("phi"), nb::arg("theta"), nb::arg("psi"), nb::arg("out"),
      "Quaternion (4,), scalar first, of Euler angles 3-2-1, rad.");
  m.def(
      "ecef_state",
      [](double latitude, double longitude, double height, double phi, double theta, double psi,
         VectorOut position, VectorOut quaternion) {
        if (position.shape(0) != 3) throw nb::value_error("position: expected three numbers");
        const auto r = alula::ecef(latitude, longitude, height);
        position(0) = r.x;
        position(1) = r.y;
        position(2) = r.z;
        put(quaternion, alula::north_east_down_attitude(latitude, longitude) *
                            alula::quaternion_from_euler(phi, theta, psi));
      },
      nb::arg("latitude"), nb::arg("longitude"), nb::arg("height"), nb::arg("phi"),
      nb::arg("theta"), nb::arg("psi"), nb::arg("position"), nb::arg("quaternion"),
      "Position (3,) m ECEF and quaternion (4,) from ECEF to body axes of a WGS-84 place\n"
      "(rad, rad, m) and Euler angles against north, east, down (rad).");
  m.def("attitudes", &attitudes, nb::arg("states"), nb::arg("euler"), nb::arg("rotation"),
        nb::arg("where"), nb::arg("wgs84"),
        "Of states (n, 13 or more): Euler angles phi theta psi (n, 3), rad; R_BE (n, 3, 3) from\n"
        "north, east, down; and where (n, 3): north, east, height (m), or on WGS-84 latitude,\n"
        "longitude (rad), height (m).");
  m.def(
      "tumbling_drift",
      [](Matrix inertia, Vector rates, double dt, long steps) {
        if (inertia.shape(0) != 3 || inertia.shape(1) != 3 || rates.shape(0) != 3)
          throw nb::value_error("expected inertia (3, 3), rates (3,)");
        const Mat3<double> J{{row3(inertia, 0), row3(inertia, 1), row3(inertia, 2)}};
        nb::gil_scoped_release unlocked;
        const auto d = alula::tumble(J, Vec3<double>{rates(0), rates(1), rates(2)}, dt, steps);
        return std::tuple{d.energy, d.magnitude, d.direction};
      },
      nb::arg("inertia"), nb::arg("rates"), nb::arg("dt"), nb::arg("steps"),
      "Largest relative drift, over a torque-free rotation, of energy, of the length of the\n"
      "angular momentum, and of its vector in inertial axes.");
  m.def(
      "cosine_gust",
      [](Vector t, Vector amplitude, double start, double length, double speed, bool returns,
         MatrixOut out) {
        const std::size_t n = t.shape(0);
        if (out.shape(0) != n || out.shape(1) < 3 || !(length > 0.0))
          throw nb::value_error("expected a length above zero, out (n, 3 or more)");
        const alula::CosineGust<double> gust{vec3(amplitude, "amplitude: expected three numbers"),
                                             start, length, speed, returns};
        for (std::size_t i = 0; i < n; ++i) put(out, i, alula::gust_at(gust, t(i)));
      },
      nb::arg("t"), nb::arg("amplitude"), nb::arg("start"), nb::arg("length"), nb::arg("speed"),
      nb::arg("returns"), nb::arg("out"),
      "A gust of one minus cosine at times t (n,), into the first three columns of out.");
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
