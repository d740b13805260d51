// Strip theory: an aircraft of strips, evaluated over arrays of flow conditions.
#include "alula/aero/strip_theory.hpp"

#include <nanobind/stl/vector.h>

#include <deque>
#include <vector>

#include "bind.hpp"

namespace {

struct Strips {
  alula::StripAircraft<double> model;
  std::deque<std::vector<double>> numbers;  // of the section tables; never move
};

constexpr std::size_t kSurfaceColumns = 7, kStripColumns = 19, kFlowColumns = 12;

void build(Strips* self, Vector reference, double CD_body, Vector center, Vector hub,
           double incidence, bool downwash_by_angle, Matrix surfaces, Matrix strips,
           const std::vector<Matrix>& sections) {
  if (surfaces.shape(1) != kSurfaceColumns || strips.shape(1) != kStripColumns ||
      sections.size() != surfaces.shape(0))
    throw nb::value_error("expected surfaces (m, 7), strips (n, 19), m section tables");
  const auto SBC = vec3(reference, "reference: expected S, b, c");
  const auto from = vec3(center, "center: expected three numbers");
  const auto at = vec3(hub, "hub: expected three numbers");
  new (self) Strips();
  auto& a = self->model;
  a.S = SBC.x, a.b = SBC.y, a.c = SBC.z;
  a.CD_body = CD_body;
  a.center = from;
  a.hub = at;
  a.incidence = incidence;
  a.downwash_by_angle = downwash_by_angle;
  const int count = static_cast<int>(strips.shape(0));
  for (std::size_t i = 0; i < surfaces.shape(0); ++i) {
    alula::StripSurface<double> s;
    s.first = static_cast<int>(surfaces(i, 0));
    s.count = static_cast<int>(surfaces(i, 1));
    s.k = surfaces(i, 2);
    s.induced = surfaces(i, 3);
    s.lift_slope = surfaces(i, 4);
    s.downwash = surfaces(i, 5);
    s.wing = surfaces(i, 6) != 0.0;
    const Matrix& table = sections[i];
    const std::size_t n = table.shape(1);
    if (table.shape(0) != 3 || n < 2 || s.first < 0 || s.count < 0 || s.first + s.count > count)
      throw nb::value_error("a section table is (3, n); a surface's strips are among those given");
    for (std::size_t row = 0; row < 3; ++row) {
      auto& kept = self->numbers.emplace_back(n);
      for (std::size_t k = 0; k < n; ++k) kept[k] = table(row, k);
      (row == 0 ? s.sections.c_l : row == 1 ? s.sections.c_d : s.sections.c_m) = kept.data();
    }
    s.sections.n = static_cast<int>(n);
    if (!a.surfaces.push(s)) throw nb::value_error("at most 8 lifting surfaces");
  }
  for (std::size_t i = 0; i < strips.shape(0); ++i) {
    const auto vector = [&](std::size_t k) {
      return alula::Vec3<double>{strips(i, k), strips(i, k + 1), strips(i, k + 2)};
    };
    alula::Strip<double> s{vector(0),
                           vector(3),
                           vector(6),
                           strips(i, 9),
                           strips(i, 10),
                           strips(i, 11),
                           {strips(i, 12), strips(i, 13), strips(i, 14)},
                           {strips(i, 15), strips(i, 16), strips(i, 17), strips(i, 18)}};
    if (!a.strips.push(s)) throw nb::value_error("at most 256 strips");
  }
}

alula::StripFlow<double> flow_of(const alula::StripAircraft<double>& a, const Matrix& in,
                                 std::size_t i) {
  const double b = 2.0 / a.b, c = 2.0 / a.c;
  return {in(i, 0),
          in(i, 1),
          {b * in(i, 2), c * in(i, 3), b * in(i, 4)},
          {in(i, 5), in(i, 6), in(i, 7), in(i, 8)},
          in(i, 9),
          in(i, 10),
          in(i, 11)};
}

void evaluate(const Strips& self, Matrix flows, MatrixOut out, bool stability_axes) {
  if (flows.shape(1) != kFlowColumns || out.shape(1) != 6 || out.shape(0) != flows.shape(0))
    throw nb::value_error("expected flows (n, 12) and out (n, 6)");
  for (std::size_t i = 0; i < flows.shape(0); ++i) {
    auto C = alula::strip_coefficients(self.model, flow_of(self.model, flows, i));
    if (stability_axes) {
      double sine, cosine;
      alula::sincos(flows(i, 0), sine, cosine);
      const double CX = C[0], CZ = C[2];
      C[0] = -CX * cosine - CZ * sine;
      C[2] = CX * sine - CZ * cosine;
    }
    for (std::size_t j = 0; j < 6; ++j) out(i, j) = C[j];
  }
}

}  // namespace

void bind_strip(nb::module_& m) {
  nb::class_<Strips>(m, "StripAircraft",
                     "Lifting surfaces by strips: see aero/strip_theory.hpp.\n"
                     "surfaces (m, 7): first strip, count, k, 1/(pi e A), k c_l_alpha, downwash\n"
                     "gradient, 1 for a wing. strips (n, 19): point, chord axis, normal, length,\n"
                     "area, half width, c_l_delta, c_m_delta, c_l_alpha, gains of de da dr df.\n"
                     "sections: per surface (3, n), c_l c_d c_m over -pi to pi.")
      .def("__init__", &build, nb::arg("reference"), nb::arg("CD_body"), nb::arg("center"),
           nb::arg("hub"), nb::arg("incidence"), nb::arg("downwash_by_angle"), nb::arg("surfaces"),
           nb::arg("strips"), nb::arg("sections"))
      .def("evaluate", &evaluate, nb::arg("flows"), nb::arg("out"), nb::arg("stability_axes"),
           "Coefficients (n, 6) for flows (n, 12): alpha beta phat qhat rhat de da dr df, and of\n"
           "the slipstream (U_i - u_0)/V, Omega_i/V (1/m), R_i (m).")
      .def_prop_ro("strip_count", [](const Strips& s) { return s.model.strips.size(); });
}
