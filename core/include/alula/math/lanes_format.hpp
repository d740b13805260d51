#pragma once
#include <cstdint>

namespace alula::detail {
// What the functions of lanes need to know of a number type: adding and subtracting `magic` rounds
// to an integer that then stands in the low bits; pi/2 in three parts whose products with small
// integers are exact (Cody and Waite 1980).
template <class T>
struct LaneFormat;
template <>
struct LaneFormat<double> {
  static constexpr double magic = 6755399441055744.0;  // 1.5 * 2^52
  static constexpr double half_pi_1 = 1.57079625129699707031;
  static constexpr double half_pi_2 = 7.54978941586159635335e-8;
  static constexpr double half_pi_3 = 5.39030252995776476554e-15;
  static constexpr int sign_shift = 62;      // from bit 1 to the sign bit
  static constexpr int exponent_shift = 52;  // from bit 0 to the exponent
  static constexpr std::int64_t exponent_of_one = 1023;
  static constexpr double largest_exponent = 708.0;  // e to plus or minus this is a normal number
};
template <>
struct LaneFormat<float> {
  static constexpr float magic = 12582912.0f;  // 1.5 * 2^23
  static constexpr float half_pi_1 = 1.5703125f;
  static constexpr float half_pi_2 = 4.837512969970703125e-4f;
  static constexpr float half_pi_3 = 7.54978995489188216e-8f;
  static constexpr int sign_shift = 30;
  static constexpr int exponent_shift = 23;
  static constexpr std::int32_t exponent_of_one = 127;
  static constexpr float largest_exponent = 87.0f;
};
}  // namespace alula::detail
