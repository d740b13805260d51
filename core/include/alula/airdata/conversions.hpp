#pragma once
// Airspeeds, Mach number and altitudes from pressures, compressible and subsonic.
//
// Isentropic flow of a perfect gas with a heat ratio of 1.4 (NACA Report 837; U.S. Standard
// Atmosphere 1976). Impact pressure is the total less the static pressure. Written with expm1 and
// log1p: at 20 m/s the quotient of pressures is 1.002, and the plain powers would leave float with
// four digits. An argument outside the stated domain, NaN included, gives NaN and nothing else.
#include <cmath>
#include <limits>

#include "alula/motion/atmosphere.hpp"

namespace alula::airdata {

inline constexpr double kSeaLevelPressure = standard_atmosphere_1976::kLayer[0].pressure;
inline constexpr double kSeaLevelTemperature = standard_atmosphere_1976::kLayer[0].temperature;
inline constexpr double kSeaLevelDensity =
    kSeaLevelPressure / (standard_atmosphere_1976::kGasConstant * kSeaLevelTemperature);
inline constexpr double kSeaLevelSound = 340.29410778693529;  // m/s, sqrt(1.4 R T) of the above

template <class S>
constexpr S undefined() {
  return std::numeric_limits<S>::quiet_NaN();
}

// Impact pressure over static pressure at a Mach number of 0 to 1.
template <class S>
S impact_ratio(S mach) {
  if (!(mach >= S(0) && mach <= S(1))) return undefined<S>();
  return std::expm1(S(3.5) * std::log1p(S(0.2) * mach * mach));
}

// Mach number of impact pressure over static pressure, 0 to 0.893 (Mach 1).
template <class S>
S mach_of(S ratio) {
  if (!(ratio >= S(0) && ratio <= S(0.8929292))) return undefined<S>();
  return std::sqrt(S(5) * std::expm1(std::log1p(ratio) / S(3.5)));
}

// Impact pressure, Pa, that a calibrated airspeed, m/s, stands for: the standard's sea level.
template <class S>
S impact_of_cas(S cas) {
  return S(kSeaLevelPressure) * impact_ratio(cas / S(kSeaLevelSound));
}

// Calibrated airspeed, m/s, of an impact pressure, Pa.
template <class S>
S cas_of_impact(S impact) {
  return S(kSeaLevelSound) * mach_of(impact / S(kSeaLevelPressure));
}

// Mach number of a calibrated airspeed, m/s, at a static pressure, Pa, and back.
template <class S>
S mach_of_cas(S cas, S pressure) {
  return pressure > S(0) ? mach_of(impact_of_cas(cas) / pressure) : undefined<S>();
}
template <class S>
S cas_of_mach(S mach, S pressure) {
  return pressure > S(0) ? cas_of_impact(pressure * impact_ratio(mach)) : undefined<S>();
}

template <class S>
S speed_of_sound(S temperature) {
  using namespace standard_atmosphere_1976;
  return temperature > S(0) ? std::sqrt(S(kHeatRatio * kGasConstant) * temperature)
                            : undefined<S>();
}

template <class S>
S density(S pressure, S temperature) {
  const bool is = pressure > S(0) && temperature > S(0);
  return is ? pressure / (S(standard_atmosphere_1976::kGasConstant) * temperature) : undefined<S>();
}

// True airspeed, m/s, of a calibrated one at a static pressure, Pa, and temperature, K, and back.
template <class S>
S tas_of_cas(S cas, S pressure, S temperature) {
  return mach_of_cas(cas, pressure) * speed_of_sound(temperature);
}
template <class S>
S cas_of_tas(S tas, S pressure, S temperature) {
  return cas_of_mach(tas / speed_of_sound(temperature), pressure);
}

// Equivalent airspeed, m/s, has the dynamic pressure of the true one in the standard's sea level.
template <class S>
S eas_of_tas(S tas, S pressure, S temperature) {
  return tas * std::sqrt(density(pressure, temperature) / S(kSeaLevelDensity));
}
template <class S>
S tas_of_eas(S eas, S pressure, S temperature) {
  return eas * std::sqrt(S(kSeaLevelDensity) / density(pressure, temperature));
}

// Calibrated airspeed of an indicated one, m/s: the static port reads `error` Pa above the air's
// pressure (position error), so the instrument lacks that much impact pressure. And back.
template <class S>
S cas_of_ias(S ias, S error) {
  return cas_of_impact(impact_of_cas(ias) + error);
}
template <class S>
S ias_of_cas(S cas, S error) {
  return cas_of_impact(impact_of_cas(cas) - error);
}

// Static temperature, K, of a total one: a probe with recovery factor r reads T (1 + 0.2 r M^2).
template <class S>
S static_temperature(S total, S mach, S recovery = S(1)) {
  return mach >= S(0) ? total / (S(1) + S(0.2) * recovery * mach * mach) : undefined<S>();
}

namespace detail {
// Geopotential height in the standard at which pressure^1 or density is `value`: both fall with
// height by the same law, with other exponents.
template <class S>
S height_where(S value, bool density) {
  using namespace standard_atmosphere_1976;
  if (!(value > S(0))) return undefined<S>();
  int i = 0;
  const auto at_base = [density](const Layer& l) {
    return density ? l.pressure / (kGasConstant * l.temperature) : l.pressure;
  };
  while (i + 1 < kLayers && value < S(at_base(kLayer[i + 1]))) ++i;
  const Layer& layer = kLayer[i];
  const S base = S(at_base(layer)), fall = std::log(value / base);
  if (layer.lapse == 0.0) return S(layer.base) + fall / S(layer.decay());
  const S power = S(density ? layer.power() - 1.0 : layer.power());
  return S(layer.base) + S(layer.temperature / layer.lapse) * std::expm1(fall / power);
}
}  // namespace detail

// Pressure altitude, m, geopotential as altimeters are built: of a static pressure, Pa. The layers
// are continued above 84.85 km and below sea level.
template <class S>
S pressure_altitude(S pressure) {
  return detail::height_where(pressure, false);
}

// Density altitude, m, geopotential: where the standard has this density, kg/m3.
template <class S>
S density_altitude(S density) {
  return detail::height_where(density, true);
}

// Geometric height, m, of a geopotential one (the inverse of geopotential_height).
template <class S>
S geometric_height(S height) {
  const S r(standard_atmosphere_1976::kEarthRadius);
  return height < r ? r * height / (r - height) : undefined<S>();
}

// Static pressure, Pa, at a pressure altitude, m, geopotential.
template <class S>
S pressure_at(S height) {
  return standard_atmosphere(geometric_height(height)).pressure;
}

}  // namespace alula::airdata
