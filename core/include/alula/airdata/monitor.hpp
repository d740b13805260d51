#pragma once
// Voting among sources of one flow angle: vanes, probe, ASSE, navigation, lift model.
//
// Each source is compared with the weighted mean of those of the others that agree with their own
// weighted median. Its difference from it is watched in two ways: a short mean tells a bias, what
// neighboring differences differ by tells noise. Repeated readings tell a stuck sensor, absent ones
// a dead one. Only the worst source is taken out at a time, so that one that is wrong does not drag
// the others along; what is left carries on. Two sources that disagree cannot be told apart: that
// is reported as a split vote and nobody is named.
#include <cmath>
#include <limits>

#include "alula/math/bounded.hpp"

namespace alula::airdata {

inline constexpr int kMostSources = 8;

template <class S>
struct SourceSpec {
  S white{};          // rad, standard deviation of the noise of one reading
  S slow{};           // rad, of errors that last: bias left, drift, model error
  int stuck_after{};  // equal readings in a row that a live source does not give; 0: not watched
};

template <class S>
struct MonitorSettings {
  Bounded<SourceSpec<S>, kMostSources> sources;
  S mean_time{S(0.4)};   // s, of the short mean
  S bias_limit{S(5)};    // standard deviations of the short mean
  S noise_limit{S(4)};   // times the power that is expected
  S dead_after{S(0.5)};  // s without a reading
  S readmit{};           // s of good behavior after which a source is back; 0: never
  S gate{S(4)};          // standard deviations from the median to have a vote
  S longest_step{S(1)};  // s, a longer gap starts the means anew
};

struct Health {
  enum Value : int { healthy = 0, dead, stuck, biased, noisy };
};

template <class S>
struct SourceState {
  S value{}, off{}, mean{}, power{}, weight{}, count{}, age{}, good{};
  int same = 0, rejected = 0;
  bool seen = false;
  Health::Value health = Health::healthy;
};

template <class S>
struct MonitorState {
  SourceState<S> source[kMostSources];
  S t{};
  bool started = false;
  int refused = 0;  // steps with time that did not go on
};

template <class S>
struct Voted {
  S angle{}, sigma{};  // rad; NaN without a source
  int used = 0;
  int named = -1;      // source taken out in this step
  bool split = false;  // disagreement among two
};

namespace detail {

template <class S>
struct Consensus {
  S value{}, white{}, slow{};  // rad; variances
  int count = 0;
};

// Of the healthy and current sources but `without`.
template <class S>
Consensus<S> consensus(const MonitorSettings<S>& s, const MonitorState<S>& state, int without) {
  int order[kMostSources], n = 0;
  S total{};
  const auto variance = [&s](int i) {
    return s.sources[i].white * s.sources[i].white + s.sources[i].slow * s.sources[i].slow;
  };
  for (int i = 0; i < s.sources.size(); ++i) {
    const SourceState<S>& one = state.source[i];
    if (i == without || one.health != Health::healthy || !one.seen || one.age > s.dead_after)
      continue;
    int k = n++;
    for (; k > 0 && state.source[order[k - 1]].value > one.value; --k) order[k] = order[k - 1];
    order[k] = i;
    total += S(1) / variance(i);
  }
  Consensus<S> out;
  if (n == 0) return out;
  S median{}, below{};
  for (int k = 0; k < n; ++k) {
    const S w = S(1) / variance(order[k]);
    if (below + w >= S(0.5) * total) {
      median = state.source[order[k]].value;
      break;
    }
    below += w;
  }
  // Two have no median between them: both have their say.
  const S spread = S(1) / std::sqrt(total);
  S sum{}, weights{};
  for (int k = 0; k < n; ++k) {
    const int i = order[k];
    const S v = variance(i), w = S(1) / v, off = std::abs(state.source[i].value - median);
    if (n > 2 && off > s.gate * std::sqrt(v + spread * spread)) continue;
    sum += w * state.source[i].value;
    weights += w;
    out.white += w * w * s.sources[i].white * s.sources[i].white;
    out.slow += w * w * s.sources[i].slow * s.sources[i].slow;
    ++out.count;
  }
  out.value = sum / weights;
  out.white /= weights * weights;
  out.slow /= weights * weights;
  return out;
}

}  // namespace detail

// One step at time t, s. readings: rad, by source; fresh: whether there is one since the last step.
// A fresh NaN is rejected and counted. Time that does not go on is refused and counted, the state
// untouched, and the last vote is given again.
template <class S>
Voted<S> monitor_step(const MonitorSettings<S>& s, MonitorState<S>& state, S t, const S* readings,
                      const bool* fresh) {
  const auto vote = [&s, &state] {
    const auto all = detail::consensus(s, state, -1);
    Voted<S> out;
    out.used = all.count;
    const S none = std::numeric_limits<S>::quiet_NaN();
    out.angle = all.count ? all.value : none;
    out.sigma = all.count ? std::sqrt(all.white + all.slow) : none;
    return out;
  };
  if (!std::isfinite(t) || (state.started && !(t > state.t))) {
    if (state.refused < std::numeric_limits<int>::max()) ++state.refused;
    return vote();
  }
  const S dt = state.started ? t - state.t : S(0);
  const bool anew = !state.started || dt > s.longest_step;
  state.t = t;
  state.started = true;
  bool valid[kMostSources] = {};
  S since[kMostSources] = {};
  for (int i = 0; i < s.sources.size(); ++i) {
    SourceState<S>& one = state.source[i];
    one.age += dt;
    if (anew) {
      one.weight = one.count = S(0);
      one.good = S(0);
      one.age = std::fmin(one.age, S(0.5) * s.dead_after);  // nobody had a chance to speak
    }
    if (!fresh[i]) continue;
    if (!std::isfinite(readings[i])) {
      if (one.rejected < std::numeric_limits<int>::max()) ++one.rejected;
      continue;
    }
    valid[i] = true;
    if (!one.seen || readings[i] != one.value)
      one.same = 0;
    else if (one.same < std::numeric_limits<int>::max())
      ++one.same;
    one.value = readings[i];
    one.seen = true;
    since[i] = one.age;
    one.age = S(0);
  }

  int worst = -1;
  S most = S(1);
  bool split = false;
  Health::Value why = Health::healthy;
  const auto accuse = [&](int i, S by, Health::Value reason) {
    if (state.source[i].health != Health::healthy || !(by > most)) return;
    worst = i;
    most = by;
    why = reason;
  };
  for (int i = 0; i < s.sources.size(); ++i) {
    SourceState<S>& one = state.source[i];
    const SourceSpec<S>& spec = s.sources[i];
    const bool gone = one.age > s.dead_after;
    const bool hangs = spec.stuck_after > 0 && one.same >= spec.stuck_after;
    // These two need no vote, and come first.
    if (gone) accuse(i, S(1e9), Health::dead);
    if (hangs) accuse(i, S(1e8), Health::stuck);
    bool bad = gone || hangs;
    if (valid[i]) {
      const auto others = detail::consensus(s, state, i);
      if (others.count > 0) {
        const S off = one.value - others.value;
        // Means of the readings so far, until there are enough for an exponential one. Noise needs
        // more of them than a mean: a slow source takes its time.
        const S interval = since[i] > S(1e-3) ? since[i] : S(1e-3);
        const S keep = s.mean_time / (s.mean_time + interval);
        const S most_count = std::fmax(S(1) / (S(1) - keep), S(20));
        one.weight = keep * one.weight + S(1);
        one.count = std::fmin(one.count + S(1), most_count);
        const S gain = S(1) / one.weight;
        const S white = spec.white * spec.white + others.white;
        // Noise by what neighbors differ: motion and bias cancel, and one jump is no noise.
        const S step = off - one.off, most_power = S(4) * s.noise_limit * white;
        const S power = std::fmin(S(0.5) * step * step, most_power);
        one.mean = one.weight == S(1) ? off : one.mean + gain * (off - one.mean);
        one.power = one.weight == S(1) ? S(0) : one.power + (power - one.power) / one.count;
        one.off = off;
        // The mean's own variance: gain/(2 - gain) once it has settled.
        const S limit =
            s.bias_limit * std::sqrt(spec.slow * spec.slow + others.slow + white * gain);
        const S bias = std::abs(one.mean) / limit, noise = one.power / (s.noise_limit * white);
        const bool enough = one.count > S(0.5) * most_count;
        bad = bad || bias > S(0.7) || (enough && noise > S(0.7));
        if (others.count >= 2) {
          if (enough && noise > S(1) && noise > bias * bias) accuse(i, noise, Health::noisy);
          if (bias > S(1)) accuse(i, bias * bias, Health::biased);
        } else if (bias > S(1) && one.health == Health::healthy) {
          split = true;
        }
      }
    }
    if (bad)
      one.good = S(0);
    else if (valid[i])
      one.good += dt;
    if (one.health != Health::healthy && s.readmit > S(0) && one.good > s.readmit)
      one.health = Health::healthy;
  }
  if (worst >= 0) {
    state.source[worst].health = why;
    state.source[worst].good = S(0);
    // What the others held against a mean with the bad one in it is not theirs.
    for (int i = 0; i < s.sources.size(); ++i)
      if (i != worst) state.source[i].weight = state.source[i].count = S(0);
  }
  Voted<S> out = vote();
  out.named = worst;
  out.split = split;
  return out;
}

}  // namespace alula::airdata
