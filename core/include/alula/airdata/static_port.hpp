#pragma once
// Static-pressure port that does not read the air's pressure.
#include <cmath>

namespace alula::airdata {

// What the port lacks: p_air = p_port + correction, correction = (rho/rho_0)(b U + c U^2), U the
// forward air-relative velocity (Pusztai 2018, Eq. 3.10, 3.11). b is the change of the port's
// pressure coefficient with Reynolds number.
template <class S>
struct StaticPort {
  S linear{};        // b, Pa s/m
  S quadratic{};     // c, Pa s2/m2
  S density{1.225};  // rho_0 of the calibration, kg/m3
  S fastest{1000};   // m/s, end of the calibration; beyond it the pressure coefficient is held
};

// Correction in Pa at forward speed U, m/s, and air density, kg/m3. Flow from behind is outside
// the calibration and gets none.
template <class S>
S static_pressure_correction(const StaticPort<S>& port, S U, S density) {
  if (!(U > S(0))) return U <= S(0) ? S(0) : U;  // NaN stays NaN
  const S within = U < port.fastest ? U : port.fastest;
  return density / port.density * (port.linear / within + port.quadratic) * U * U;
}

}  // namespace alula::airdata
