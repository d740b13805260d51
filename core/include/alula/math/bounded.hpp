#pragma once
// A vector of run-time length in fixed storage.
#include <array>

namespace alula {

template <class T, int Max>
struct Bounded {
  std::array<T, Max> data{};
  int length = 0;

  static constexpr int capacity = Max;

  constexpr T& operator[](int i) { return data[static_cast<unsigned>(i)]; }
  constexpr const T& operator[](int i) const { return data[static_cast<unsigned>(i)]; }
  constexpr int size() const { return length; }
  constexpr bool full() const { return length == Max; }

  // False, and nothing changed, when there is no room.
  constexpr bool push(const T& value) {
    if (full()) return false;
    data[static_cast<unsigned>(length++)] = value;
    return true;
  }

  constexpr T* begin() { return data.data(); }
  constexpr T* end() { return data.data() + length; }
  constexpr const T* begin() const { return data.data(); }
  constexpr const T* end() const { return data.data() + length; }
};

}  // namespace alula
