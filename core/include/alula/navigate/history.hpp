#pragma once
// Where the aircraft was a moment ago, for measurements that come late: a ring of fixed length.
#include "alula/math/vec3.hpp"

namespace alula {

template <class T>
struct Place3 {
  Vec3<T> position, velocity;  // NED, m, m/s
};

// What is found later holds for the past too. Such corrections are straight lines in time, so their
// sum is one line, which is added where a place is asked for: all places have it to come.
template <class T, int Size = 64>
struct History {
  double t[Size] = {};
  Place3<T> at[Size] = {};  // less the line
  Place3<T> line{};         // its value at t_line, and its slope
  double t_line = 0;
  int newest = -1, length = 0;
  double spacing = 0.02;  // s; Size of them is the latest that a measurement may come

  constexpr int index(int age) const { return (newest - age + Size) % Size; }
  constexpr Vec3<T> moved(double when) const {
    return line.position + static_cast<T>(when - t_line) * line.velocity;
  }
};

template <class T, int Size>
void remember(History<T, Size>& h, double t, const Place3<T>& at) {
  if (h.length > 0 && t - h.t[h.newest] < h.spacing * 0.999) return;
  h.newest = (h.newest + 1) % Size;
  if (h.newest == 0) {  // once a round, so that the line stays short and exact
    for (int i = 0; i < h.length; ++i) {
      h.at[i].position = h.at[i].position + h.moved(h.t[i]);
      h.at[i].velocity = h.at[i].velocity + h.line.velocity;
    }
    h.line = {};
    h.t_line = t;
  }
  h.t[h.newest] = t;
  h.at[h.newest] = {at.position - h.moved(t), at.velocity - h.line.velocity};
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
    const Place3<T> before{h.at[i].position + h.moved(h.t[i]), h.at[i].velocity + h.line.velocity};
    if (h.t[i] <= t) {
      const double gap = later - h.t[i];
      const T k = gap > 0 ? static_cast<T>((t - h.t[i]) / gap) : T(0);
      const auto between = [k](const Vec3<T>& a, const Vec3<T>& b) { return a + k * (b - a); };
      out = {between(before.position, after.position), between(before.velocity, after.velocity)};
      return true;
    }
    later = h.t[i];
    after = before;
  }
  return false;
}

// A correction found now holds for the past too: positions less what the velocity's part adds.
template <class T, int Size>
void amend(History<T, Size>& h, double now, const Vec3<T>& position, const Vec3<T>& velocity) {
  h.line.position = h.line.position + position - static_cast<T>(now - h.t_line) * velocity;
  h.line.velocity = h.line.velocity + velocity;
}

}  // namespace alula
