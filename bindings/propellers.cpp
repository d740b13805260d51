// Propellers by their blades: Pusztai's momentum disk, blade elements, the slipstream.
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>
#include <vector>

#include "alula/propulsion/blade_element.hpp"
#include "alula/propulsion/momentum_propeller.hpp"
#include "alula/propulsion/slipstream.hpp"
#include "bind.hpp"

namespace {

using Shape = alula::BladeShape<double>;
// c_l_0, c_l_alpha, c_l_min, c_l_max, c_d_0, c_d_2_upper, c_d_2_lower, c_l_cd0, c_d_stalled,
// reynolds, reynolds_power, Mach correction (0 or 1); then a table of alpha, c_l, c_d, which may be
// empty.
using PolarArgument = std::tuple<Vector, Vector, Vector, Vector>;
constexpr std::size_t kPolarNumbers = 12;

void check_out(const MatrixOut& out, std::size_t rows, std::size_t columns) {
  if (out.shape(0) != rows || out.shape(1) != columns)
    throw nb::value_error("out: expected one row per case and the columns of the description");
}

alula::SectionPolar<double> polar_of(const PolarArgument& from) {
  const auto& [n, alpha, c_l, c_d] = from;
  if (n.shape(0) != kPolarNumbers) throw nb::value_error("a polar has twelve numbers");
  if (c_l.shape(0) != alpha.shape(0) || c_d.shape(0) != alpha.shape(0))
    throw nb::value_error("a polar's table has one c_l and one c_d per alpha");
  return {n(0),         n(1),       n(2),       n(3),
          n(4),         n(5),       n(6),       n(7),
          n(8),         n(9),       n(10),      n(11) != 0.0,
          alpha.data(), c_l.data(), c_d.data(), static_cast<int>(alpha.shape(0))};
}

int regime_of(alula::PropellerRegime r) { return static_cast<int>(r); }

}  // namespace

