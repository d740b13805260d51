#pragma once
// Capacities of everything whose size is known only at run time. Nothing in the core grows.

namespace alula {

inline constexpr int kMaxStates = 24;
inline constexpr int kMaxOutputs = 16;
inline constexpr int kMaxTerms = 64;
inline constexpr int kMaxParameters = 64;

// Covariance matrices have rows of one of two lengths, so that their loops have fixed bounds: the
// short one serves up to 15 states. Each leaves a place beside the largest number of states.
inline constexpr int kShortRow = 16;
inline constexpr int kLongRow = 28;
static_assert(kLongRow > kMaxStates);

}  // namespace alula
