// Air data: conversions, five-hole probe, static port and vanes over arrays.
#include <chrono>

#include "alula/airdata/conversions.hpp"
#include "alula/airdata/monitor.hpp"
#include "alula/airdata/probe_table.hpp"
#include "alula/airdata/static_port.hpp"
#include "alula/airdata/vane.hpp"
#include "bind.hpp"

namespace air = alula::airdata;

namespace {

using StatusOut = nb::ndarray<int, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

void same_length(std::size_t a, std::size_t b) {
  if (a != b) throw nb::value_error("expected arrays of one length");
}

template <class F>
void def1(nb::module_& m, const char* name, F f, const char* doc) {
  m.def(
      name,
      [f](Vector a, VectorOut out) {
        same_length(a.shape(0), out.shape(0));
        for (std::size_t i = 0; i < a.shape(0); ++i) out(i) = f(a(i));
      },
      nb::arg("a"), nb::arg("out"), doc);
}

template <class F>
void def2(nb::module_& m, const char* name, F f, const char* doc) {
  m.def(
      name,
      [f](Vector a, Vector b, VectorOut out) {
        same_length(a.shape(0), out.shape(0));
        same_length(b.shape(0), out.shape(0));
        for (std::size_t i = 0; i < a.shape(0); ++i) out(i) = f(a(i), b(i));
      },
      nb::arg("a"), nb::arg("b"), nb::arg("out"), doc);
}

template <class F>
void def3(nb::module_& m, const char* name, F f, const char* doc) {
  m.def(
      name,
      [f](Vector a, Vector b, Vector c, VectorOut out) {
        same_length(a.shape(0), out.shape(0));
        same_length(b.shape(0), out.shape(0));
        same_length(c.shape(0), out.shape(0));
        for (std::size_t i = 0; i < a.shape(0); ++i) out(i) = f(a(i), b(i), c(i));
      },
      nb::arg("a"), nb::arg("b"), nb::arg("c"), nb::arg("out"), doc);
}

template <class S>
air::HarmonicCp<S> cp_of(Vector power, double sine) {
  air::HarmonicCp<S> cp;
  for (std::size_t i = 0; i < power.shape(0); ++i)
    if (!cp.power.push(S(power(i)))) throw nb::value_error("at most 9 powers of cos(theta)");
  cp.sine = S(sine);
  return cp;
}

template <class S>
air::ProbePressures<S> pressures_at(Matrix p, std::size_t i) {
  return {S(p(i, 0)), S(p(i, 1)), S(p(i, 2))};
}

class Probe {
 public:
  Probe(Vector side, double side_sine, Vector center, double center_sine, double port_angle,
        double widest, double domain, double least) {
    fill(double_, side, side_sine, center, center_sine, port_angle, widest, domain, least);
    fill(single_, side, side_sine, center, center_sine, port_angle, widest, domain, least);
  }

  void start(VectorOut out) const {
    same_length(out.shape(0), 3);
    out(0) = double_.A;
    out(1) = double_.B;
    out(2) = double_.K;
  }

  void forward(Vector q, Vector alpha, Vector beta, MatrixOut out) const {
    columns(out, q.shape(0), 3);
    for (std::size_t i = 0; i < q.shape(0); ++i) {
      const auto p = air::probe_pressures(double_, q(i), alpha(i), beta(i));
      out(i, 0) = p.center;
      out(i, 1) = p.vertical;
      out(i, 2) = p.lateral;
    }
  }

  void inverse(Matrix p, MatrixOut out, StatusOut status, bool single) const {
    columns(out, p.shape(0), 4);
    same_length(p.shape(0), status.shape(0));
    if (single)
      run(single_, p, out, status);
    else
      run(double_, p, out, status);
  }

  void sensitivity(Vector q, Vector alpha, Vector beta, CubeOut out) const {
    if (out.shape(0) != q.shape(0) || out.shape(1) != 3 || out.shape(2) != 3)
      throw nb::value_error("out: expected shape (n, 3, 3)");
    for (std::size_t i = 0; i < q.shape(0); ++i) {
      alula::Mat3<double> s;
      const bool found = air::probe_sensitivity(double_, q(i), alpha(i), beta(i), s);
      for (std::size_t j = 0; j < 3; ++j) {
        const auto& row = s.row[j];
        out(i, j, 0) = found ? row.x : air::undefined<double>();
        out(i, j, 1) = found ? row.y : air::undefined<double>();
        out(i, j, 2) = found ? row.z : air::undefined<double>();
      }
    }
  }

