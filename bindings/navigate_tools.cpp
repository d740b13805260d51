// Attitude from two vectors, wind, power train.
#include <alula/navigate/pair.hpp>
#include <alula/navigate/power_train.hpp>
#include <alula/navigate/wind.hpp>

#include "bind.hpp"

using namespace alula;

namespace {

using Vec = Vec3<double>;

Vec at(const double* p) { return {p[0], p[1], p[2]}; }

}  // namespace

void bind_navigate_tools(nb::module_& m) {
  m.def(
      "measured_attitude",
      [](Matrix gravity_B, Matrix field_B, Vector field_E, double gravity, MatrixOut out) {
        const auto n = gravity_B.shape(0);
        check(gravity_B.shape(1) == 3 && field_B.shape(0) == n && field_B.shape(1) == 3,
              "gravity_B, field_B: expected (n, 3)");
        check(out.shape(0) == n && out.shape(1) == 6, "out: expected (n, 6)");
        const Vec earth = vec3(field_E, "field_E: expected (3,)");
        for (std::size_t i = 0; i < n; ++i) {
          const auto z = measured_attitude(at(gravity_B.data() + 3 * i), at(field_B.data() + 3 * i),
                                           earth, gravity);
          double* row = out.data() + 6 * i;
          row[0] = z.euler.x;
          row[1] = z.euler.y;
          row[2] = z.euler.z;
          row[3] = z.gain;
          row[4] = z.heading ? 1.0 : 0.0;
          row[5] = z.valid ? 1.0 : 0.0;
        }
      },
      nb::arg("gravity_B"), nb::arg("field_B"), nb::arg("field_E"), nb::arg("gravity"),
      nb::arg("out"),
      "Attitude from gravity and magnetic field as seen in body axes (n, 3). Writes out (n, 6):\n"
      "phi theta psi (rad), acceleration gain, whether the heading and the whole is valid.");
  m.def(
      "wind_from",
      [](Matrix velocity, Vector sigma_velocity, Matrix q, Vector sigma_turn, Matrix air,
         Vector sigma_air, MatrixOut wind, CubeOut covariance) {
        const auto n = velocity.shape(0);
        check(velocity.shape(1) == 3 && q.shape(0) == n && q.shape(1) == 4 && air.shape(0) == n &&
                  air.shape(1) == 3,
              "velocity (n, 3), q (n, 4), air (n, 3): expected one row a sample");
        check(wind.shape(0) == n && wind.shape(1) == 3 && covariance.shape(0) == n &&
                  covariance.shape(1) == 3 && covariance.shape(2) == 3,
              "wind, covariance: expected (n, 3), (n, 3, 3)");
        const Vec sv = vec3(sigma_velocity, "sigma_velocity: expected (3,)");
        const Vec st = vec3(sigma_turn, "sigma_turn: expected (3,)");
        const Vec sa = vec3(sigma_air, "sigma_air: expected (3,)");
        const double nan = std::nan("");
        for (std::size_t i = 0; i < n; ++i) {
          const double* k = q.data() + 4 * i;
          const double* a = air.data() + 3 * i;
          const auto found =
              wind_from<double>(at(velocity.data() + 3 * i), sv, {k[0], k[1], k[2], k[3]}, st,
                                {a[0], a[1], a[2], sa.x, sa.y, sa.z});
          const Vec w = found.valid ? found.wind : Vec{nan, nan, nan};
          double* out = wind.data() + 3 * i;
          out[0] = w.x;
          out[1] = w.y;
          out[2] = w.z;
          for (int r = 0; r < 3; ++r) {
            const Vec row = found.valid ? found.covariance.row[r] : Vec{nan, nan, nan};
            double* c = covariance.data() + 9 * i + 3 * static_cast<std::size_t>(r);
            c[0] = row.x;
            c[1] = row.y;
            c[2] = row.z;
          }
        }
      },
      nb::arg("velocity"), nb::arg("sigma_velocity"), nb::arg("q"), nb::arg("sigma_turn"),
      nb::arg("air"), nb::arg("sigma_air"), nb::arg("wind"), nb::arg("covariance"),
      "Wind (n, 3) NED, m/s, the way it blows to, with covariance (n, 3, 3), from velocity (n, 3)\n"
      "NED, attitude q (n, 4), air (n, 3): V, alpha, beta; NaN where there is no airspeed.");
  m.def(
      "air_from_wind",
      [](Matrix velocity, Vector sigma_velocity, Matrix q, Vector sigma_turn, Matrix wind,
         Matrix wind_covariance, MatrixOut out) {
        const auto n = velocity.shape(0);
        check(velocity.shape(1) == 3 && q.shape(0) == n && q.shape(1) == 4 && wind.shape(0) == n &&
                  wind.shape(1) == 3 && wind_covariance.shape(0) == 3 &&
                  wind_covariance.shape(1) == 3,
              "velocity (n, 3), q (n, 4), wind (n, 3), wind_covariance (3, 3)");
        check(out.shape(0) == n && out.shape(1) == 6, "out: expected (n, 6)");
        const Vec sv = vec3(sigma_velocity, "sigma_velocity: expected (3,)");
        const Vec st = vec3(sigma_turn, "sigma_turn: expected (3,)");
        const double* c = wind_covariance.data();
        const Mat3<double> cov{{at(c), at(c + 3), at(c + 6)}};
        for (std::size_t i = 0; i < n; ++i) {
          const double* k = q.data() + 4 * i;
          const auto found =
              air_from_wind<double>(at(velocity.data() + 3 * i), sv, {k[0], k[1], k[2], k[3]}, st,
                                    at(wind.data() + 3 * i), cov);
          double* o = out.data() + 6 * i;
          const double row[6] = {found.flow.V,  found.flow.alpha,  found.flow.beta,
                                 found.sigma_V, found.sigma_alpha, found.sigma_beta};
          for (int j = 0; j < 6; ++j) o[j] = found.valid ? row[j] : std::nan("");
        }
      },
      nb::arg("velocity"), nb::arg("sigma_velocity"), nb::arg("q"), nb::arg("sigma_turn"),
      nb::arg("wind"), nb::arg("wind_covariance"), nb::arg("out"),
      "Airspeed and flow angles without air-data sensors where the wind is known. Writes out\n"
      "(n, 6): V, alpha, beta and their standard deviations; NaN where there is no airspeed.");
  m.def(
      "power_train",
      [](Vector motor, Vector noise, Vector t, Vector throttle, Vector speed, MatrixOut out) {
        check(motor.shape(0) == 9 && noise.shape(0) == 3, "motor (9,), noise (3,)");
        const auto n = t.shape(0);
        check(throttle.shape(0) == n && speed.shape(0) == n, "one value a sample");
        check(out.shape(0) == n && out.shape(1) == 9, "out: expected (n, 9)");
        const double* e = motor.data();
        const Electric<double> electric{e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7], e[8]};
        PowerTrainNoise<double> quiet;
        quiet.jerk = noise(0);
        quiet.decay = noise(1);
        quiet.sensor = noise(2);
        PowerTrain<double> f;
        for (std::size_t i = 0; i < n; ++i) {
          const bool none = std::isnan(speed(i));
          const Taken taken =
              step(f, electric, quiet, t(i), throttle(i), none ? 0.0 : speed(i), none);
          const double row[9] = {f.omega,         f.acceleration, std::sqrt(f.P[0][0]),
                                 f.motor_current, f.current,      f.charge,
                                 f.voltage,       f.left,         static_cast<double>(taken)};
          for (std::size_t j = 0; j < 9; ++j) out(i, j) = row[j];
        }
      },
      nb::arg("motor"), nb::arg("noise"), nb::arg("t"), nb::arg("throttle"), nb::arg("speed"),
      nb::arg("out"),
      "Motor speed, current and battery over t (n,) from throttle and speed readings (NaN: none).\n"
      "motor: k_V k_T no_load_current resistance full_voltage empty_voltage capacity most_current\n"
      "most_regenerated_current; noise: jerk, decay, sensor. Writes out (n, 9): speed,\n"
      "acceleration, standard deviation of the speed, motor current, battery current, charge\n"
      "drawn, voltage, share left, what became of the sample.");
}
