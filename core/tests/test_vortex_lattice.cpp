// The lattice's exact derivatives against differences of whole solutions, and symmetry against
// none. The shapes of aircraft and the reference values are tested from Python.
#include <gtest/gtest.h>

#include <alula/host/vortex_lattice.hpp>

namespace {

using namespace alula::lattice;

Point unit(const Point& p) { return 1.0 / std::sqrt(dot(p, p)) * p; }

// A swept wing with dihedral of 2 rows of 3 panels a side, twisted and moved by one control, and a
// fin of 1 row of 2 in the plane of symmetry with another. symmetric: use is made of it.
Lattice aircraft(bool symmetric, double deflection = 0.0) {
  Lattice a;
  Points rate, rate_fin;
  const auto half = [&](int rows, int spans, bool fin, double side) {
    const auto place = [&](double chordwise, int k) {
      const double t = static_cast<double>(k) / spans, x = 0.3 * t + chordwise;
      if (fin) return Point{-3.0 - x, 0.0, -0.2 - t};
      return Point{-x, side * 2.5 * t, -0.2 * t};
    };
    const int strips = static_cast<int>(a.strip_first.size());
    for (int j = 0; j < rows; ++j) {
      const double c = 0.6 / rows, x0 = j * c;
      a.rows.push_back({spans, a.panels(), static_cast<int>(a.vertices.size()),
                        static_cast<int>(a.trailing.size()), fin ? 1 : 0});
      for (int i = 0; i <= spans; ++i)
        a.vertices.push_back(place(x0 + 0.25 * c, side > 0 ? i : spans - i));
      for (int i = 0; i < spans; ++i) {
        const int k = side > 0 ? i : spans - 1 - i;
        const Point p = place(x0 + 0.75 * c, k), q = place(x0 + 0.75 * c, k + 1);
        a.control.push_back(0.5 * (p + q));
        a.middle.push_back(0.5 * (place(x0 + 0.25 * c, k) + place(x0 + 0.25 * c, k + 1)));
        const double twist = fin ? 0.0 : 0.05 - 0.02 * k + 0.01 * j;
        const double turn = (fin ? 0.0 : 0.7 * deflection) + twist;
        const Point aft{-1.0, 0.0, 0.0}, up = unit(cross(aft, side * (q - p)));
        a.normal.push_back(std::cos(turn) * up + std::sin(turn) * aft);
        const Point by = std::cos(turn) * aft - std::sin(turn) * up;
        rate.push_back((fin ? 0.0 : 0.7) * by);
        rate_fin.push_back((fin ? 1.0 : 0.0) * by);
        a.strip.push_back(strips + i);
      }
    }
    for (int i = 0; i < spans; ++i) {
      const int k = side > 0 ? i : spans - 1 - i, step = side > 0 ? 0 : 1;
      a.strip_first.push_back(place(0.6, k + step));
      a.strip_last.push_back(place(0.6, k + 1 - step));
      a.strip_middle.push_back(0.5 * (a.strip_first.back() + a.strip_last.back()));
    }
    for (int i = 0; i <= spans; ++i) a.trailing.push_back(place(0.6, side > 0 ? i : spans - i));
  };
  half(2, 3, false, 1.0);
  half(1, 2, true, 1.0);
  half(2, 3, false, -1.0);
  a.normal_rate = {rate, rate_fin};
  a.parity = {1, -1};
  a.right = symmetric ? 6 : 0, a.center = symmetric ? 2 : 14;
  for (int j = 0; symmetric && j < 2; ++j)
    for (int k = 0; k < 3; ++k) a.mirror.push_back(8 + 3 * j + 2 - k);
  return a;
}

Condition condition(double mach, double core) {
  Condition at;
  at.alpha = 0.08, at.mach = mach, at.core = core;
  at.point = {-40.0, 0.0, 25.0};  // far away: what turns about it moves all
  at.S = 3.0, at.b = 5.0, at.c = 0.6;
  return at;
}

double largest(const Six& x) {
  double out = 0.0;
  for (double v : x) out = std::max(out, std::abs(v));
  return out;
}
Six minus(Six a, const Six& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

// Differences over 2 h are in error by h^2 and by rounding over h: both below 1e-7 of the largest.
void expect_near(const Six& got, const Six& after, const Six& before, double h, const char* what) {
  Six want = minus(after, before);
  for (double& v : want) v /= 2.0 * h;
  EXPECT_LT(largest(minus(got, want)), 1e-7 * (1.0 + largest(want))) << what;
}

class Derivatives : public ::testing::TestWithParam<std::tuple<double, double, double>> {};

TEST_P(Derivatives, AreThoseOfWholeSolutions) {
  const auto [mach, core, beta] = GetParam();
  Condition at = condition(mach, core);
  at.beta = beta;
  const bool symmetric = beta == 0.0;
  const Loads loads = solve(aircraft(symmetric), at);
  const double h = 1e-5;
  const auto moved = [&](auto&& move, double by) {
    Condition there = at;
    move(there, by);
    return solve(aircraft(false), there).coefficients;
  };
  const auto check = [&](int column, const char* what, auto&& move) {
    expect_near(loads.derivatives[column], moved(move, h), moved(move, -h), h, what);
  };
  check(0, "alpha", [](Condition& c, double x) { c.alpha += x; });
  check(1, "beta", [](Condition& c, double x) { c.beta += x; });
  check(2, "p", [](Condition& c, double x) { c.rate.x += x; });
  check(3, "q", [](Condition& c, double x) { c.rate.y += x; });
  check(4, "r", [](Condition& c, double x) { c.rate.z += x; });
  expect_near(loads.derivatives[5], solve(aircraft(symmetric, h), at).coefficients,
              solve(aircraft(symmetric, -h), at).coefficients, h, "control of the wing");
}

INSTANTIATE_TEST_SUITE_P(Conditions, Derivatives,
                         ::testing::Values(std::tuple(0.0, 0.0, 0.0), std::tuple(0.0, 0.0, 0.1),
                                           std::tuple(0.6, 0.0, 0.0), std::tuple(0.6, 0.1, 0.1),
                                           std::tuple(0.0, 0.1, 0.1)));

TEST(VortexLattice, HalvesGiveWhatTheWholeGives) {
  const Condition at = condition(0.4, 0.0);
  const Loads half = solve(aircraft(true), at), whole = solve(aircraft(false), at);
  double size = 0.0;
  for (const Six& column : whole.derivatives) size = std::max(size, largest(column));
  for (std::size_t k = 0; k < whole.derivatives.size(); ++k) {
    EXPECT_LT(largest(minus(half.derivatives[k], whole.derivatives[k])), 1e-12 * size);
    for (std::size_t i = 0; i < whole.circulation.size(); ++i)
      EXPECT_NEAR(half.circulation_rates[k][i], whole.circulation_rates[k][i], 1e-10);
  }
  EXPECT_LT(largest(minus(half.coefficients, whole.coefficients)), 1e-12);
  for (std::size_t i = 0; i < whole.force.size(); ++i) {
    const Point apart = half.force[i] - whole.force[i];
    EXPECT_LT(std::sqrt(dot(apart, apart)), 1e-12);
  }
  EXPECT_NEAR(half.wake.drag[0][0], whole.wake.drag[0][0], 1e-13);
}

TEST(VortexLattice, NoFlowThroughThePanels) {
  Condition at = condition(0.5, 0.0);
  at.beta = 0.05;
  const Lattice lattice = aircraft(false);
  const Loads loads = solve(lattice, at);
  const WindLattice wind = along_the_wind(lattice, at);
  const Points v =
      induced(lattice, wind, wind.control, lattice.panels(), {loads.circulation}).front();
  for (int i = 0; i < lattice.panels(); ++i)
    EXPECT_NEAR(dot(Point{1.0, 0.0, 0.0} + v[i], wind.normal[i]), 0.0, 1e-13);
}

// The integral of a vortex element along the line, by many short straight elements (Biot-Savart),
// legs cut where they matter no more.
TEST(VortexLattice, HorseshoeByBiotAndSavart) {
  Lattice one;
  one.rows = {{1, 0, 0, 0, 0}};
  one.vertices = {{0.0, -0.5, 0.0}, {-0.2, 0.7, 0.1}};
  one.trailing = one.vertices;
  for (Point& p : one.trailing) p.x -= 0.6;
  one.control = one.normal = one.middle = {{-1.2, 0.4, 0.3}};
  const WindLattice wind = along_the_wind(one, Condition{});
  const Point v = induced(one, wind, wind.control, 1, {{1.0}})[0][0];
  const Point P = wind.control[0], A = wind.vertices[0], B = wind.vertices[1];
  Point want;
  const auto line = [&](const Point& from, const Point& to, int parts) {
    for (int i = 0; i < parts; ++i) {
      const Point d = 1.0 / parts * (to - from), r = P - (from + (i + 0.5) * d);
      want = want + 0.25 * std::numbers::inv_pi / std::pow(dot(r, r), 1.5) * cross(d, r);
    }
  };
  const Point far{400.0, 0.0, 0.0};  // what lies behind adds 1e-6
  line(A + far, A, 400000), line(A, B, 2000), line(B, B + far, 400000);
  EXPECT_LT(std::sqrt(dot(v - want, v - want)), 3e-6);
}

}  // namespace