  // Y, Z and q of the inverse's start, which the lookup table is over.
  void starts(Matrix p, MatrixOut out) const {
    columns(out, p.shape(0), 3);
    for (std::size_t i = 0; i < p.shape(0); ++i) {
      double Y{}, Z{}, q{};
      const bool ahead = air::probe_start(double_, pressures_at<double>(p, i), Y, Z, q);
      out(i, 0) = ahead ? Y : air::undefined<double>();
      out(i, 1) = ahead ? Z : air::undefined<double>();
      out(i, 2) = ahead ? q : air::undefined<double>();
    }
  }

  // Least time of one inverse over several rounds, s; the sum keeps the loop from being left out.
  template <class S>
  double seconds(const air::Probe<S>& probe, Matrix p, int rounds) const {
    double best = 1e9;
    volatile S kept{};
    for (int r = 0; r < rounds; ++r) {
      S sum{};
      const auto begin = std::chrono::steady_clock::now();
      for (std::size_t i = 0; i < p.shape(0); ++i) {
        air::ProbeFlow<S> flow;
        air::probe_flow(probe, pressures_at<S>(p, i), flow);
        sum += flow.alpha;
      }
      kept = sum;
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      best = std::fmin(best, took.count() / static_cast<double>(p.shape(0)));
    }
    (void)kept;
    return best;
  }
  double time(Matrix p, int rounds, bool single) const {
    columns(p, p.shape(0), 3);
    return single ? seconds(single_, p, rounds) : seconds(double_, p, rounds);
  }

 private:
  template <class A>
  static void columns(const A& a, std::size_t n, std::size_t k) {
    if (a.shape(0) != n || a.shape(1) != k) throw nb::value_error("an array of another shape");
  }

  template <class S>
  static void fill(air::Probe<S>& probe, Vector side, double side_sine, Vector center,
                   double center_sine, double port_angle, double widest, double domain,
                   double least) {
    probe.side = cp_of<S>(side, side_sine);
    probe.center = cp_of<S>(center, center_sine);
    probe.port_angle = S(port_angle);
    probe.widest = S(widest);
    probe.domain = S(domain);
    probe.least = S(least);
    if (!air::prepare(probe)) throw nb::value_error("no probe: c_p does not tell angles apart");
  }

  template <class S>
  static void run(const air::Probe<S>& probe, Matrix p, MatrixOut out, StatusOut status) {
    columns(p, p.shape(0), 3);
    for (std::size_t i = 0; i < p.shape(0); ++i) {
      air::ProbeFlow<S> flow{air::undefined<S>(), air::undefined<S>(), air::undefined<S>(), 0};
      status(i) = air::probe_flow(probe, pressures_at<S>(p, i), flow);
      out(i, 0) = flow.q;
      out(i, 1) = flow.alpha;
      out(i, 2) = flow.beta;
      out(i, 3) = flow.iterations;
    }
  }

