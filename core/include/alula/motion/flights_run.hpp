#pragma once
// Several flights of one aircraft side by side, one in each lane: other starts, inputs, winds.
// Nothing is allocated; all arrays are the caller's.
#include "alula/motion/flight_run.hpp"

namespace alula {

// What is given for one flight of n samples, and where it is written: see FlightPlan, FlightRecord.
template <class T>
struct OneOfMany {
  const T* start = nullptr;     // (layout.size)
  const T* controls = nullptr;  // (n, 6)
  const T* gusts = nullptr;     // (n, 6); null: there are none
  Wind<T> wind{};               // `logarithmic` is the same for all
  FlightRecord<T> record{};
  int flown = 0;  // samples before the state stopped being finite; all where it never did
};

// Flies W flights at once through samples that are dt (s) apart. Each is flown as if it were alone:
// its numbers do not depend on the others, be they finite or not. Turbulence and pilots are not in.
template <int W, class T>
void fly_side_by_side(const AircraftModel<T>& a, int samples, int substeps, T dt, bool hold,
                      const std::array<OneOfMany<T>*, W>& flights) {
  using S = Lanes<T, W>;
  const auto of_each = [&flights](auto&& value) {
    return S::from([&](int w) { return value(*flights[static_cast<unsigned>(w)]); });
  };
  const auto vector_of_each = [&of_each](Vec3<T> Wind<T>::* v) {
    return Vec3<S>{of_each([v](const auto& f) { return (f.wind.*v).x; }),
                   of_each([v](const auto& f) { return (f.wind.*v).y; }),
                   of_each([v](const auto& f) { return (f.wind.*v).z; })};
  };
  Wind<S> wind;
  wind.steady = vector_of_each(&Wind<T>::steady);
  wind.shear = vector_of_each(&Wind<T>::shear);
  wind.reference_height = of_each([](const auto& f) { return f.wind.reference_height; });
  wind.logarithmic = flights[0]->wind.logarithmic;
  wind.roughness = of_each([](const auto& f) { return f.wind.roughness; });
  wind.ground = of_each([](const auto& f) { return f.wind.ground; });

  const int n = a.layout.size;
  const T h = dt / T(substeps);
  const auto input_at = [&](int sample, FlightInput<S>& u) {
    for (unsigned j = 0; j < 6; ++j) {
      const long at = static_cast<long>(sample) * 6 + j;
      u[j] = of_each([at](const auto& f) { return f.controls[at]; });
      u[kGustInput + j] =
          of_each([at](const auto& f) { return f.gusts == nullptr ? T(0) : f.gusts[at]; });
    }
  };
  FlightState<S> x, k;
  x.length = k.length = n;
  for (int j = 0; j < n; ++j) x[j] = of_each([j](const auto& f) { return f.start[j]; });
  bool flying[W];
  for (int w = 0; w < W; ++w) {
    flying[w] = true;
    flights[static_cast<unsigned>(w)]->flown = samples;
  }
  // Writes sample i of all that still fly; false where none does.
  const auto write = [&](int i, const FlightOutput<S>& y, const FlightInput<S>& u) {
    S total(T(0));
    for (int j = 0; j < n; ++j) total += x[j];
    bool some = false;
    for (int w = 0; w < W; ++w) {
      if (!flying[w]) continue;
      OneOfMany<T>& f = *flights[static_cast<unsigned>(w)];
      T* row = f.record.states + static_cast<long>(i) * n;
      for (int j = 0; j < n; ++j) row[j] = x[j][w];
      T* out = f.record.outputs + static_cast<long>(i) * kFlightOutputs;
      for (unsigned j = 0; j < kFlightOutputs; ++j) out[j] = y[j][w];
      T* in = f.record.inputs + static_cast<long>(i) * kFlightInputs;
      for (unsigned j = 0; j < kFlightInputs; ++j) in[j] = u[j][w];
      flying[w] = std::isfinite(total[w]);
      if (!flying[w]) f.flown = i;
      some = some || flying[w];
    }
    return some;
  };

  FlightInput<S> now, next, u0, mid, u1;
  FlightOutput<S> y;
  input_at(0, now);
  for (int i = 0; i < samples; ++i) {
    const bool last = i + 1 == samples;
    if (last || hold)
      next = now;
    else
      input_at(i + 1, next);
    for (int s = 0; s < substeps; ++s) {
      const T begin = T(s) / T(substeps), end = T(s + 1) / T(substeps);
      for (unsigned j = 0; j < kFlightInputs; ++j) {
        u0[j] = now[j] + begin * (next[j] - now[j]);
        u1[j] = now[j] + end * (next[j] - now[j]);
        mid[j] = T(0.5) * (u0[j] + u1[j]);
      }
      if (s > 0) {
        derivative_in(wind, x, u0, a, k);
      } else {
        derivative_and_outputs_in(wind, x, u0, a, k, y);
        if (!write(i, y, u0) || last) return;
      }
      int stage = 0;
      rk4_step_from(
          k,
          [&](T, const FlightState<S>& at, FlightState<S>& rate) {
            derivative_in(wind, at, ++stage < 3 ? mid : u1, a, rate);
          },
          T(0), h, x);
    }
    now = next;
    if (hold && !last) input_at(i + 1, now);
  }
}

}  // namespace alula
