#pragma once
// The blades of a propeller by stations, all lengths over the tip's radius.
#include <array>
#include <cmath>

namespace alula {

inline constexpr int kMaxBladeStations = 64;

template <class T>
struct BladeShape {
  int count = 2;  // of blades
  T radius{1};    // m
  T hub{0};       // where the blades begin
  T helix{0};     // geometric pitch over the radius; above zero it stands for the stations' angles
  int stations = 0;
  std::array<T, kMaxBladeStations> r{}, chord{}, pitch{};  // pitch: rad, against the disk
};

// Index of the panel between two stations that holds r, and how far into it; held at the ends.
template <class T>
constexpr int panel_of(const BladeShape<T>& blade, T r, T& part) {
  const int last = blade.stations - 1;
  part = T(0);
  if (last < 1 || !(r > blade.r[0])) return 0;
  if (!(r < blade.r[static_cast<unsigned>(last)])) {
    part = T(1);
    return last - 1;
  }
  int low = 0, high = last;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (blade.r[static_cast<unsigned>(middle)] <= r ? low : high) = middle;
  }
  const T begin = blade.r[static_cast<unsigned>(low)];
  part = (r - begin) / (blade.r[static_cast<unsigned>(high)] - begin);
  return low;
}

template <class T>
constexpr T between(const std::array<T, kMaxBladeStations>& values, int panel, T part) {
  const unsigned i = static_cast<unsigned>(panel);
  return part > T(0) ? values[i] + part * (values[i + 1] - values[i]) : values[i];
}

template <class T>
T chord_at(const BladeShape<T>& blade, T r) {
  T part;
  const int panel = panel_of(blade, r, part);
  return between(blade.chord, panel, part);
}

// rad. A helix advances by its geometric pitch with every turn, whatever the radius.
template <class T>
T pitch_at(const BladeShape<T>& blade, T r) {
  constexpr T kTurn = T(6.283185307179586);
  if (blade.helix > T(0)) return std::atan2(blade.helix, kTurn * r);
  T part;
  const int panel = panel_of(blade, r, part);
  return between(blade.pitch, panel, part);
}

// Calls use(begin, end) for the pieces of the blade between which its shape is smooth, none longer
// than a 24th of the radius.
template <class T, class Use>
void for_pieces(const BladeShape<T>& blade, const Use& use) {
  T begin = blade.hub;
  for (int i = 0; i <= blade.stations; ++i) {
    const T end = i < blade.stations ? blade.r[static_cast<unsigned>(i)] : T(1);
    if (!(end > begin)) continue;
    const T stop = end < T(1) ? end : T(1);
    const int parts = 1 + static_cast<int>(T(24) * (stop - begin));
    for (int k = 0; k < parts; ++k)
      use(begin + (stop - begin) * (T(k) / T(parts)),
          begin + (stop - begin) * (T(k + 1) / T(parts)));
    begin = stop;
    if (!(begin < T(1))) break;
  }
}

// Gauss and Legendre's rule of five points on (-1, 1).
inline constexpr int kGaussPoints = 5;
inline constexpr double kGaussAt[kGaussPoints] = {-0.906179845938664, -0.5384693101056831, 0.0,
                                                  0.5384693101056831, 0.906179845938664};
inline constexpr double kGaussWeight[kGaussPoints] = {0.23692688505618908, 0.47862867049936647,
                                                      0.5688888888888889, 0.47862867049936647,
                                                      0.23692688505618908};

}  // namespace alula