  air::Probe<double> double_;
  air::Probe<float> single_;
};

void bind_conversions(nb::module_& m) {
  def1(m, "impact_ratio", air::impact_ratio<double>, "Impact over static pressure of Mach.");
  def1(m, "mach_of", air::mach_of<double>, "Mach of impact over static pressure.");
  def1(m, "impact_of_cas", air::impact_of_cas<double>, "Impact pressure of CAS.");
  def1(m, "cas_of_impact", air::cas_of_impact<double>, "CAS of impact pressure.");
  def2(m, "mach_of_cas", air::mach_of_cas<double>, "Mach of CAS and static pressure.");
  def2(m, "cas_of_mach", air::cas_of_mach<double>, "CAS of Mach and static pressure.");
  def3(m, "tas_of_cas", air::tas_of_cas<double>, "TAS of CAS, pressure, temperature.");
  def3(m, "cas_of_tas", air::cas_of_tas<double>, "CAS of TAS, pressure, temperature.");
  def3(m, "eas_of_tas", air::eas_of_tas<double>, "EAS of TAS, pressure, temperature.");
  def3(m, "tas_of_eas", air::tas_of_eas<double>, "TAS of EAS, pressure, temperature.");
  def2(m, "cas_of_ias", air::cas_of_ias<double>, "CAS of IAS and static-pressure error.");
  def2(m, "ias_of_cas", air::ias_of_cas<double>, "IAS of CAS and static-pressure error.");
  def3(m, "static_temperature", air::static_temperature<double>,
       "Static temperature of total temperature, Mach, recovery factor.");
  def1(m, "pressure_altitude", air::pressure_altitude<double>, "Geopotential, of pressure.");
  def1(m, "density_altitude", air::density_altitude<double>, "Geopotential, of density.");
  def1(m, "pressure_at", air::pressure_at<double>, "Pressure at a pressure altitude.");
  def1(m, "geometric_height", air::geometric_height<double>, "Of a geopotential height.");
  m.def(
      "static_pressure_correction",
      [](double linear, double quadratic, double rho_0, double fastest, Vector U, Vector rho,
         VectorOut out) {
        same_length(U.shape(0), out.shape(0));
        same_length(rho.shape(0), out.shape(0));
        const air::StaticPort<double> port{linear, quadratic, rho_0, fastest};
        for (std::size_t i = 0; i < U.shape(0); ++i)
          out(i) = air::static_pressure_correction(port, U(i), rho(i));
      },
      nb::arg("linear"), nb::arg("quadratic"), nb::arg("rho_0"), nb::arg("fastest"), nb::arg("U"),
      nb::arg("rho"), nb::arg("out"), "Air's pressure less the port's, Pa.");
}

air::Vane<double> vane_of(Vector v) {
  if (v.shape(0) != 5) throw nb::value_error("vane: expected upwash, bias and arm (3)");
  return {v(0), v(1), {v(2), v(3), v(4)}};
}

alula::Vec3<double> row_of(Matrix a, std::size_t i) { return {a(i, 0), a(i, 1), a(i, 2)}; }

void bind_vanes(nb::module_& m) {
  m.def(
      "vane_readings",
      [](Vector alpha_vane, Vector beta_vane, Matrix v, Matrix rates, MatrixOut out) {
        const auto a = vane_of(alpha_vane), b = vane_of(beta_vane);
        for (std::size_t i = 0; i < v.shape(0); ++i) {
          out(i, 0) = air::alpha_vane_reading(a, row_of(v, i), row_of(rates, i));
          out(i, 1) = air::beta_vane_reading(b, row_of(v, i), row_of(rates, i));
        }
      },
      nb::arg("alpha_vane"), nb::arg("beta_vane"), nb::arg("v"), nb::arg("rates"), nb::arg("out"),
      "Readings of both vanes at velocities (n, 3) and rates (n, 3).");
  m.def(
      "flow_from_vanes",
      [](Vector alpha_vane, Vector beta_vane, Vector pitot, Matrix readings, Matrix rates,
         MatrixOut out) {
        const auto a = vane_of(alpha_vane), b = vane_of(beta_vane);
        const auto arm = vec3(pitot, "pitot: expected 3 numbers");
        int refused = 0;
        for (std::size_t i = 0; i < readings.shape(0); ++i) {
          air::FlowAngles<double> flow{air::undefined<double>(), air::undefined<double>(),
                                       air::undefined<double>()};
          if (!air::flow_from_vanes(a, b, arm, readings(i, 0), readings(i, 1), readings(i, 2),
                                    row_of(rates, i), flow))
            ++refused;
          out(i, 0) = flow.V;
          out(i, 1) = flow.alpha;
          out(i, 2) = flow.beta;
        }
        return refused;
      },
      nb::arg("alpha_vane"), nb::arg("beta_vane"), nb::arg("pitot"), nb::arg("readings"),
      nb::arg("rates"), nb::arg("out"),
      "V, alpha, beta at the center of gravity of readings (n, 3): alpha vane, beta vane, V.\n"
      "Returns how many were refused; those are NaN.");
}

void bind_monitor(nb::module_& m) {
  m.def(
      "monitor",
      [](Matrix sources, Vector settings, Vector t, Matrix readings, MatrixOut out,
         nb::ndarray<int, nb::ndim<2>, nb::c_contig, nb::device::cpu> health, StatusOut named) {
        if (sources.shape(1) != 3 || settings.shape(0) != 7)
          throw nb::value_error("sources: expected (m, 3); settings: expected 7 numbers");
        air::MonitorSettings<double> s;
        for (std::size_t i = 0; i < sources.shape(0); ++i)
          if (!s.sources.push({sources(i, 0), sources(i, 1), static_cast<int>(sources(i, 2))}))
            throw nb::value_error("at most 8 sources");
        s.mean_time = settings(0);
        s.bias_limit = settings(1);
        s.noise_limit = settings(2);
        s.dead_after = settings(3);
        s.readmit = settings(4);
        s.gate = settings(5);
        s.longest_step = settings(6);
        const std::size_t m = sources.shape(0);
        if (readings.shape(0) != t.shape(0) || readings.shape(1) != m ||
            health.shape(0) != t.shape(0) || health.shape(1) != m || out.shape(0) != t.shape(0) ||
            out.shape(1) != 4)
          throw nb::value_error("expected readings and health (n, m), out (n, 4)");
        air::MonitorState<double> state;
        double now[air::kMostSources];
        bool fresh[air::kMostSources];
        for (std::size_t k = 0; k < t.shape(0); ++k) {
          for (std::size_t i = 0; i < m; ++i) {
            now[i] = readings(k, i);
            fresh[i] = !std::isnan(now[i]);
          }
          const auto voted = air::monitor_step(s, state, t(k), now, fresh);
          out(k, 0) = voted.angle;
          out(k, 1) = voted.sigma;
          out(k, 2) = voted.used;
          out(k, 3) = voted.split;
          named(k) = voted.named;
          for (std::size_t i = 0; i < m; ++i) health(k, i) = state.source[i].health;
        }
        return state.refused;
      },
      nb::arg("sources"), nb::arg("settings"), nb::arg("t"), nb::arg("readings"), nb::arg("out"),
      nb::arg("health"), nb::arg("named"),
      "Vote over readings (n, m), NaN where there is none: angle, sigma, used, split (n, 4).\n"
      "sources: white, slow, stuck_after. Returns how many steps were refused.");
}

}  // namespace

