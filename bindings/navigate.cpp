// Navigation filters over recordings: inertial samples, and measurements as they arrived.
#include <nanobind/stl/tuple.h>

#include <alula/navigate/joint_updates.hpp>
#include <alula/navigate/pair.hpp>
#include <cmath>
#include <memory>
#include <tuple>

#include "arrays.hpp"
#include "bind.hpp"

using namespace alula;

namespace {

using Result = nb::typed<nb::dict, nb::str, nb::any>;  // arrays and counts by name
using Vec = Vec3<double>;

// Kinds of measurements, as rows `kind, t of arrival, t measured, z (3), sigma (3)` carry them.
enum Kind : int { kPos, kVel, kMag, kBaro, kSpeed, kAlpha, kBeta, kKinds };
constexpr int kColumns = 9;

Vec at(const double* p) { return {p[0], p[1], p[2]}; }
void put(double* p, const Vec& v) {
  p[0] = v.x;
  p[1] = v.y;
  p[2] = v.z;
}

template <class F>
auto vector_property(Vec F::* member) {
  using Three = std::tuple<double, double, double>;
  return std::pair{
      [member](const F& f) -> Three { return {(f.*member).x, (f.*member).y, (f.*member).z}; },
      [member](F& f, const Three& v) {
        f.*member = {std::get<0>(v), std::get<1>(v), std::get<2>(v)};
      }};
}

Judged<double> take(JointFilter<double>& f, const JointNoise<double>& noise, const double* row) {
  const Vec z = at(row + 3), sigma = at(row + 6);
  switch (static_cast<int>(row[0])) {
    case kPos: return update_position(f, noise, row[2], z, sigma);
    case kVel: return update_velocity(f, noise, row[2], z, sigma);
    case kMag: return update_field(f, noise, z, sigma.x);
    case kBaro: return update_height(f, noise, z.x, sigma.x);
    case kSpeed: return update_airspeed(f, noise, z.x, sigma.x);
    case kAlpha: return update_alpha(f, noise, z.x, sigma.x);
    case kBeta: return update_beta(f, noise, z.x, sigma.x);
  }
  return {Taken::kUnusable, 0.0, {}};
}

Judged<double> take(Pair<double>& f, const PairNoise<double>& noise, const double* row) {
  const Vec z = at(row + 3), sigma = at(row + 6);
  auto& p = f.position;
  switch (static_cast<int>(row[0])) {
    case kPos: return update_position(p, noise.position, row[2], z, sigma);
    case kVel: return update_velocity(p, noise.position, row[2], z, sigma);
    case kMag: return update_field(f, noise, z);
    case kBaro: return update_height(p, noise.position, row[2], z.x, sigma.x);
    case kSpeed: return {update_airspeed(f, z.x), 0.0, {}};
  }
  return {Taken::kUnusable, 0.0, {}};
}

constexpr int kJointOut = 26, kPairOut = 16;

// What both filters estimate: the first 16 columns.
void put_motion(double* x, const Quaternion<double>& q, const Vec& velocity, const Vec& position,
                const Vec& gyro_bias, const Vec& force_bias) {
  x[0] = q.w;
  x[1] = q.x;
  x[2] = q.y;
  x[3] = q.z;
  put(x + 4, velocity);
  put(x + 7, position);
  put(x + 10, gyro_bias);
  put(x + 13, force_bias);
}

void write(const JointFilter<double>& f, double* x, double* P) {
  put_motion(x, f.q, f.velocity, f.position, f.gyro_bias, f.force_bias);
  put(x + 16, f.wind);
  put(x + 19, f.gust);
  x[22] = f.height_bias;
  put(x + 23, f.rate);
  for (int i = 0; i < kJointStates; ++i)
    for (int j = 0; j < kJointStates; ++j) P[i * kJointStates + j] = f.P.P[i][j];
}

void write(const Pair<double>& f, double* x, double* P) {
  const auto& a = f.attitude;
  const auto& p = f.position;
  put_motion(x, a.q, p.velocity, p.position, a.bias, p.bias);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) P[i * 15 + j] = a.P.P[i][j];
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) P[(6 + i) * 15 + 6 + j] = p.P.P[i][j];
}

