#pragma once
// How a sensor falsifies what it measures: lag, scale error, bias, white noise, quantization, and
// readings that stay away or stand still.
#include <cmath>

namespace alula {

template <class T>
struct SensorError {
  T scale{0};  // relative: 0.01 reads one percent too much
  T bias{0};   // in the sensor's unit
  T sigma{0};  // standard deviation of the white noise per sample
  T step{0};   // quantization; 0: none
  // The rest needs a SensorMemory.
  T lag{0};             // s, first order, before all else
  T dropout_rate{0};    // dropouts that begin in a second
  T dropout_length{0};  // s, mean length of a dropout; 0: one sample
  T stuck_from{0};      // s: from here ...
  T stuck_until{0};     // ... to here the last reading is repeated; not above stuck_from: never
};

// The reading for a true value; `normal` is a standard normal number drawn by the caller. Without
// what needs a memory.
template <class T>
T reading(const SensorError<T>& error, T truth, T normal) {
  const T value = (T(1) + error.scale) * truth + error.bias + error.sigma * normal;
  return error.step > T(0) ? error.step * std::nearbyint(value / error.step) : value;
}

// What a sensor carries from sample to sample.
template <class T>
struct SensorMemory {
  T t{0};       // s, of the last sample
  T truth{0};   // then
  T lagged{0};  // then
  T last{0};    // the last reading that was there
  bool started = false;
  bool dropped = false;
};

template <class T>
struct Reading {
  T value;       // the last one that was there where `present` is false
  bool present;  // false in a dropout
};

// The reading at time t (s, increasing from call to call). truth is taken as a straight line since
// the last sample, for which the lag is exact; the first sample has none. Length of and time
// between dropouts are exponential (a chain of two states). normal: standard normal; uniform: in
// [0, 1); both are used up whether they are needed or not, so that one sensor's settings do not
// change another one's noise.
template <class T>
Reading<T> sense(const SensorError<T>& error, SensorMemory<T>& memory, T t, T truth, T normal,
                 T uniform) {
  const T dt = memory.started ? t - memory.t : T(0);
  T lagged = truth;
  if (memory.started && error.lag > T(0) && dt > T(0)) {
    const T gone = -std::expm1(-dt / error.lag);
    const T slope = (truth - memory.truth) / dt;
    lagged =
        memory.lagged + gone * (memory.truth - memory.lagged) + slope * (dt - error.lag * gone);
  }
  const bool stuck = memory.started && t >= error.stuck_from && t < error.stuck_until;
  const T value = stuck ? memory.last : reading(error, lagged, normal);
  if (error.dropout_rate > T(0)) {
    const bool ends =
        !(error.dropout_length > T(0)) || uniform < -std::expm1(-dt / error.dropout_length);
    const bool begins = uniform < -std::expm1(-error.dropout_rate * dt);
    memory.dropped = memory.dropped ? !ends : begins;
  }
  memory.t = t;
  memory.truth = truth;
  memory.lagged = lagged;
  memory.started = true;
  if (!memory.dropped) memory.last = value;
  return {memory.last, !memory.dropped};
}

}  // namespace alula
