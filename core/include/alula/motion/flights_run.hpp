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

template <class T, int W>
void set_lane(Vec3<Lanes<T, W>>& v, int w, const Vec3<T>& one) {
  v.x.set(w, one.x);
  v.y.set(w, one.y);
  v.z.set(w, one.z);
}

// Flies W flights at once through samples that are dt (s) apart. Each is flown as if it were alone:
// its numbers do not depend on the others, be they finite or not. Turbulence and pilots are not in.
template <int W, class T>
void fly_side_by_side(const AircraftModel<T>& a, int samples, int substeps, T dt, bool hold,
                      const std::array<OneOfMany<T>*, W>& flights) {
  using S = Lanes<T, W>;
  const int n = a.layout.size;
  const T h = dt / T(substeps);
  FlightState<S> x, k;
  x.length = k.length = n;
  Wind<S> wind;
  wind.logarithmic = flights[0]->wind.logarithmic;
  bool flying[W];
  for (int w = 0; w < W; ++w) {
    OneOfMany<T>& f = *flights[static_cast<unsigned>(w)];
    for (int j = 0; j < n; ++j) x[j].set(w, f.start[j]);
    set_lane(wind.steady, w, f.wind.steady);
    set_lane(wind.shear, w, f.wind.shear);
    wind.reference_height.set(w, f.wind.reference_height);
    wind.roughness.set(w, f.wind.roughness);
    wind.ground.set(w, f.wind.ground);
    flying[w] = true;
    f.flown = samples;
  }
  const auto input_at = [&flights](int sample, FlightInput<S>& u) {
    const long row = static_cast<long>(sample) * 6;
    for (int w = 0; w < W; ++w) {
      const OneOfMany<T>& f = *flights[static_cast<unsigned>(w)];
      for (unsigned j = 0; j < 6; ++j) {
        u[j].set(w, f.controls[row + j]);
        u[kGustInput + j].set(w, f.gusts == nullptr ? T(0) : f.gusts[row + j]);
      }
    }
  };
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

  FlightInput<S> now{}, next{}, u0, mid, u1;
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
