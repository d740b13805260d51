#pragma once
// Continuous turbulence of Dryden's form, MIL-F-8785C section 3.7.
#include <array>
#include <cmath>

#include "alula/math/quaternion.hpp"
#include "alula/math/vec3.hpp"

namespace alula {

template <class T>
struct Dryden {
  T span{1};   // m, of the aircraft
  T W20{0};    // m/s, wind 20 ft above the ground: turbulence below 1000 ft
  T sigma{0};  // m/s, turbulence above 2000 ft
};

// Standard normal numbers for each step, and to start with.
inline constexpr int kDrydenNormals = 8;
inline constexpr int kDrydenStates = 8;

// Forming filters' states, without unit: u | v v r | w w q | p.
template <class T>
using DrydenState = std::array<T, kDrydenStates>;

// Velocity and rotation of the air: of the air toward plus, as inputs of the equations of motion.
template <class T>
struct Turbulence {
  Vec3<T> velocity{};  // m/s
  Vec3<T> rates{};     // rad/s
};

}  // namespace alula
