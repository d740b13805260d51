// Actuators and what sensors do over time.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "alula/sensors/actuator.hpp"
#include "alula/sensors/error_model.hpp"

namespace {

double settle(const alula::Actuator<double>& a, double position, double command, double time) {
  const int steps = 20000;
  for (int i = 0; i < steps; ++i)
    position += time / steps * alula::actuator_rate(a, position, command);
  return position;
}

TEST(Actuator, LagsByItsTimeConstant) {
  const alula::Actuator<double> a{0.1};
  EXPECT_NEAR(settle(a, 0.0, 1.0, 0.1), 1.0 - std::exp(-1.0), 1e-5);  // Euler's steps of 5 us
}

TEST(Actuator, MovesNoFasterAndNoFurtherThanItCan) {
  alula::Actuator<double> a{0.05};
  a.rate_limit = 0.5;
  a.low = -0.3;
  a.high = 0.2;
  EXPECT_DOUBLE_EQ(alula::actuator_rate(a, 0.0, 1.0), 0.5);
  EXPECT_DOUBLE_EQ(alula::actuator_rate(a, 0.0, -1.0), -0.5);
  EXPECT_NEAR(settle(a, 0.0, 1.0, 2.0), 0.2, 1e-9);
  EXPECT_NEAR(settle(a, 0.0, -1.0, 2.0), -0.3, 1e-9);
  EXPECT_NEAR(settle(a, 0.5, 1.0, 2.0), 0.2, 1e-9);  // from outside it comes back
}

TEST(Actuator, StandsStillWithinItsDeadBand) {
  alula::Actuator<double> a{0.05};
  a.dead_band = 0.02;  // full width
  EXPECT_EQ(alula::actuator_rate(a, 0.0, 0.0099), 0.0);
  EXPECT_EQ(alula::actuator_rate(a, 0.0, -0.0099), 0.0);
  EXPECT_NEAR(alula::actuator_rate(a, 0.0, 0.02), 0.01 / 0.05, 1e-14);
  EXPECT_NEAR(settle(a, 0.0, 0.1, 2.0), 0.09, 1e-9);
  EXPECT_NEAR(settle(a, 0.2, 0.1, 2.0), 0.11, 1e-9);
}

TEST(Actuator, MayRunDownFasterThanUp) {
  alula::Actuator<double> a{1.11};  // Pusztai 2018, appendix B.3
  a.tau_down = 0.36;
  EXPECT_DOUBLE_EQ(alula::actuator_rate(a, 0.0, 1.0), 1.0 / 1.11);
  EXPECT_DOUBLE_EQ(alula::actuator_rate(a, 1.0, 0.0), -1.0 / 0.36);
}

TEST(Actuator, SlopesEndAtTheLimits) {
  using D = alula::Dual<double, 8>;
  alula::Actuator<double> a{0.05};
  a.rate_limit = 0.5;
  const D free = alula::actuator_rate(a, D::variable(0.0, 0), D::variable(0.01, 1));
  EXPECT_DOUBLE_EQ(free.slope_of(0), -20.0);
  EXPECT_DOUBLE_EQ(free.slope_of(1), 20.0);
  const D limited = alula::actuator_rate(a, D::variable(0.0, 0), D::variable(1.0, 1));
  EXPECT_EQ(limited.slope_of(0), 0.0);
  EXPECT_EQ(limited.slope_of(1), 0.0);
}

TEST(Sensor, LagOfARampIsExactAtAnyStep) {
  // tau y' = u - y with u = 3 t, y(0) = 0: y = 3 (t - tau (1 - exp(-t/tau)))
  alula::SensorError<double> error;
  error.lag = 0.3;
  for (const double dt : {0.001, 0.1, 1.0}) {
    alula::SensorMemory<double> memory;
    for (double t = 0.0; t < 3.0; t += dt) {
      const auto out = alula::sense(error, memory, t, 3.0 * t, 0.0, 0.5);
      EXPECT_NEAR(out.value, 3.0 * (t - 0.3 * (1.0 - std::exp(-t / 0.3))),
                  1e-11);  // 3000 roundings
    }
  }
}

TEST(Sensor, WithoutMemoryItReadsAsBefore) {
  const alula::SensorError<double> error{0.01, 0.5, 2.0, 0.25};
  alula::SensorMemory<double> memory;
  for (int i = 0; i < 20; ++i) {
    const double truth = 0.7 * i, normal = std::sin(i);
    const auto out = alula::sense(error, memory, 0.1 * i, truth, normal, 0.0);
    EXPECT_TRUE(out.present);
    EXPECT_EQ(out.value, alula::reading(error, truth, normal));
  }
}

TEST(Sensor, SticksForAsLongAsItIsTold) {
  alula::SensorError<double> error;
  error.stuck_from = 1.0;
  error.stuck_until = 2.0;
  alula::SensorMemory<double> memory;
  for (int i = 0; i < 300; ++i) {
    const double t = 0.01 * i;
    const auto out = alula::sense(error, memory, t, t, 0.0, 0.5);
    EXPECT_TRUE(out.present);
    EXPECT_NEAR(out.value, t >= 1.0 && t < 2.0 ? 0.99 : t, 1e-12) << t;
  }
}

TEST(Sensor, DropsOutAsOftenAndAsLongAsItIsTold) {
  alula::SensorError<double> error;
  error.dropout_rate = 0.5;
  error.dropout_length = 0.4;
  alula::SensorMemory<double> memory;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int gone = 0, begun = 0;
  bool before = true;
  const int n = 1000000;
  for (int i = 0; i < n; ++i) {
    const auto out = alula::sense(error, memory, 0.01 * i, 1.0 * i, 0.0, unit(random));
    if (!out.present) {
      ++gone;
      if (before) ++begun;
      EXPECT_LT(out.value, 1.0 * i);  // the last one that was there
    }
    before = out.present;
  }
  // 10 000 s: about 4200 dropouts, so 1.6 % and 2.2 % by chance; up for 2 s, away for 0.4 s (the
  // last sample of the 0.01 s raster adds 1 %)
  EXPECT_NEAR(begun / 10000.0, 1.0 / 2.4, 0.06 / 2.4);
  EXPECT_NEAR(0.01 * gone / begun, 0.4, 0.03);
  // Single samples, where no length is given.
  error.dropout_length = 0.0;
  memory = {};
  int longest = 0, run = 0;
  for (int i = 0; i < 100000; ++i) {
    run = alula::sense(error, memory, 0.01 * i, 0.0, 0.0, unit(random)).present ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  EXPECT_EQ(longest, 1);
}

}  // namespace
