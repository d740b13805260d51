#pragma once
// Capacities of everything whose size is known only at run time. Nothing in the core grows.

namespace alula {

inline constexpr int kMaxStates = 24;
inline constexpr int kMaxOutputs = 16;
inline constexpr int kMaxTerms = 64;
inline constexpr int kMaxParameters = 64;

}  // namespace alula
