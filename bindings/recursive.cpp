// Recursive estimators over whole recordings: one call, histories in the caller's arrays.
#include "alula/estimate/recursive_fourier.hpp"
#include "alula/estimate/recursive_least_squares.hpp"

#include <cmath>

#include "bind.hpp"

namespace {

constexpr int kMost = 32;

}  // namespace

void bind_recursive(nb::module_& m) {
  m.attr("MAX_RECURSIVE") = kMost;
  m.attr("MAX_RESIDUAL_WINDOW") = alula::kMaxResidualWindow;
  m.attr("MAX_FREQUENCIES") = alula::kMaxFrequencies;
  m.attr("MAX_FOURIER_CHANNELS") = alula::kMaxFourierChannels;

  m.def(
      "recursive_least_squares",
      [](Matrix x, Vector z, Vector initial, Vector variance, Vector bound, Vector reset,
         double factor, bool directional, int window, double least, double usual,
         double reset_ratio, MatrixOut value, MatrixOut se, MatrixOut gain, MatrixOut steps) {
        const auto samples = x.shape(0), k = x.shape(1);
        check(k >= 1 && k <= kMost, "x: expected 1 to MAX_RECURSIVE columns");
        check(z.shape(0) == samples, "z: expected one value a sample");
        check(initial.shape(0) == k && variance.shape(0) == k && bound.shape(0) == k,
              "initial, variance, bound: expected one value a parameter");
        check(reset.shape(0) == samples || reset.shape(0) == 0, "reset: expected (n,) or (0,)");
        check(value.shape(0) == samples && value.shape(1) == k, "value: expected (n, k)");
        check(se.shape(0) == samples && se.shape(1) == k, "se: expected (n, k)");
        check(gain.shape(0) == 0 || (gain.shape(0) == samples && gain.shape(1) == k),
              "gain: expected (n, k) or none");
        check(steps.shape(0) == samples && steps.shape(1) == 5, "steps: expected (n, 5)");
        check(window >= 0 && window <= alula::kMaxResidualWindow, "window: out of range");
        nb::gil_scoped_release release;
        alula::RecursiveLeastSquares<double, kMost> f;
        f.forgetting = {factor, directional, window, least, usual, reset_ratio};
        const int n = static_cast<int>(k);
        start(f, n, variance.data());
        for (int i = 0; i < n; ++i) {
          f.value[i] = initial.data()[i];
          f.bound[i] = bound.data()[i];
        }
        const bool gains = gain.shape(0) > 0, resets = reset.shape(0) > 0;
        double P[kMost];
        for (std::size_t s = 0; s < samples; ++s) {
          if (resets && reset.data()[s] != 0.0) reset_covariance(f);
          const auto step =
              update(f, x.data() + s * k, z.data()[s], gains ? gain.data() + s * k : nullptr);
          variances(f, P);
          const double noise = noise_variance(f);
          for (int i = 0; i < n; ++i) {
            const auto at = s * k + static_cast<std::size_t>(i);
            value.data()[at] = f.value[i];
            se.data()[at] = std::sqrt(noise * P[i]);
          }
          double* out = steps.data() + s * 5;
          out[0] = step.innovation;
          out[1] = step.spread;
          out[2] = step.factor;
          out[3] = step.reset ? 1.0 : 0.0;
          out[4] = noise;
        }
      },
      nb::arg("x"), nb::arg("z"), nb::arg("initial"), nb::arg("variance"), nb::arg("bound"),
      nb::arg("reset"), nb::arg("factor"), nb::arg("directional"), nb::arg("window"),
      nb::arg("least"), nb::arg("usual"), nb::arg("reset_ratio"), nb::arg("value"), nb::arg("se"),
      nb::arg("gain"), nb::arg("steps"),
      "Recursive least squares of z (n,) on x (n, k) with forgetting. initial, variance, bound\n"
      "(k,): values and variances (of unit noise) at the start, and those that forgetting does\n"
      "not exceed. reset (n,): not zero where the variances start anew; or empty. Writes the\n"
      "histories value and se (n, k), gain (n, k) where it is not empty, and steps (n, 5):\n"
      "innovation, its variance over the noise's, forgetting factor used, whether the variances\n"
      "were reset, noise variance.");

  m.def(
      "recursive_fourier",
      [](Matrix x, Vector omega, double dt, double forgetting, int every, MatrixOut value,
         MatrixOut se) {
        const auto samples = x.shape(0), channels = x.shape(1), count = omega.shape(0);
        check(channels >= 2 && channels <= alula::kMaxFourierChannels,
              "x: expected 2 to MAX_FOURIER_CHANNELS columns");
        check(count >= 1 && count <= alula::kMaxFrequencies,
              "omega: expected 1 to MAX_FREQUENCIES values");
        check(every >= 1, "every: expected 1 or more");
        const auto rows = samples / static_cast<std::size_t>(every), k = channels - 1;
        check(value.shape(0) == rows && value.shape(1) == k, "value: expected (n/every, k)");
        check(se.shape(0) == rows && se.shape(1) == k, "se: expected (n/every, k)");
        nb::gil_scoped_release release;
        alula::RecursiveFourier<double> f;
        const int m = static_cast<int>(count);
        start(f, omega.data(), m, static_cast<int>(channels), dt, forgetting);
        // Lines a resolution of 1/T apart are independent: the band, one spacing more, times T.
        const double band = (omega(count - 1) - omega(0)) / 6.283185307179586;
        const double spacing = m > 1 ? band / (m - 1) : 0.0;
        std::size_t row = 0;
        for (std::size_t s = 0; s < samples; ++s) {
          update(f, x.data() + s * channels);
          if ((s + 1) % static_cast<std::size_t>(every) != 0) continue;
          const double lines = m > 1 ? 1.0 + f.samples * dt * spacing * (m - 1) : 1.0;
          const auto found = solve(f, lines);
          for (std::size_t i = 0; i < k; ++i) {
            const double nan = std::nan("");
            value.data()[row * k + i] = found.determined ? found.value[i] : nan;
            se.data()[row * k + i] = found.determined ? std::sqrt(found.variance[i]) : nan;
          }
          ++row;
        }
      },
      nb::arg("x"), nb::arg("omega"), nb::arg("dt"), nb::arg("forgetting"), nb::arg("every"),
      nb::arg("value"), nb::arg("se"),
      "Sequential least squares in the frequency domain: the last column of x (n, c) on the\n"
      "others, at angular frequencies omega (m,), ascending, by recursive Fourier transforms.\n"
      "Writes value and se (n/every, c - 1), NaN where they are not determined yet.");
}
