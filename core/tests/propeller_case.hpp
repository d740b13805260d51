#pragma once
// A two-blade propeller for the tests: tapering blades, a helix of 20 by 12 inches.
#include "alula/propulsion/momentum_propeller.hpp"

namespace alula_test {

template <class T>
alula::BladeShape<T> test_blades() {
  alula::BladeShape<T> b;
  b.count = 2;
  b.radius = T(0.254);
  b.hub = T(0.15);
  b.helix = T(1.2);
  b.stations = 6;
  const T r[] = {T(0.15), T(0.3), T(0.5), T(0.7), T(0.9), T(1.0)};
  const T chord[] = {T(0.1), T(0.15), T(0.16), T(0.13), T(0.09), T(0.04)};
  for (unsigned i = 0; i < 6; ++i) {
    b.r[i] = r[i];
    b.chord[i] = chord[i];
    b.pitch[i] = std::atan2(b.helix, T(6.283185307179586) * r[i]);
  }
  return b;
}

// Stalled inside a third of the radius at rest.
template <class T>
alula::BladeAerodynamics<T> test_sections() {
  return {T(5.2), T(0.25), T(1.1)};
}

}  // namespace alula_test
