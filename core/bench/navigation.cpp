// The steps of the navigation filters: microseconds in double and in single precision, the best of
// the rounds, as JSON.
#include <alula/navigate/joint_updates.hpp>
#include <alula/navigate/pair.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>

namespace {

using namespace alula;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// A wavy flight, from tables: what is timed is the filter.
template <class T>
struct Waves {
  Vec3<T> rate[64], force[64];
  Waves() {
    for (int i = 0; i < 64; ++i) {
      const double a = 6.283185307179586 * i / 64.0;
      rate[i] = {T(0.1 * std::sin(a)), T(0.05 * std::cos(a)), T(0.02 * std::sin(2.0 * a))};
      force[i] = {T(0.2 * std::sin(a)), T(0.1 * std::cos(a)), T(-9.8 + 0.5 * std::sin(a))};
    }
  }
};

// Microseconds per step of `what`, the mean over the steps; the sum keeps the work.
template <class T>
double timed(std::string_view what, int steps) {
  const Waves<T> waves;
  const Quaternion<T> level{T(1), T(0), T(0), T(0)};
  const double dt = 1.0 / 800.0;
  double begin = 0.0, end = 0.0, sum = 0.0;
  if (what == "attitude") {
    AttitudeFilter<T> f;
    const AttitudeNoise<T> noise;
    start(f, 0.0, level, T(0.1), T(0.1), T(0.01));
    begin = seconds();
    for (int i = 1; i <= steps; ++i) predict(f, noise, i * dt, waves.rate[i & 63]);
    end = seconds();
    sum = static_cast<double>(f.q.x);
  } else if (what == "attitude_update") {
    AttitudeFilter<T> f;
    const AttitudeNoise<T> noise;
    start(f, 0.0, level, T(0.1), T(0.1), T(0.01));
    MeasuredAttitude<T> z{{T(0.01), T(0.02), T(0)}, T(1), true, true};
    begin = seconds();
    for (int i = 1; i <= steps; ++i) {
      z.euler.z = waves.rate[i & 63].x * T(0.1);
      update(f, noise, z);
    }
    end = seconds();
    sum = static_cast<double>(f.q.x);
  } else if (what == "position") {
    PositionFilter<T> f;
    const PositionNoise<T> noise;
    start(f, 0.0, {}, {T(20), T(0), T(0)}, T(1), T(1), T(0.1));
    begin = seconds();
    for (int i = 1; i <= steps; ++i) predict(f, noise, i * dt, waves.force[i & 63], level);
    end = seconds();
    sum = static_cast<double>(f.position.x);
  } else if (what == "position_update") {
    PositionFilter<T> f;
    const PositionNoise<T> noise;
    start(f, 0.0, {}, {T(20), T(0), T(0)}, T(1), T(1), T(0.1));
    for (int i = 1; i <= 800; ++i) predict(f, noise, i * dt, waves.force[i & 63], level);
    const Vec3<T> sigma{T(3), T(3), T(3)};
    begin = seconds();
    for (int i = 1; i <= steps; ++i)
      update_position(f, noise, f.t - 0.2, f.position - T(0.2) * f.velocity, sigma);
    end = seconds();
    sum = static_cast<double>(f.position.x);
  } else {
    // joint: the inertial step; joint_flight: a flight at 400 Hz with everything at its own rate;
    // joint_worst: a step in which every sensor comes at once
    auto f = std::make_unique<JointFilter<T>>();
    JointNoise<T> noise;
    noise.field = {T(21), T(1.6), T(43.8)};
    start(*f, noise, 0.0, level, {T(20), T(0), T(0)}, {}, JointStart<T>{});
    const int air = what == "joint_flight" ? 8 : what == "joint_worst" ? 1 : 0;
    const int satellite = what == "joint_flight" ? 80 : what == "joint_worst" ? 1 : 0;
    const Vec3<T> far{T(3), T(3), T(3)}, slow{T(0.2), T(0.2), T(0.2)};
    for (int i = 1; i <= 400; ++i)
      predict(*f, noise, i * 2.5e-3, waves.rate[i & 63], waves.force[i & 63]);
    begin = seconds();
    for (int i = 401; i <= 400 + steps; ++i) {
      predict(*f, noise, i * 2.5e-3, waves.rate[i & 63], waves.force[i & 63]);
      if (air && i % air == 0) {
        const Vec3<T> v = air_velocity_at_sensor(*f, noise);
        update_field(*f, noise, earth_to_body(f->q) * noise.field, T(1));
        update_airspeed(*f, noise, std::sqrt(dot(v, v)), T(0.3));
        update_alpha(*f, noise, std::atan2(v.z, v.x), T(0.01));
        update_beta(*f, noise, T(0), T(0.01));
        update_height(*f, noise, -f->position.z + f->height_bias, T(1));
      }
      if (satellite && i % satellite == 0) {
        update_position(*f, noise, f->t - 0.2, f->position - T(0.2) * f->velocity, far);
        update_velocity(*f, noise, f->t - 0.2, f->velocity, slow);
      }
    }
    end = seconds();
    sum = static_cast<double>(f->position.x);
  }
  if (!std::isfinite(sum)) std::exit(1);
  return 1e6 * (end - begin) / steps;
}

template <class T>
double best(std::string_view what, int steps, int rounds) {
  double out = 1e9;
  for (int i = 0; i < rounds; ++i) out = std::fmin(out, timed<T>(what, steps));
  return out;
}

}  // namespace

int main(int count, char** arguments) {
  const int steps = count > 1 ? std::atoi(arguments[1]) : 10'000;
  const int rounds = count > 2 ? std::atoi(arguments[2]) : 30;
  const char* before = "{";
  for (const char* what : {"attitude", "attitude_update", "position", "position_update", "joint",
                           "joint_flight", "joint_worst"}) {
    std::printf("%s\"%s\": [%.6f, %.6f]", before, what, best<double>(what, steps, rounds),
                best<float>(what, steps, rounds));
    before = ", ";
  }
  std::printf("}\n");
}
