// The lattice's exact derivatives against differences of whole solutions, and symmetry against
// none. The shapes of aircraft and the reference values are tested from Python.
#include <gtest/gtest.h>

#include <alula/host/vortex_lattice.hpp>

namespace {

using namespace alula::lattice;

// A swept wing with dihedral of 2 rows of 3 panels a side, twisted and moved by one control, and a
// fin of 1 row of 2 in the plane of symmetry with another. symmetric: use is made of it.
Lattice aircraft(bool symmetric, double deflection = 0.0) {
  Lattice a;
  std::vector<Vector3d> vertices, control, bound, wash, trailing, normal, rate, rate_fin, first,
      last;
  std::vector<int> strip, image;
  int surface = 0, strips = 0;
  const auto half = [&](int rows, int spans, bool fin, double side) {
    const auto place = [&](double chordwise, int k) {
      const double t = static_cast<double>(k) / spans, x = 0.3 * t + chordwise;
      if (fin) return Vector3d(-3.0 - x, 0.0, -0.2 - t);
      return Vector3d(-x, side * 2.5 * t, -0.2 * t);
    };
    if (strip.empty()) a.row_start.push_back(0);
    for (int j = 0; j < rows; ++j) {
      const double c = 0.6 / rows, x0 = j * c;
      for (int i = 0; i <= spans; ++i)
        vertices.push_back(place(x0 + 0.25 * c, side > 0 ? i : spans - i));
      for (int i = 0; i < spans; ++i) {
        const int k = side > 0 ? i : spans - 1 - i;
        const Vector3d p = place(x0 + 0.75 * c, k), q = place(x0 + 0.75 * c, k + 1);
        control.push_back(0.5 * (p + q));
        bound.push_back(0.5 * (place(x0 + 0.25 * c, k) + place(x0 + 0.25 * c, k + 1)));
        const Vector3d line = (side > 0 ? q - p : p - q).normalized();
        const double twist = fin ? 0.0 : 0.05 - 0.02 * k + 0.01 * j;
        const double turn = (fin ? 0.0 : 0.7 * deflection) + twist;
        const Vector3d up = Vector3d(-1, 0, 0).cross(line).normalized();
        normal.push_back(up * std::cos(turn) + Vector3d(-1, 0, 0) * std::sin(turn));
        const Vector3d by = -up * std::sin(turn) + Vector3d(-1, 0, 0) * std::cos(turn);
        rate.push_back(fin ? Vector3d::Zero().eval() : (0.7 * by).eval());
        rate_fin.push_back(fin ? by : Vector3d::Zero().eval());
        strip.push_back(strips + i);
      }
      a.row_start.push_back(static_cast<int>(vertices.size()));
      a.row_surface.push_back(surface);
      a.row_trailing.push_back(static_cast<int>(trailing.size()));
    }
    for (int i = 0; i < spans; ++i) {
      const int k = side > 0 ? i : spans - 1 - i, step = side > 0 ? 0 : 1;
      first.push_back(place(0.6, k + step)), last.push_back(place(0.6, k + 1 - step));
      wash.push_back(0.5 * (first.back() + last.back()));
    }
    for (int i = 0; i <= spans; ++i) trailing.push_back(place(0.6, side > 0 ? i : spans - i));
    strips += spans;
  };
  half(2, 3, false, 1.0);
  surface = 1, half(1, 2, true, 1.0);
  surface = 0, half(2, 3, false, -1.0);
  const auto points = [](const std::vector<Vector3d>& from) {
    Points out(3, static_cast<Eigen::Index>(from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = from[i];
    return out;
  };
  a.vertices = points(vertices), a.control = points(control), a.normal = points(normal);
  a.normal_rate = {points(rate), points(rate_fin)};
  a.parity = {1, -1};
  a.trailing = points(trailing);
  a.middle = points(bound), a.strip_middle = points(wash);
  a.strip = strip, a.strip_first = points(first), a.strip_last = points(last);
  a.right = symmetric ? 6 : 0, a.center = symmetric ? 2 : 14;
  for (int j = 0; symmetric && j < 2; ++j)
    for (int k = 0; k < 3; ++k) a.mirror.push_back(8 + 3 * j + 2 - k);
  return a;
}

Condition condition(double mach, double core) {
  Condition at;
  at.alpha = 0.08, at.mach = mach, at.core = core;
  at.point = Vector3d(-40.0, 0.0, 25.0);  // far away: what turns about it moves all
  at.S = 3.0, at.b = 5.0, at.c = 0.6;
  return at;
}

using Six = Eigen::Matrix<double, 6, 1>;

// Differences over 2 h are in error by h^2 and by rounding over h: both below 1e-7 of the largest.
void expect_near(const Six& got, const Six& plus, const Six& minus, double h, const char* what) {
  const Six want = (plus - minus) / (2.0 * h);
  EXPECT_LT((got - want).cwiseAbs().maxCoeff(), 1e-7 * (1.0 + want.cwiseAbs().maxCoeff())) << what;
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
    expect_near(loads.derivatives.col(column), moved(move, h), moved(move, -h), h, what);
  };
  check(0, "alpha", [](Condition& c, double x) { c.alpha += x; });
  check(1, "beta", [](Condition& c, double x) { c.beta += x; });
  check(2, "p", [](Condition& c, double x) { c.rate[0] += x; });
  check(3, "q", [](Condition& c, double x) { c.rate[1] += x; });
  check(4, "r", [](Condition& c, double x) { c.rate[2] += x; });
  expect_near(loads.derivatives.col(5), solve(aircraft(symmetric, h), at).coefficients,
              solve(aircraft(symmetric, -h), at).coefficients, h, "control of the wing");
}

INSTANTIATE_TEST_SUITE_P(Conditions, Derivatives,
                         ::testing::Values(std::tuple(0.0, 0.0, 0.0), std::tuple(0.0, 0.0, 0.1),
                                           std::tuple(0.6, 0.0, 0.0), std::tuple(0.6, 0.1, 0.1),
                                           std::tuple(0.0, 0.1, 0.1)));

TEST(VortexLattice, HalvesGiveWhatTheWholeGives) {
  const Condition at = condition(0.4, 0.0);
  const Loads half = solve(aircraft(true), at), whole = solve(aircraft(false), at);
  const double size = whole.derivatives.cwiseAbs().maxCoeff();
  EXPECT_LT((half.derivatives - whole.derivatives).cwiseAbs().maxCoeff(), 1e-12 * size);
  EXPECT_LT((half.coefficients - whole.coefficients).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((half.force - whole.force).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((half.circulation_rates - whole.circulation_rates).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_NEAR(half.wake.drag(0, 0), whole.wake.drag(0, 0), 1e-13);
}

TEST(VortexLattice, NoFlowThroughThePanels) {
  Condition at = condition(0.5, 0.0);
  at.beta = 0.05;
  const Lattice lattice = aircraft(false);
  const Loads loads = solve(lattice, at);
  const WindLattice wind = along_the_wind(lattice, at);
  const MatrixXd v = induced(lattice, wind, wind.control, lattice.panels(), loads.circulation);
  for (int i = 0; i < lattice.panels(); ++i) {
    const Vector3d flow = Vector3d::UnitX() + v.col(i);
    EXPECT_NEAR(flow.dot(wind.normal.col(i)), 0.0, 1e-13);
  }
}

// The integral of a vortex element along the line, by many short straight elements (Biot-Savart),
// legs cut where they matter no more.
TEST(VortexLattice, HorseshoeByBiotAndSavart) {
  Points point(3, 1);
  point.col(0) << -1.2, 0.4, 0.3;
  Lattice one;
  one.vertices.resize(3, 2);
  one.vertices.col(0) << 0.0, -0.5, 0.0;
  one.vertices.col(1) << -0.2, 0.7, 0.1;
  one.row_start = {0, 2}, one.row_surface = {0}, one.row_trailing = {0};
  one.trailing = one.vertices;
  one.trailing.row(0).array() -= 0.6;
  one.control = one.normal = one.middle = point;
  Condition at;
  const WindLattice wind = along_the_wind(one, at);
  const MatrixXd v = induced(one, wind, wind.control, 1, VectorXd::Ones(1));
  const Vector3d P = wind.control.col(0), A = wind.vertices.col(0), B = wind.vertices.col(1);
  Vector3d want = Vector3d::Zero();
  const auto line = [&](const Vector3d& from, const Vector3d& to, int parts) {
    for (int i = 0; i < parts; ++i) {
      const Vector3d d = (to - from) / parts, r = P - (from + (i + 0.5) * d);
      want += 0.25 * std::numbers::inv_pi * d.cross(r) / std::pow(r.norm(), 3);
    }
  };
  const Vector3d far(400.0, 0.0, 0.0);  // what lies behind adds 1e-6
  line(A + far, A, 400000), line(A, B, 2000), line(B, B + far, 400000);
  EXPECT_LT((v.col(0) - want).norm(), 3e-6);
}

}  // namespace