void bind_airdata(nb::module_& m) {
  bind_conversions(m);
  bind_vanes(m);
  bind_monitor(m);
  nb::class_<Probe>(m, "Probe", "Five-hole probe: see alula/airdata/probe.hpp.")
      .def(nb::init<Vector, double, Vector, double, double, double, double, double>(),
           nb::arg("side"), nb::arg("side_sine"), nb::arg("center"), nb::arg("center_sine"),
           nb::arg("port_angle"), nb::arg("widest"), nb::arg("domain"), nb::arg("least"))
      .def("start", &Probe::start, nb::arg("out"), "A, B and K of the inverse's start.")
      .def("forward", &Probe::forward, nb::arg("q"), nb::arg("alpha"), nb::arg("beta"),
           nb::arg("out"), "p0 - static, p1 - p2, p3 - p4 (n, 3).")
      .def("inverse", &Probe::inverse, nb::arg("pressures"), nb::arg("out"), nb::arg("status"),
           nb::arg("single"), "q, alpha, beta, iterations (n, 4), and the status of each.")
      .def("sensitivity", &Probe::sensitivity, nb::arg("q"), nb::arg("alpha"), nb::arg("beta"),
           nb::arg("out"), "Slopes of alpha, beta, q with the pressures (n, 3, 3).")
      .def("starts", &Probe::starts, nb::arg("pressures"), nb::arg("out"), "Y, Z, q (n, 3).")
      .def("time", &Probe::time, nb::arg("pressures"), nb::arg("rounds"), nb::arg("single"),
           "Least time of one inverse, s.");
  m.def(
      "probe_lookup",
      [](nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu> data, double half,
         Vector start, double least, double domain, Matrix p, MatrixOut out, StatusOut status) {
        if (data.shape(0) != data.shape(1) || data.shape(2) != 3 || data.shape(0) < 2)
          throw nb::value_error("data: expected shape (n, n, 3)");
        const air::ProbeTable<float> table{data.data(),
                                           static_cast<int>(data.shape(0)),
                                           static_cast<float>(half),
                                           static_cast<float>(start(0)),
                                           static_cast<float>(start(1)),
                                           static_cast<float>(start(2)),
                                           static_cast<float>(least),
                                           static_cast<float>(domain)};
        for (std::size_t i = 0; i < p.shape(0); ++i) {
          const float none = air::undefined<float>();
          air::ProbeFlow<float> flow{none, none, none, 0};
          status(i) = air::probe_lookup(table, pressures_at<float>(p, i), flow);
          out(i, 0) = flow.q;
          out(i, 1) = flow.alpha;
          out(i, 2) = flow.beta;
        }
      },
      nb::arg("data"), nb::arg("half"), nb::arg("start"), nb::arg("least"), nb::arg("domain"),
      nb::arg("pressures"), nb::arg("out"), nb::arg("status"),
      "q, alpha, beta (n, 3) by the flight computer's table, in its float arithmetic.");
}
