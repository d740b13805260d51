// The path filters over a minute of flight at 100 Hz: best time of the rounds and the number of
// heap allocations of one whole run, as JSON. `control` is counted around one known allocation.
#include <alula/filters/iterated.hpp>
#include <alula/filters/square_root_unscented.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "allocations.hpp"
#include "path_case.hpp"

namespace {

using namespace alula;

struct Timing {
  double seconds = 1e9;
  long allocations = 0;
};

template <class Filter>
Timing best_of(int rounds) {
  const auto model = alula_test::fourteen_states<double>();
  const auto flight = alula_test::flight(model, 6000, 1);
  const int n = model.states;
  std::vector<double> x(flight.t.size() * n);
  PathHistory<double> history;
  history.x = x.data();
  Timing best;
  for (int round = 0; round < rounds; ++round) {
    auto filter = std::make_unique<Filter>();
    alula_test::set_prior(*filter);
    const long before = alula_test::allocations();
    const auto start = std::chrono::steady_clock::now();
    const int done = run_filter(*filter, model, flight.record(), history);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    best.allocations += alula_test::allocations() - before;
    if (done != static_cast<int>(flight.t.size())) std::exit(1);
    best.seconds = std::min(best.seconds, took.count());
  }
  return best;
}

}  // namespace

int main(int count, char** arguments) {
  const int rounds = count > 1 ? std::atoi(arguments[1]) : 12;
  const long before = alula_test::allocations();
  { std::vector<double> control(3); }
  const long control = alula_test::allocations() - before;
  std::printf("{\"control\": %ld", control);
  const auto print = [](const char* name, Timing timing) {
    std::printf(", \"%s_s\": %.6f, \"%s_allocations\": %ld", name, timing.seconds, name,
                timing.allocations);
  };
  print("ukf", best_of<Unscented<double, kShortRow>>(rounds));
  print("srukf", best_of<SquareRootUnscented<double, kShortRow>>(rounds));
  print("ekf", best_of<Extended<double, kShortRow>>(rounds));
  print("iekf", best_of<Iterated<double, kShortRow>>(rounds));
  std::printf("}\n");
  return control > 0 ? 0 : 1;
}
