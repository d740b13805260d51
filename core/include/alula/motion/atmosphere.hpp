#pragma once
// U.S. Standard Atmosphere 1976 (NOAA-S/T 76-1562), up to 86 km.
#include <cmath>

#include "alula/math/dual.hpp"

namespace alula {

template <class S>
struct Air {
  S temperature;     // K (molecular scale: the kinetic one is up to 0.05 % lower above 80 km)
  S pressure;        // Pa
  S density;         // kg/m3
  S speed_of_sound;  // m/s
};

namespace standard_atmosphere_1976 {
inline constexpr double kGravity = 9.80665;                // m/s2
inline constexpr double kEarthRadius = 6356766.0;          // m, for the geopotential height
inline constexpr double kGasConstant = 8314.32 / 28.9644;  // J/(kg K), R* over M0
inline constexpr double kHeatRatio = 1.4;

struct Layer {
  double base;         // m, geopotential
  double temperature;  // K at the base
  double lapse;        // K/m
  double pressure;     // Pa at the base, continued from the layer below
  // Pressure is that at the base times (T/T base)^power e^(decay above), one of them zero.
  constexpr double power() const { return lapse == 0.0 ? 0.0 : -kGravity / (kGasConstant * lapse); }
  constexpr double decay() const {
    return lapse == 0.0 ? -kGravity / (kGasConstant * temperature) : 0.0;
  }
};
inline constexpr int kLayers = 7;
inline constexpr Layer kLayer[kLayers] = {
    {0.0, 288.15, -0.0065, 101325.0},
    {11000.0, 216.65, 0.0, 22632.063973462922},
    {20000.0, 216.65, 0.001, 5474.888669677776},
    {32000.0, 228.65, 0.0028, 868.0186847552286},
    {47000.0, 270.65, 0.0, 110.90630555496602},
    {51000.0, 270.65, -0.0028, 66.93887311868734},
    {71000.0, 214.65, -0.002, 3.9564204280407314},
};
}  // namespace standard_atmosphere_1976

// Geopotential height of a geometric height, m (1976 standard, Eq. 18).
template <class S>
constexpr S geopotential_height(const S& h) {
  const S r(standard_atmosphere_1976::kEarthRadius);
  return r * h / (r + h);
}

// Air at geometric height h, m. The standard covers -5 to 86 km; outside, the nearest layer is
// continued.
template <class S>
Air<S> standard_atmosphere(const S& h) {
  using namespace standard_atmosphere_1976;
  using std::exp;
  using std::log;
  using std::sqrt;
  const S height = geopotential_height(h);
  // Layer by layer, all of them only for what flies that high.
  struct {
    S base, temperature, lapse, inverse, power, decay, pressure;
  } at{S(kLayer[0].base),    S(kLayer[0].temperature),
       S(kLayer[0].lapse),   S(1.0 / kLayer[0].temperature),
       S(kLayer[0].power()), S(kLayer[0].decay()),
       S(kLayer[0].pressure)};
  for (int i = 1; i < kLayers; ++i) {
    const Layer& next = kLayer[i];
    const auto higher = height > S(next.base);
    if (!any(higher)) break;
    at.base = select(higher, S(next.base), at.base);
    at.temperature = select(higher, S(next.temperature), at.temperature);
    at.lapse = select(higher, S(next.lapse), at.lapse);
    at.inverse = select(higher, S(1.0 / next.temperature), at.inverse);
    at.power = select(higher, S(next.power()), at.power);
    at.decay = select(higher, S(next.decay()), at.decay);
    at.pressure = select(higher, S(next.pressure), at.pressure);
  }
  const S above = height - at.base;
  Air<S> air;
  air.temperature = at.temperature + at.lapse * above;
  const S exponent = at.power * log(air.temperature * at.inverse) + at.decay * above;
  air.pressure = at.pressure * exp(exponent);
  air.density = air.pressure / (S(kGasConstant) * air.temperature);
  air.speed_of_sound = sqrt(S(kHeatRatio * kGasConstant) * air.temperature);
  return air;
}

}  // namespace alula
