#pragma once
// A whole flight: the equations of motion stepped through controls, gusts, turbulence and a pilot.
// Nothing is allocated; all arrays are the caller's.
#include <cmath>

#include "alula/math/rk4.hpp"
#include "alula/motion/dryden.hpp"
#include "alula/motion/pilot.hpp"

namespace alula {

// What is given for n samples, dt (s) apart, rows one after the other. Null: there is none.
template <class T>
struct FlightPlan {
  int samples = 0;
  int substeps = 1;  // integration steps per sample
  T dt{0};
  const T* controls = nullptr;            // (n, 6): de da dr df dt thrust
  const T* gusts = nullptr;               // (n, 6): ug vg wg pg qg rg, body axes
  bool hold = false;                      // inputs stay until the next sample; else straight lines
  const Dryden<T>* turbulence = nullptr;  // added to the gusts
  const T* normals = nullptr;  // ((n - 1) substeps + 1, kDrydenNormals): standard normal numbers
  const Pilot<T>* pilot = nullptr;
  const T* references = nullptr;          // (n, 10): what the pilot wants to see
  const unsigned char* active = nullptr;  // (n): whether he steers from this sample to the next
};

// What is written for each sample: states (n, layout.size), outputs (n, 24), inputs (n, 12), the
// pilot's share and the turbulence in them.
template <class T>
struct FlightRecord {
  T *states = nullptr, *outputs = nullptr, *inputs = nullptr;
};

// Turbulence around the aircraft from one integration step to the next, body axes: ug vg wg pg qg
// rg.
template <class T>
struct Eddies {
  DrydenFilter<T> filter{};
  DrydenState<T> state{};
  bool started = false;

  std::array<T, 6> advance(const Dryden<T>& dryden, const AircraftModel<T>& a,
                           const FlightState<T>& x, T dt, const T* normals) {
    const Place<T> at = place(x, a.earth, a.gravity);
    const Vec3<T> v = Vec3<T>{x[7], x[8], x[9]} - at.R_BN * wind_at(a.wind, at.height);
    const T V = std::sqrt(dot(v, v)), height = at.height - a.wind.ground;
    dryden_refresh(dryden, V, height, dt, filter);
    if (started)
      dryden_step(filter, normals, state);
    else
      state = dryden_start(dryden, V, height, normals);
    started = true;
    const auto gust = turbulence_in_body(turbulence(filter, state), at.R_BN, v, height);
    return {gust.velocity.x, gust.velocity.y, gust.velocity.z,
            gust.rates.x,    gust.rates.y,    gust.rates.z};
  }
};

// Flies from x and returns the number of samples before the state stopped being finite; all of
// them where it never did. The pilot looks once per integration step. Turbulence is a straight
// line between integration steps.
template <class T>
int fly(const AircraftModel<T>& a, FlightState<T> x, const FlightPlan<T>& plan,
        const FlightRecord<T>& record) {
  const int n = a.layout.size;
  const T h = plan.dt / T(plan.substeps);
  const auto input_at = [&plan](int sample, FlightInput<T>& u) {
    const T* row = plan.controls + static_cast<long>(sample) * kGustInput;
    for (unsigned j = 0; j < kGustInput; ++j) u[j] = row[j];
    const T* gust = plan.gusts == nullptr ? nullptr : plan.gusts + static_cast<long>(sample) * 6;
    for (unsigned j = 0; j < 6; ++j) u[kGustInput + j] = gust == nullptr ? T(0) : gust[j];
  };
  Eddies<T> eddies;
  std::array<T, 6> air{}, air_next{};
  if (plan.turbulence != nullptr) air = eddies.advance(*plan.turbulence, a, x, h, plan.normals);

  FlightInput<T> now, next, u0, mid, u1;
  FlightState<T> k;
  FlightOutput<T> y;
  input_at(0, now);
  for (int i = 0; i < plan.samples; ++i) {
    const bool last = i + 1 == plan.samples;
    if (last || plan.hold)
      next = now;
    else
      input_at(i + 1, next);
    const bool steered = plan.pilot != nullptr && plan.active[i] != 0;
    for (int s = 0; s < plan.substeps; ++s) {
      const T begin = T(s) / T(plan.substeps), end = T(s + 1) / T(plan.substeps);
      for (unsigned j = 0; j < kFlightInputs; ++j) {
        u0[j] = now[j] + begin * (next[j] - now[j]);
        u1[j] = now[j] + end * (next[j] - now[j]);
      }
      if (plan.turbulence != nullptr) {
        const long step = static_cast<long>(i) * plan.substeps + s + 1;
        air_next =
            last ? air
                 : eddies.advance(*plan.turbulence, a, x, h, plan.normals + step * kDrydenNormals);
        for (unsigned j = 0; j < 6; ++j) {
          u0[kGustInput + j] += air[j];
          u1[kGustInput + j] += air_next[j];
        }
        air = air_next;
      }
      if (steered) {
        const auto seen = sight(x, u0, a);
        const T* reference = plan.references + static_cast<long>(i) * kSights;
        steer(*plan.pilot, seen, reference, u0);
        steer(*plan.pilot, seen, reference, u1);
      }
      if (s > 0) {
        derivative(T(0), x, u0, a, k);
      } else {
        derivative_and_outputs(x, u0, a, k, y);
        T total(0);
        T* row = record.states + static_cast<long>(i) * n;
        for (int j = 0; j < n; ++j) total += row[j] = x[j];
        T* out = record.outputs + static_cast<long>(i) * kFlightOutputs;
        for (unsigned j = 0; j < kFlightOutputs; ++j) out[j] = y[j];
        T* in = record.inputs + static_cast<long>(i) * kFlightInputs;
        for (unsigned j = 0; j < kFlightInputs; ++j) in[j] = u0[j];
        if (!std::isfinite(total)) return i;
        if (last) return plan.samples;
      }
      for (unsigned j = 0; j < kFlightInputs; ++j) mid[j] = T(0.5) * (u0[j] + u1[j]);
      int stage = 0;
      rk4_step_from(
          k,
          [&](T t, const FlightState<T>& at, FlightState<T>& rate) {
            derivative(t, at, ++stage < 3 ? mid : u1, a, rate);
          },
          T(0), h, x);
    }
    now = next;
    if (plan.hold && !last) input_at(i + 1, now);
  }
  return plan.samples;
}

}  // namespace alula
