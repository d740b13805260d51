#pragma once
// What every binding file shares: the array types and the list of subjects.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "alula/math/vec3.hpp"

namespace nb = nanobind;

// Contiguous double arrays on the CPU; Python callers convert, nothing is copied here.
using Vector = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Matrix = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using VectorOut = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using MatrixOut = nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Cube = nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using CubeOut = nb::ndarray<double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

inline void check(bool good, const char* what) {
  if (!good) throw nb::value_error(what);
}

inline alula::Vec3<double> vec3(Vector a, const char* what) {
  check(a.shape(0) == 3, what);
  return {a(0), a(1), a(2)};
}

void bind_path(nb::module_& m);
void bind_linear_filter(nb::module_& m);
void bind_processor(nb::module_& m);
void bind_aero(nb::module_& m);
void bind_atmosphere(nb::module_& m);
void bind_airdata(nb::module_& m);
void bind_simulate(nb::module_& m);
void bind_aircraft(nb::module_& m);
void bind_recursive(nb::module_& m);
void bind_output_error(nb::module_& m);
void bind_asse(nb::module_& m);
void bind_navigate(nb::module_& m);
void bind_navigate_tools(nb::module_& m);
void bind_vortex_lattice(nb::module_& m);
void bind_propellers(nb::module_& m);
void bind_strip(nb::module_& m);
