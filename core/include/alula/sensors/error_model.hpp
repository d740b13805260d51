#pragma once
// How a sensor falsifies what it measures: scale error, bias, white noise, quantization.
#include <cmath>

namespace alula {

template <class T>
struct SensorError {
  T scale{0};  // relative: 0.01 reads one percent too much
  T bias{0};   // in the sensor's unit
  T sigma{0};  // standard deviation of the white noise per sample
  T step{0};   // quantization; 0: none
};

// The reading for a true value; `normal` is a standard normal number drawn by the caller.
template <class T>
T reading(const SensorError<T>& error, T truth, T normal) {
  const T value = (T(1) + error.scale) * truth + error.bias + error.sigma * normal;
  return error.step > T(0) ? error.step * std::nearbyint(value / error.step) : value;
}

}  // namespace alula
