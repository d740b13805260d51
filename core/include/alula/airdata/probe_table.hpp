#pragma once
// Five-hole probe by lookup: for a flight computer that has flash and little time.
//
// The table is over the start of the inverse, (Y, Z) of probe_start, so that what it holds is
// nearly what it is asked for, and bilinear interpolation errs little. It holds Y, Z and q over the
// start's q at (n x n) nodes. No iteration, no trigonometry but the two arctangents at the end.
#include <cmath>

#include "alula/airdata/probe.hpp"

namespace alula::airdata {

// A view of caller-owned data: 3 n^2 numbers, node (i, j) at 3 (i n + j), Y by i and Z by j, from
// -half to half. A node outside the probe's domain is NaN.
template <class S, class Stored = float>
struct ProbeTable {
  const Stored* data = nullptr;
  int n = 0;
  S half{};
  S A{}, B{}, K{};  // of the start
  S least{S(1)};    // Pa
  S domain{};       // rad
};

template <class S, class Stored>
ProbeStatus::Value probe_lookup(const ProbeTable<S, Stored>& table, const ProbePressures<S>& p,
                                ProbeFlow<S>& flow) {
  const S r2 = p.vertical * p.vertical + p.lateral * p.lateral;
  const S size = p.center * p.center + r2;
  if (!std::isfinite(size)) return ProbeStatus::not_finite;
  if (!(size >= table.least * table.least)) return ProbeStatus::no_flow;
  Probe<S> start;
  start.A = table.A;
  start.B = table.B;
  start.K = table.K;
  S Y{}, Z{}, q{};
  if (!probe_start(start, p, Y, Z, q)) return ProbeStatus::from_behind;
  const S step = S(2) * table.half / S(table.n - 1);
  const S at_y = (Y + table.half) / step, at_z = (Z + table.half) / step, last = S(table.n - 1);
  if (!(at_y >= S(0) && at_y <= last && at_z >= S(0) && at_z <= last))
    return ProbeStatus::outside_domain;
  int i = static_cast<int>(at_y), j = static_cast<int>(at_z);
  if (i > table.n - 2) i = table.n - 2;
  if (j > table.n - 2) j = table.n - 2;
  const S f = at_y - S(i), g = at_z - S(j);
  const Stored* low = table.data + 3 * (i * table.n + j);
  const Stored* high = low + 3 * table.n;
  S found[3];
  for (int k = 0; k < 3; ++k)
    found[k] = (S(1) - f) * ((S(1) - g) * S(low[k]) + g * S(low[k + 3])) +
               f * ((S(1) - g) * S(high[k]) + g * S(high[k + 3]));
  const S alpha = std::atan(found[1]);
  const S beta = std::atan(found[0] / std::sqrt(S(1) + found[1] * found[1]));
  const S border = table.domain + S(1e-5);
  if (!(std::abs(alpha) <= border && std::abs(beta) <= border))
    return ProbeStatus::outside_domain;  // NaN from a node without a flow ends here too
  flow = {q * found[2], alpha, beta, 0};
  return ProbeStatus::ok;
}

}  // namespace alula::airdata
