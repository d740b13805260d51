// Angles of attack and sideslip without vanes over whole recordings: one call, results in the
// caller's arrays.
#include <nanobind/stl/tuple.h>

#include <cmath>
#include <tuple>

#include "alula/airdata/asse_filter.hpp"
#include "alula/airdata/asse_solve.hpp"
#include "alula/airdata/asse_zero_order.hpp"
#include "bind.hpp"

namespace {

using alula::Vec3;

constexpr std::size_t kSettings = 17, kColumns = 13;

Vec3<double> row(const Matrix& m, std::size_t i) { return {m(i, 0), m(i, 1), m(i, 2)}; }

bool rows_of_three(const Matrix& m, std::size_t n) { return m.shape(0) == n && m.shape(1) == 3; }

// Settings in the order of AsseSettings.
alula::AsseSettings<double> settings_of(const Vector& v) {
  check(v.shape(0) == kSettings, "settings: expected 17 numbers");
  return {v(0), v(1),  v(2),  v(3),  v(4),  v(5),  v(6),  v(7), v(8),
          v(9), v(10), v(11), v(12), v(13), v(14), v(15), v(16)};
}

using Counts = std::tuple<long, long, long, long, long>;

Counts counts(const alula::AsseRejected& r) {
  return {r.not_finite, r.backward, r.slow, r.outlying, r.gaps};
}

struct Recording {
  Vector t;
  Matrix f, w, gravity, wind_rate;
  Vector V;

  void check_shapes() const {
    const auto n = t.shape(0);
    check(rows_of_three(f, n) && rows_of_three(w, n) && rows_of_three(gravity, n) &&
              rows_of_three(wind_rate, n),
          "f, w, gravity, wind_rate: expected (n, 3)");
    check(V.shape(0) == n, "V: expected (n,)");
  }
  alula::AsseInput<double> input(std::size_t i) const {
    return {t(i), row(f, i), row(w, i), row(gravity, i), row(wind_rate, i)};
  }
};

void write(double* out, const alula::AsseEstimate<double>& e,
           const alula::ReportedAngle<double>& alpha, const alula::ReportedAngle<double>& beta) {
  const double nan = std::nan("");
  const double values[] = {e.V,       e.alpha,   e.beta,    e.P[0][0], e.P[0][1],
                           e.P[0][2], e.P[1][1], e.P[1][2], e.P[2][2]};
  for (int i = 0; i < 9; ++i) out[i] = e.V > 0.0 ? values[i] : nan;
  out[9] = alpha.observable;
  out[10] = beta.observable;
  out[11] = alpha.ever ? alpha.age : nan;
  out[12] = beta.ever ? beta.age : nan;
}

// Advances `s` over a recording; `found` writes its row where there is an estimate, else it is NaN.
template <class State, class Found>
Counts over(State& s, const Recording& r, const MatrixOut& out, Found found) {
  const auto n = r.t.shape(0);
  check(out.shape(0) == n && out.shape(1) == kColumns, "out: expected (n, 13)");
  nb::gil_scoped_release release;
  for (std::size_t i = 0; i < n; ++i) {
    double* o = out.data() + kColumns * i;
    for (std::size_t c = 0; c < kColumns; ++c) o[c] = std::nan("");
    const bool taken = advance(s, r.input(i));
    if (!std::isnan(r.V(i))) add_airspeed(s, r.t(i), r.V(i));
    found(i, taken, o);
  }
  return counts(s.rejected);
}

}  // namespace