void bind_propellers(nb::module_& m) {
  m.attr("MAX_BLADE_STATIONS") = alula::kMaxBladeStations;

  nb::class_<Shape>(m, "BladeShape", "Blades by stations; lengths over the tip's radius.")
      .def(
          "__init__",
          [](Shape* self, int count, double radius, double hub, double helix, Vector r,
             Vector chord, Vector pitch) {
            const std::size_t n = r.shape(0);
            if (n < 2 || n > alula::kMaxBladeStations || chord.shape(0) != n || pitch.shape(0) != n)
              throw nb::value_error("blades have 2 to 64 stations, each with chord and pitch");
            if (count < 1 || !(radius > 0.0) || !(hub >= 0.0) || !(hub < 1.0))
              throw nb::value_error("blades have a count, a radius and a hub inside it");
            new (self) Shape;
            self->count = count;
            self->radius = radius;
            self->hub = hub;
            self->helix = helix;
            self->stations = static_cast<int>(n);
            for (std::size_t i = 0; i < n; ++i) {
              if (i > 0 && !(r(i) > r(i - 1))) throw nb::value_error("stations must increase");
              self->r[i] = r(i);
              self->chord[i] = chord(i);
              self->pitch[i] = pitch(i);
            }
          },
          nb::arg("count"), nb::arg("radius"), nb::arg("hub"), nb::arg("helix"), nb::arg("r"),
          nb::arg("chord"), nb::arg("pitch"),
          "count: of blades; radius: m; hub: where they begin, over the radius; helix: geometric\n"
          "pitch over the radius, 0: the stations' pitch (rad) counts; r, chord over the radius.")
      .def_ro("helix", &Shape::helix);

  m.def(
      "blade_integrals",
      [](const Shape& blade, double alpha_max, Vector J1, MatrixOut out) {
        check_out(out, J1.shape(0), 18);
        for (std::size_t i = 0; i < J1.shape(0); ++i) {
          const auto sum = alula::blade_integrals(blade, alpha_max, J1(i));
          for (std::size_t k = 0; k < 18; ++k) out(i, k) = sum.part[k / 3][k % 3];
        }
      },
      nb::arg("blade"), nb::arg("alpha_max"), nb::arg("J1"), nb::arg("out"),
      "Integrals of one blade at advance ratios of the disk: out (n, 18), the loads F_x, F_yV,\n"
      "F_yQ, M_x, M_yV, M_yQ, each with its parts of stalled lift, attached lift and drag.");

  m.def(
      "momentum_disk",
      [](const Shape& blade, double c_l_alpha, double alpha_max, double c_d_alpha, Vector J,
         MatrixOut out) {
        check_out(out, J.shape(0), 10);
        const alula::BladeAerodynamics<double> a{c_l_alpha, alpha_max, c_d_alpha};
        for (std::size_t i = 0; i < J.shape(0); ++i) {
          const auto s = alula::disk_of(blade, a, J(i));
          const double row[] = {s.J0, s.J1, s.ratio};
          for (std::size_t k = 0; k < 3; ++k) out(i, k) = row[k];
          for (std::size_t k = 0; k < alula::kHubLoads; ++k) out(i, 3 + k) = s.c.of[k];
          out(i, 9) = regime_of(s.regime);
        }
      },
      nb::arg("blade"), nb::arg("c_l_alpha"), nb::arg("alpha_max"), nb::arg("c_d_alpha"),
      nb::arg("J"), nb::arg("out"),
      "The momentum disk at advance ratios J = V/(n D): out (n, 10): J0, J1, w'/w, the six hub\n"
      "coefficients, the regime (0 inside, 1 standing, 2 reverse, 3 windmill, 4 unsolved).");

  m.def(
      "windmill_J",
      [](const Shape& blade, double c_l_alpha, double alpha_max, double c_d_alpha) {
        return alula::windmill_J(blade,
                                 alula::BladeAerodynamics<double>{c_l_alpha, alpha_max, c_d_alpha});
      },
      nb::arg("blade"), nb::arg("c_l_alpha"), nb::arg("alpha_max"), nb::arg("c_d_alpha"),
      "Advance ratio behind which the air drives the shaft; 0 without a solution.");

  using Table = alula::MomentumTable<double>;
  nb::class_<Table>(m, "MomentumTable", "The momentum disk tabulated for flight.")
      .def(
          "__init__",
          [](Table* self, const Shape& blade, double c_l_alpha, double alpha_max, double c_d_alpha,
             double sense) {
            new (self) Table;
            const alula::BladeAerodynamics<double> a{c_l_alpha, alpha_max, c_d_alpha};
            if (!alula::make_momentum_table(blade, a, sense, *self))
              throw nb::value_error("no solution from J = 0 to the windmill");
          },
          nb::arg("blade"), nb::arg("c_l_alpha"), nb::arg("alpha_max"), nb::arg("c_d_alpha"),
          nb::arg("sense"))
      .def_ro("last", &Table::last, "J at the windmill")
      .def(
          "loads",
          [](const Table& table, double omega, Vector v, Vector w, double density) {
            const auto l = alula::hub_loads(table, omega, vec3(v, "v: expected 3 components"),
                                            vec3(w, "w: expected 3 components"), density);
            return std::make_tuple(l.force.x, l.force.y, l.force.z, l.moment.x, l.moment.y,
                                   l.moment.z, l.torque, regime_of(l.regime));
          },
          nb::arg("omega"), nb::arg("v"), nb::arg("w"), nb::arg("density"),
          "Force (3), moment (3), shaft torque and regime at the hub; see hub_loads.");

  m.def(
      "blade_element_loads",
      [](const Shape& blade, const std::vector<PolarArgument>& polars, Vector axial_speed,
         Vector omega, double density, double viscosity, double sound, bool tip_loss, bool hub_loss,
         bool swirl, bool at_stations, MatrixOut out) {
        const std::size_t n = axial_speed.shape(0);
        if (omega.shape(0) != n) throw nb::value_error("omega: one value per axial_speed");
        if (polars.size() != 1 && polars.size() != static_cast<std::size_t>(blade.stations))
          throw nb::value_error("polars: one, or one per station");
        check_out(out, n, 3);
        std::vector<alula::SectionPolar<double>> sections;
        for (const PolarArgument& p : polars) sections.push_back(polar_of(p));
        for (std::size_t i = 0; i < n; ++i) {
          const alula::BladeElementCase<double> c{
              axial_speed(i),
              omega(i),
              density,
              viscosity,
              sound,
              tip_loss,
              hub_loss,
              swirl,
              at_stations ? alula::BladeRule::stations : alula::BladeRule::smooth};
          const auto l =
              alula::blade_loads(blade, sections.data(), static_cast<int>(sections.size()), c);
          out(i, 0) = l.thrust;
          out(i, 1) = l.torque;
          out(i, 2) = regime_of(l.regime);
        }
      },
      nb::arg("blade"), nb::arg("polars"), nb::arg("axial_speed"), nb::arg("omega"),
      nb::arg("density"), nb::arg("viscosity"), nb::arg("sound"), nb::arg("tip_loss"),
      nb::arg("hub_loss"), nb::arg("swirl"), nb::arg("at_stations"), nb::arg("out"),
      "Thrust N, shaft torque N m and regime (as momentum_disk) by blade elements: out (n, 3).");

  m.def(
      "slipstream",
      [](double axial_speed, double thrust, double torque, double density, double radius,
         double sense) {
        const auto s = alula::slipstream(axial_speed, thrust, torque, density, radius, sense);
        return std::make_tuple(s.u1, s.U_i, s.Omega_1, s.Omega_i, s.R_i, s.inside);
      },
      nb::arg("axial_speed"), nb::arg("thrust"), nb::arg("torque"), nb::arg("density"),
      nb::arg("radius"), nb::arg("sense"),
      "Speeds through the disk and far behind it (m/s), turning there (rad/s, along the thrust),\n"
      "radius far behind (m), whether the model holds.");
}