Tally tally_of(const JointFilter<double>& f) { return f.tally; }
Tally tally_of(const Pair<double>& f) {
  Tally sum = f.attitude.tally;
  for (int i = 0; i < kTakenKinds; ++i) sum.of[i] += f.position.tally.of[i];
  return sum;
}

// Inertial samples in order; before each, whatever arrived until then.
template <class F, class Noise>
Result run(F& f, const Noise& noise, Vector t, Matrix rate, Matrix force, Matrix events, int every,
           int columns, int states) {
  const std::size_t n = t.shape(0), m = events.shape(0);
  check(rate.shape(0) == n && rate.shape(1) == 3, "rate: expected (n, 3)");
  check(force.shape(0) == n && force.shape(1) == 3, "force: expected (n, 3)");
  check(m == 0 || events.shape(1) == kColumns, "events: expected (m, 9)");
  check(every >= 1, "every: expected 1 or more");
  const int rows =
      static_cast<int>((n + static_cast<std::size_t>(every) - 1) / static_cast<std::size_t>(every));
  Array<double> time({rows}), x({rows, columns}), P({rows, states, states});
  Array<double> nis({static_cast<int>(m)}), e({static_cast<int>(m), 3});
  Array<int> taken({static_cast<int>(m)}), taken_inertial({static_cast<int>(n)});
  {
    nb::gil_scoped_release release;
    std::size_t k = 0;
    int row = 0;
    for (std::size_t i = 0; i < n; ++i) {
      taken_inertial.data()[i] = static_cast<int>(
          predict(f, noise, t.data()[i], at(rate.data() + 3 * i), at(force.data() + 3 * i)));
      for (; k < m && !(events.data()[k * kColumns + 1] > t.data()[i]); ++k) {
        const Judged<double> judged = take(f, noise, events.data() + k * kColumns);
        taken.data()[k] = static_cast<int>(judged.taken);
        nis.data()[k] = judged.nis;
        for (std::size_t j = 0; j < 3; ++j) e.data()[3 * k + j] = judged.deviation[j];
      }
      if (i % static_cast<std::size_t>(every) == 0) {
        time.data()[row] = t.data()[i];
        write(f, x.data() + row * columns, P.data() + row * states * states);
        ++row;
      }
    }
    for (; k < m; ++k) taken.data()[k] = -1;
  }
  Result out;
  out["t"] = time.numpy();
  out["x"] = x.numpy();
  out["covariance"] = P.numpy();
  out["nis"] = nis.numpy();
  out["deviation"] = e.numpy();
  out["taken"] = taken.numpy();
  out["taken_inertial"] = taken_inertial.numpy();
  const Tally tally = tally_of(f);
  nb::list counts;
  for (unsigned c : tally.of) counts.append(c);
  out["tally"] = counts;
  return out;
}

}  // namespace

