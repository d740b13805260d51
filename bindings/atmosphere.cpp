// The standard atmosphere over arrays of heights.
#include "alula/motion/atmosphere.hpp"

#include "bind.hpp"

void bind_atmosphere(nb::module_& m) {
  m.def(
      "standard_atmosphere",
      [](Vector h, MatrixOut out) {
        if (out.shape(0) != h.shape(0) || out.shape(1) != 4)
          throw nb::value_error("out: expected shape (n, 4)");
        for (std::size_t i = 0; i < h.shape(0); ++i) {
          const alula::Air<double> air = alula::standard_atmosphere(h(i));
          out(i, 0) = air.temperature;
          out(i, 1) = air.pressure;
          out(i, 2) = air.density;
          out(i, 3) = air.speed_of_sound;
        }
      },
      nb::arg("h"), nb::arg("out"),
      "Temperature (K), pressure (Pa), density (kg/m3) and speed of sound (m/s) of the 1976\n"
      "standard atmosphere at geometric heights h (m), written to out (n, 4).");
}
