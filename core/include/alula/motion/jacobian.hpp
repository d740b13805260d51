#pragma once
// Exact linearization about any point, steady or not: dual numbers in chunks of eight directions.
#include "alula/math/dual.hpp"
#include "alula/motion/aircraft.hpp"

namespace alula {

// A = df/dx (n x n), B = df/du (n x 12), C = dy/dx (24 x n), D = dy/du (24 x 12), row by row, into
// storage of the caller. n: the number of states.
template <class T>
void jacobian(const FlightState<T>& x, const FlightInput<T>& u, const AircraftModel<T>& params,
              T* A, T* B, T* C, T* D) {
  constexpr int kWidth = 8;
  using S = Dual<T, kWidth>;
  const int n = params.layout.size, all = n + kFlightInputs;
  FlightState<S> xd, rate;
  FlightInput<S> ud;
  FlightOutput<S> y;
  xd.length = n;
  for (int first = 0; first < all; first += kWidth) {
    for (int i = 0; i < n; ++i) xd[i] = S(x[i]);
    for (int i = 0; i < kFlightInputs; ++i)
      ud[static_cast<unsigned>(i)] = S(u[static_cast<unsigned>(i)]);
    for (int j = first; j < first + kWidth && j < all; ++j)
      (j < n ? xd[j] : ud[static_cast<unsigned>(j - n)]).set_slope(j - first, T(1));
    derivative_and_outputs(xd, ud, params, rate, y);
    for (int j = first; j < first + kWidth && j < all; ++j) {
      const int width = j < n ? n : kFlightInputs, column = j < n ? j : j - n;
      T* states = j < n ? A : B;
      T* outputs = j < n ? C : D;
      for (int i = 0; i < n; ++i) states[i * width + column] = rate[i].slope_of(j - first);
      for (int i = 0; i < kFlightOutputs; ++i)
        outputs[i * width + column] = y[static_cast<unsigned>(i)].slope_of(j - first);
    }
  }
}

}  // namespace alula
