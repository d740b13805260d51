// Angles without vanes: seconds for a solution of the full window, and for a step of the filter
// with its airspeed, in double and in single precision, as JSON.
//
// FILE: doubles; the 17 of AsseSettings, then t, f, w, gravity, wind_rate (3 each), V a sample.
#include <alula/airdata/asse_filter.hpp>
#include <alula/airdata/asse_solve.hpp>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

using namespace alula;

struct Recording {
  std::array<double, 17> set;
  std::vector<std::array<double, 14>> rows;

  explicit Recording(const char* path) {
    std::FILE* file = std::fopen(path, "rb");
    if (!file || std::fread(set.data(), sizeof set, 1, file) != 1) std::exit(2);
    std::array<double, 14> row;
    while (std::fread(row.data(), sizeof row, 1, file) == 1) rows.push_back(row);
    std::fclose(file);
  }

  template <class T>
  AsseSettings<T> settings() const {
    const auto at = [&](std::size_t i) { return static_cast<T>(set[i]); };
    return {at(0), at(1),  at(2),  at(3),  at(4),  at(5),  at(6),  at(7), at(8),
            at(9), at(10), at(11), at(12), at(13), at(14), at(15), at(16)};
  }

  template <class T>
  AsseInput<T> input(std::size_t i) const {
    const auto three = [&](std::size_t first) {
      const double* v = rows[i].data() + first;
      return Vec3<T>{static_cast<T>(v[0]), static_cast<T>(v[1]), static_cast<T>(v[2])};
    };
    return {rows[i][0], three(1), three(4), three(7), three(10)};
  }
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Time of every solution of a window going over the recording, the least of `rounds`; its mean.
template <class T>
double window_seconds(const Recording& r, int capacity, int rounds) {
  std::vector<double> best;
  for (int round = 0; round < rounds; ++round) {
    AsseWindow<T> f;
    f.settings = r.settings<T>();
    f.capacity = capacity;
    std::size_t k = 0;
    for (std::size_t i = 0; i < r.rows.size(); ++i) {
      advance(f, r.input<T>(i));
      const long before = f.rejected.not_finite;
      const bool added = add_airspeed(f, r.rows[i][0], static_cast<T>(r.rows[i][13]));
      f.rejected.not_finite = before;
      if (!added || f.in_block != 0 || f.count < capacity) continue;
      const auto start = std::chrono::steady_clock::now();
      solve(f);
      const double s = seconds_since(start);
      if (k == best.size())
        best.push_back(s);
      else if (s < best[k])
        best[k] = s;
      ++k;
    }
  }
  double sum = 0.0;
  for (const double s : best) sum += s;
  return best.empty() ? std::nan("") : sum / static_cast<double>(best.size());
}

template <class T>
double filter_seconds(const Recording& r, int rounds) {
  double best = 1e9;
  for (int round = 0; round < rounds; ++round) {
    AsseFilter<T> f;
    f.settings = r.settings<T>();
    start(f);
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < r.rows.size(); ++i) {
      advance(f, r.input<T>(i));
      add_airspeed(f, r.rows[i][0], static_cast<T>(r.rows[i][13]));
    }
    best = std::fmin(best, seconds_since(begin) / static_cast<double>(r.rows.size()));
  }
  return best;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const Recording recording(arguments[1]);
  const int capacity = std::atoi(arguments[2]), rounds = std::atoi(arguments[3]);
  std::printf("{\"window\": [%.3e, %.3e], \"step\": [%.3e, %.3e]}\n",
              window_seconds<double>(recording, capacity, rounds),
              window_seconds<float>(recording, capacity, rounds),
              filter_seconds<double>(recording, rounds), filter_seconds<float>(recording, rounds));
}