void bind_navigate(nb::module_& m) {
  m.attr("NAVIGATE_KINDS") = "position velocity field height V alpha beta";
  m.attr("NAVIGATE_TAKEN") = "taken not_finite backwards gated too_old unusable gap";
  using J = JointNoise<double>;
  using A = AttitudeNoise<double>;
  using Q = PositionNoise<double>;
  nb::class_<J> joint(m, "JointNoise", "Noise and constants of the joint filter, SI.");
  joint.def(nb::init<>());
#define ALULA_VECTOR(cls, owner, member)         \
  {                                              \
    auto p = vector_property(&owner::member);    \
    cls.def_prop_rw(#member, p.first, p.second); \
  }
  joint.def_rw("gyro", &J::gyro)
      .def_rw("gyro_walk", &J::gyro_walk)
      .def_rw("accelerometer", &J::accelerometer)
      .def_rw("accelerometer_walk", &J::accelerometer_walk)
      .def_rw("wind_walk", &J::wind_walk)
      .def_rw("height_walk", &J::height_walk)
      .def_rw("gravity", &J::gravity)
      .def_rw("least_airspeed", &J::least_airspeed)
      .def_rw("longest_step", &J::longest_step)
      .def_rw("patience", &J::patience);
  ALULA_VECTOR(joint, J, gust)
  ALULA_VECTOR(joint, J, gust_length)
  ALULA_VECTOR(joint, J, field)
  ALULA_VECTOR(joint, J, air_sensor)
  ALULA_VECTOR(joint, J, antenna)

  nb::class_<A> attitude(m, "AttitudeNoise", "Noise of the attitude filter, SI.");
  attitude.def(nb::init<>())
      .def_rw("gyro", &A::gyro)
      .def_rw("gyro_walk", &A::gyro_walk)
      .def_rw("longest_step", &A::longest_step)
      .def_rw("patience", &A::patience);
  ALULA_VECTOR(attitude, A, measured)
  nb::class_<Q> position(m, "PositionNoise", "Noise of the position filter, SI.");
  position.def(nb::init<>())
      .def_rw("accelerometer", &Q::accelerometer)
      .def_rw("accelerometer_walk", &Q::accelerometer_walk)
      .def_rw("gravity", &Q::gravity)
      .def_rw("longest_step", &Q::longest_step)
      .def_rw("patience", &Q::patience);
#undef ALULA_VECTOR

  m.def(
      "navigate_joint",
      [](const J& noise, Vector start_state, Vector start_sigma, double t0, Vector t, Matrix rate,
         Matrix force, Matrix events, int every) {
        check(start_state.shape(0) == 13, "start_state: expected q (4), velocity, position, wind");
        check(start_sigma.shape(0) == 8, "start_sigma: expected tilt, heading and six others");
        const double* s = start_state.data();
        const double* d = start_sigma.data();
        auto f = std::make_unique<JointFilter<double>>();
        start(*f, noise, t0, {s[0], s[1], s[2], s[3]}, at(s + 4), at(s + 7),
              JointStart<double>{d[0], d[1], at(s + 10), d[2], d[3], d[4], d[5], d[6], d[7]});
        return run(*f, noise, t, rate, force, events, every, kJointOut, kJointStates);
      },
      nb::arg("noise"), nb::arg("start_state"), nb::arg("start_sigma"), nb::arg("t0"), nb::arg("t"),
      nb::arg("rate"), nb::arg("force"), nb::arg("events"), nb::arg("every") = 1,
      "The joint filter over t (n,), rate and force (n, 3), and events (m, 9) in the order of\n"
      "their arrival: kind, t of arrival, t measured, z (3), sigma (3). start_state: quaternion,\n"
      "velocity, position, wind (13,); start_sigma: tilt, heading, velocity, position, gyro bias,\n"
      "accelerometer bias, wind, height bias. Every so many samples: t (k,), x (k, 26),\n"
      "covariance (k, 22, 22); of each event what became of it, nis, deviation of innovations.");
  m.def(
      "navigate_pair",
      [](const A& attitude, const Q& position, Vector field, int steps, Vector start_state,
         Vector start_sigma, double t0, Vector t, Matrix rate, Matrix force, Matrix events,
         int every) {
        check(start_state.shape(0) == 10, "start_state: expected q (4), velocity, position");
        check(start_sigma.shape(0) == 6, "start_sigma: expected tilt, heading and four others");
        check(steps >= 1, "steps: expected 1 or more");
        const double* s = start_state.data();
        const double* d = start_sigma.data();
        auto f = std::make_unique<Pair<double>>();
        const PairNoise<double> noise{attitude, position, vec3(field, "field: expected (3,)"),
                                      steps};
        start(f->attitude, t0, {s[0], s[1], s[2], s[3]}, d[0], d[1], d[4]);
        start(f->position, t0, at(s + 7), at(s + 4), d[3], d[2], d[5]);
        return run(*f, noise, t, rate, force, events, every, kPairOut, 15);
      },
      nb::arg("attitude"), nb::arg("position"), nb::arg("field"), nb::arg("steps"),
      nb::arg("start_state"), nb::arg("start_sigma"), nb::arg("t0"), nb::arg("t"), nb::arg("rate"),
      nb::arg("force"), nb::arg("events"), nb::arg("every") = 1,
      "Attitude and position filter in turn; as navigate_joint, with x (k, 16) and covariance\n"
      "(k, 15, 15): turn, gyro bias, position, velocity, accelerometer bias. start_sigma: tilt,\n"
      "heading, velocity, position, gyro bias, accelerometer bias. steps: inertial samples for "
      "one\n"
      "step of the position filter.");
}
