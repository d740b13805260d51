// The vortex lattice, and its factorization alone for benchmarks.
#include <alula/host/vortex_lattice.hpp>
#include <ctime>
#include <random>

#include "arrays.hpp"
#include "bind.hpp"

namespace {

using namespace alula::lattice;
using Result = nb::typed<nb::dict, nb::str, nb::any>;
using Integers = nb::ndarray<const std::int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

Points points(const double* from, std::size_t count) {
  Points out;
  for (std::size_t i = 0; i < count; ++i, from += 3) out.push_back({from[0], from[1], from[2]});
  return out;
}

Points points(Matrix from, std::size_t rows, const char* what) {
  if (from.shape(0) != rows || from.shape(1) != 3) throw nb::value_error(what);
  return points(from.data(), rows);
}

std::vector<int> integers(Integers from, std::size_t size, int below, const char* what) {
  std::vector<int> out(from.data(), from.data() + from.shape(0));
  bool good = out.size() == size;
  for (int i : out) good = good && i >= 0 && i < below;
  if (!good) throw nb::value_error(what);
  return out;
}

// (columns, rows) of what is held by columns.
template <class Columns>
auto array(const Columns& columns) {
  const std::size_t n = columns.empty() ? 0 : columns.front().size();
  Array<double> out({static_cast<int>(columns.size()), static_cast<int>(n)});
  double* to = out.data();
  for (const auto& column : columns) to = std::copy(column.begin(), column.end(), to);
  return out.numpy();
}

auto array(const Points& points) {
  Array<double> out({static_cast<int>(points.size()), 3});
  double* to = out.data();
  for (const Point& p : points) *to++ = p.x, *to++ = p.y, *to++ = p.z;
  return out.numpy();
}

// An attribute of the panels that Python made. Raises AttributeError, RuntimeError (another type).
template <class A>
A part(nb::handle panels, const char* name) {
  return nb::cast<A>(panels.attr(name));
}

Lattice lattice(nb::handle panels) {
  Lattice a;
  const auto control = part<Matrix>(panels, "control"), trailing = part<Matrix>(panels, "trailing"),
             strip_first = part<Matrix>(panels, "strip_first");
  const auto row_surface = part<Integers>(panels, "row_surface");
  const auto normal_rate = part<Cube>(panels, "normal_rate");
  const auto parity = part<Vector>(panels, "parity");
  const int right = part<int>(panels, "right"), center = part<int>(panels, "center");
  const std::size_t n = control.shape(0), strips = strip_first.shape(0);
  if (n < 1 || n > static_cast<std::size_t>(kMaxPanels))
    throw nb::value_error("panels: none, or more than LATTICE_PANELS");
  if (right < 0 || center < 0 || static_cast<std::size_t>(2 * right + center) != n)
    throw nb::value_error("right, center: 2 right + center must be the panels");
  const std::size_t rows = row_surface.shape(0);
  a.vertices =
      points(part<Matrix>(panels, "vertices"), n + rows, "vertices: expected (panels + rows, 3)");
  const auto start = integers(part<Integers>(panels, "row_start"), rows + 1,
                              static_cast<int>(n + rows) + 1, "row_start");
  for (std::size_t r = 0; r < rows; ++r)
    if (start[r] + 2 > start[r + 1]) throw nb::value_error("row_start: an empty row");
  if (start[0] != 0 || start[rows] != static_cast<int>(n + rows))
    throw nb::value_error("row_start: the rows must hold all vertices");
  const auto of = integers(row_surface, rows, static_cast<int>(rows), "row_surface");
  const int edges = static_cast<int>(trailing.shape(0));
  a.trailing = points(trailing, trailing.shape(0), "trailing: expected (edges, 3)");
  const auto edge = integers(part<Integers>(panels, "row_trailing"), rows, edges, "row_trailing");
  for (int r = 0; r < static_cast<int>(rows); ++r) {
    a.rows.push_back({start[r + 1] - start[r] - 1, start[r] - r, start[r], edge[r], of[r]});
    if (edge[r] + start[r + 1] - start[r] > edges)
      throw nb::value_error("row_trailing: a row beyond the last edge");
  }
  a.control = points(control, n, "control: expected (panels, 3)");
  a.middle = points(part<Matrix>(panels, "middle"), n, "middle: expected (panels, 3)");
  a.normal = points(part<Matrix>(panels, "normal"), n, "normal: expected (panels, 3)");
  if (normal_rate.shape(1) != n || normal_rate.shape(2) != 3 ||
      parity.shape(0) != normal_rate.shape(0))
    throw nb::value_error("normal_rate, parity: expected (controls, panels, 3) and (controls,)");
  for (std::size_t k = 0; k < normal_rate.shape(0); ++k) {
    a.normal_rate.push_back(points(normal_rate.data() + 3 * n * k, n));
    a.parity.push_back(parity(k) < 0.0 ? -1 : 1);
  }
  a.right = right, a.center = center;
  a.mirror = integers(part<Integers>(panels, "mirror"), static_cast<std::size_t>(right),
                      static_cast<int>(n), "mirror");
  for (int i : a.mirror)
    if (i < a.solved()) throw nb::value_error("mirror: images must follow the solved panels");
  a.strip = integers(part<Integers>(panels, "strip"), n, static_cast<int>(strips), "strip");
  a.strip_first = points(strip_first, strips, "strip_first: expected (strips, 3)");
  a.strip_last =
      points(part<Matrix>(panels, "strip_last"), strips, "strip_last: expected (strips, 3)");
  a.strip_middle =
      points(part<Matrix>(panels, "strip_wash"), strips, "strip_wash: expected (strips, 3)");
  return a;
}

Result vortex_lattice(nb::object panels, double alpha, double beta, double mach, Vector rate,
                      Vector point, Vector reference, double core, bool turning) {
  const Lattice a = lattice(panels);
  Condition at;
  const Point sizes = vec3(reference, "reference: expected S, b, c");
  at.alpha = alpha, at.beta = beta, at.mach = mach, at.core = core, at.turning = turning;
  at.rate = vec3(rate, "rate: expected phat, qhat, rhat");
  at.point = vec3(point, "point: expected 3 numbers");
  at.S = sizes.x, at.b = sizes.y, at.c = sizes.z;
  if (!(mach >= 0.0 && mach < 1.0)) throw nb::value_error("mach: expected 0 to below 1");
  Loads loads;
  {
    nb::gil_scoped_release release;
    loads = solve(a, at);
  }
  Result out;
  out["circulation"] = array(Columns{loads.circulation});
  out["circulation_rates"] = array(loads.circulation_rates);
  out["force"] = array(loads.force);
  out["coefficients"] = array(std::vector{loads.coefficients});
  out["derivatives"] = array(loads.derivatives);
  out["strip_circulation"] = array(loads.wake.circulation);
  out["strip_wash"] = array(loads.wake.wash);
  out["wake_drag"] = array(loads.wake.drag);
  return out;
}

// Processor time of the factorization alone of a full matrix, as the lattice does it.
double factor_time(int n) {
  if (n < 1 || n > kMaxPanels) throw nb::value_error("n: expected 1 to LATTICE_PANELS");
  nb::gil_scoped_release release;
  std::minstd_rand random;
  Eigen::MatrixXd A(n, n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) A(i, j) = 1e-9 * random() + (i == j ? n : 0);
  const std::clock_t begin = std::clock();
  const Factorized lu(A);
  const std::clock_t end = std::clock();
  return static_cast<double>(end - begin) / CLOCKS_PER_SEC;
}

}  // namespace

void bind_vortex_lattice(nb::module_& m) {
  m.attr("LATTICE_PANELS") = kMaxPanels;
  m.def("vortex_lattice", &vortex_lattice, nb::arg("panels"), nb::arg("alpha"), nb::arg("beta"),
        nb::arg("mach"), nb::arg("rate"), nb::arg("point"), nb::arg("reference"), nb::arg("core"),
        nb::arg("turning"),
        "Loads of a lattice (alula.predict.panels.Panels) and their derivatives to alpha, "
        "beta, phat, qhat, rhat and controls, body axes; see "
        "core/host/include/alula/host/vortex_lattice.hpp.");
  m.def("lattice_factor_time", &factor_time, nb::arg("n"),
        "Processor time (s) of the factorization alone of a full matrix of order n.");
}
