#pragma once
// Where the aircraft was a moment ago, for measurements that come late: a ring of fixed length.
#include "alula/math/vec3.hpp"

namespace alula {

template <class T>
struct Place3 {
  Vec3<T> position, velocity;  // NED, m, m/s
};

template <class T, int Size = 64>
struct History {
  double t[Size] = {};
  Place3<T> at[Size] = {};
  int newest = -1, length = 0;
  double spacing = 0.02;  // s; Size of them is the latest that a measurement may come

  constexpr int index(int age) const { return (newest - age + Size) % Size; }
};

template <class T, int Size>
void remember(History<T, Size>& h, double t, const Place3<T>& at) {
  if (h.length > 0 && t - h.t[h.newest] < h.spacing * 0.999) return;
  h.newest = (h.newest + 1) % Size;
  h.t[h.newest] = t;
  h.at[h.newest] = at;
  if (h.length < Size) ++h.length;
}

// Where it was at t, between the samples kept and `now` (a little after it: straight on); false
// where that is forgotten.
template <class T, int Size>
bool recall(const History<T, Size>& h, double t, double t_now, const Place3<T>& now,
            Place3<T>& out) {
  double later = t_now;
  Place3<T> after = now;
  if (t >= t_now) {
    out = {now.position + static_cast<T>(t - t_now) * now.velocity, now.velocity};
    return true;
  }
  for (int age = 0; age < h.length; ++age) {
    const int i = h.index(age);
    if (h.t[i] <= t) {
      const double gap = later - h.t[i];
      const T k = gap > 0 ? static_cast<T>((t - h.t[i]) / gap) : T(0);
      const auto between = [k](const Vec3<T>& a, const Vec3<T>& b) { return a + k * (b - a); };
      out = {between(h.at[i].position, after.position), between(h.at[i].velocity, after.velocity)};
      return true;
    }
    later = h.t[i];
    after = h.at[i];
  }
  return false;
}

// A correction found now holds for the past too: positions less what the velocity's part adds.
template <class T, int Size>
void amend(History<T, Size>& h, double now, const Vec3<T>& position, const Vec3<T>& velocity) {
  for (int i = 0; i < h.length; ++i) {
    const T age = static_cast<T>(now - h.t[i]);
    h.at[i].position = h.at[i].position + position - age * velocity;
    h.at[i].velocity = h.at[i].velocity + velocity;
  }
}

}  // namespace alula
