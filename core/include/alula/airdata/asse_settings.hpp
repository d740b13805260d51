#pragma once
// What window and filter know of the sensors beforehand.
#include "alula/airdata/asse.hpp"

namespace alula {

template <class T>
struct AsseSettings {
  T sigma_V{T(0.3)};        // m/s, noise of the airspeed per sample
  T delay{0};               // s by which the airspeed is old at its time stamp
  T sigma_tilt{T(0.0175)};  // rad, attitude error about each body axis
  T tilt_time{T(20)};       // s, its correlation time
  T sigma_a{T(0.02)};       // m/s2, constant error of the accelerometers
  T sigma_w{T(1.75e-3)};    // rad/s, constant error of the gyros
  T density_a{T(1.4e-3)};   // m/s2 per root Hz, two-sided: velocity random walk
  T density_w{T(6.2e-4)};   // rad/s per root Hz: angle random walk
  T density_wind{0};        // m/s2 per root Hz: random walk of a wind that is not given
  T first_alpha{T(0.05)};   // rad, before anything is known ...
  T first_beta{0};
  T first_sigma{T(0.09)};  // ... to this standard deviation
  T limit{T(0.0436)};      // rad: an angle with a larger standard deviation is not observable
  T least_V{T(3)};         // m/s, below which an airspeed says nothing
  T longest_gap{T(0.25)};  // s without rates and accelerations after which all starts over
  T gate{T(5)};            // standard deviations at which an airspeed is an outlier (filter)
  T block{T(0.2)};         // s of airspeeds that the window averages to one sample
};

// One sample of what is on board, body axes; w rad/s, the rest m/s2.
template <class T>
struct AsseInput {
  double t;           // s
  Vec3<T> f, w;       // specific force, rates
  Vec3<T> gravity;    // from the attitude
  Vec3<T> wind_rate;  // as air_acceleration
};

template <class T>
inline bool is_finite(const AsseInput<T>& u) {
  return std::isfinite(u.t) && is_finite(u.f) && is_finite(u.w) && is_finite(u.gravity) &&
         is_finite(u.wind_rate);
}

template <class T>
struct AsseEstimate {
  T V{}, alpha{}, beta{};  // m/s, rad
  T P[3][3]{};             // covariance of V, alpha, beta
  bool observable_alpha = false, observable_beta = false;
  int samples = 0, iterations = 0;
};

}  // namespace alula