void bind_asse(nb::module_& m) {
  m.attr("MAX_ASSE_SAMPLES") = alula::kMaxAsseSamples;
  m.attr("MAX_ZERO_ORDER") = alula::kMaxZeroOrder;

  m.def(
      "asse_zero_order",
      [](Vector t, Vector V, Vector V_dot, Matrix a, Matrix w, Matrix gained, Vector offsets,
         int every, double threshold, double equation_error, double alpha, double beta,
         MatrixOut out) {
        const auto n = t.shape(0);
        const auto equations = offsets.shape(0) + 1;
        check(V.shape(0) == n && V_dot.shape(0) == n, "V, V_dot: expected (n,)");
        check(rows_of_three(a, n) && rows_of_three(w, n) && rows_of_three(gained, n),
              "a, w, gained: expected (n, 3)");
        check(equations >= 2 && equations <= alula::kMaxZeroOrder,
              "offsets: expected 1 to MAX_ZERO_ORDER - 1 of them");
        check(every >= 1, "every: expected 1 or more");
        check(out.shape(0) == n && out.shape(1) == 8, "out: expected (n, 8)");
        nb::gil_scoped_release release;
        alula::ZeroOrderScheme<double> scheme;
        scheme.settings.threshold = threshold;
        scheme.settings.equation_error = equation_error;
        scheme.alpha.value = alpha;
        scheme.beta.value = beta;
        const auto last = static_cast<long>(n);
        for (long i = 0; i < last; ++i) {
          double* o = out.data() + 8 * i;
          for (int c = 0; c < 8; ++c) o[c] = std::nan("");
          if (i % every != 0) continue;
          alula::ZeroOrderSample<double> samples[alula::kMaxZeroOrder];
          bool there = true;
          const auto here = static_cast<std::size_t>(i);
          for (std::size_t k = 0; k < equations && there; ++k) {
            const long j = k == 0 ? i : i - static_cast<long>(offsets(k - 1));
            there = j >= 0 && j < last;
            if (!there) break;
            const auto at = static_cast<std::size_t>(j);
            samples[k] = {
                t(here) - t(at), V(at), V_dot(at), row(a, at), row(gained, here) - row(gained, at),
                row(w, at)};
          }
          alula::ZeroOrderSolution<double> s;
          if (!there || !update(scheme, t(here), samples, static_cast<int>(equations), s)) continue;
          const double all[] = {s.alpha,
                                s.beta,
                                s.existence_alpha,
                                s.existence_beta,
                                scheme.alpha.observable ? 1.0 : 0.0,
                                scheme.beta.observable ? 1.0 : 0.0,
                                scheme.alpha.ever ? scheme.alpha.age : std::nan(""),
                                scheme.beta.ever ? scheme.beta.age : std::nan("")};
          for (int c = 0; c < 8; ++c) o[c] = all[c];
        }
        return counts(scheme.rejected);
      },
      nb::arg("t"), nb::arg("V"), nb::arg("V_dot"), nb::arg("a"), nb::arg("w"), nb::arg("gained"),
      nb::arg("offsets"), nb::arg("every"), nb::arg("threshold"), nb::arg("equation_error"),
      nb::arg("alpha"), nb::arg("beta"), nb::arg("out"),
      "Zero-order scheme over a recording. t, V, V_dot (n,); a, w, gained (n, 3): acceleration\n"
      "against the air, rates, integral of a since the start, body axes. offsets: samples back\n"
      "(negative: ahead) of the further equations. Solves at every `every`th sample from the last\n"
      "valid angles, first alpha, beta. out (n, 8): alpha, beta, their existence numbers, whether\n"
      "observable, age of the last valid values; NaN where nothing was solved. Returns counts of\n"
      "what was rejected: not finite, backward, slow, outlying, gaps.");

  m.def(
      "asse_window",
      [](Vector t, Matrix f, Matrix w, Matrix gravity, Matrix wind_rate, Vector V, Vector settings,
         int capacity, int every, MatrixOut out) {
        const Recording r{t, f, w, gravity, wind_rate, V};
        r.check_shapes();
        check(capacity >= 3 && capacity <= alula::kMaxAsseSamples,
              "capacity: expected 3 to MAX_ASSE_SAMPLES");
        check(every >= 1, "every: expected 1 or more");
        alula::AsseWindow<double> window;
        window.settings = settings_of(settings);
        window.capacity = capacity;
        return over(window, r, out, [&](std::size_t i, bool taken, double* o) {
          if (!taken || i % static_cast<std::size_t>(every) != 0) return;
          const auto e = solve(window);
          write(o, e, window.alpha, window.beta);
        });
      },
      nb::arg("t"), nb::arg("f"), nb::arg("w"), nb::arg("gravity"), nb::arg("wind_rate"),
      nb::arg("V"), nb::arg("settings"), nb::arg("capacity"), nb::arg("every"), nb::arg("out"),
      "Exact affine form over a recording. f, w, gravity, wind_rate (n, 3) body axes; V (n,) NaN\n"
      "where there is none. settings (17,) as AsseSettings; capacity: samples of the window. out\n"
      "(n, 13): V, alpha, beta, their covariance (6, upper triangle), observable (2), ages (2).\n"
      "Returns counts of what was rejected: not finite, backward, slow, outlying, gaps.");

  m.def(
      "asse_filter",
      [](Vector t, Matrix f, Matrix w, Matrix gravity, Matrix wind_rate, Vector V, Vector settings,
         Vector alpha, double alpha_sigma, MatrixOut out) {
        const Recording r{t, f, w, gravity, wind_rate, V};
        r.check_shapes();
        check(alpha.shape(0) == 0 || alpha.shape(0) == t.shape(0), "alpha: expected (n,) or none");
        alula::AsseFilter<double> filter;
        filter.settings = settings_of(settings);
        start(filter);
        return over(filter, r, out, [&](std::size_t i, bool taken, double* o) {
          if (alpha.shape(0) > 0 && filter.running && !std::isnan(alpha(i)))
            add_alpha(filter, alpha(i), alpha_sigma);
          if (taken && filter.running)
            write(o, estimate(filter), filter.reported_alpha, filter.reported_beta);
        });
      },
      nb::arg("t"), nb::arg("f"), nb::arg("w"), nb::arg("gravity"), nb::arg("wind_rate"),
      nb::arg("V"), nb::arg("settings"), nb::arg("alpha"), nb::arg("alpha_sigma"), nb::arg("out"),
      "Filter over a recording, arguments as asse_window. alpha (n,) or empty: angles of attack\n"
      "from elsewhere, NaN where there are none, of standard deviation alpha_sigma, rad.");
}
