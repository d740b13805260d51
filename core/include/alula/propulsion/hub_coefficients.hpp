#pragma once
// What the blades of a propeller give at its hub, over the advance ratio at the disk: Pusztai 2018,
// section 2.1.2 and appendix B, with the linearization derived anew.
#include <cmath>

#include "alula/propulsion/blade_shape.hpp"

namespace alula {

// Sections of Pusztai's blades: lift c_l_alpha alpha, held beyond +-alpha_max; drag
// c_d_alpha alpha^2. alpha is against the section's line of no lift.
template <class T>
struct BladeAerodynamics {
  T c_l_alpha{0};  // 1/rad
  T alpha_max{0};  // rad
  T c_d_alpha{0};  // 1/rad^2
};

// One over the hub's loads in units of rho w'^2 R^4 (forces) and rho w'^2 R^5 (moments), w' the
// turning speed against the air at the disk; what follows a sideways speed is per v/(w' R), what
// follows a rate per q/w'. x along the thrust, right-hand propeller.
enum HubLoad { kFx, kFyV, kFyQ, kMx, kMyV, kMyQ, kHubLoads };

// Of one blade: columns are the parts of c_l_alpha alpha_max (stalled lift), of c_l_alpha (attached
// lift) and of c_d_alpha, Eqs. (2.28), (B.4), (B.5).
template <class T>
struct BladeIntegrals {
  T part[kHubLoads][3]{};
};

template <class T>
struct HubCoefficients {
  T of[kHubLoads]{};
};

// A blade element meets the air at U along the shaft and W in the disk. Per length its force is
//   F_x = c/2 rho V (c_l W - c_d U),  F_t = -c/2 rho V (c_l U + c_d W),  V^2 = U^2 + W^2,
// F_t along its motion, at alpha = pitch - atan(U/W). At the azimuth theta from y toward z, a
// sideways speed v changes W by -v sin(theta) and a pitch rate q changes U by q r sin(theta).
// Averaged over a turn that leaves
//   F_y = 1/2 dF_t/dW v - 1/2 r dF_t/dU q,  M_y = -1/2 r dF_x/dW v + 1/2 r^2 dF_x/dU q.
// Here l and its slope dl stand for c_l (or d, dd for c_d), U = J1, W = r.
template <class T>
struct ElementSlopes {
  T F_x, F_t, F_x_U, F_x_W, F_t_U, F_t_W;
};

template <class T>
ElementSlopes<T> lifting_element(T U, T W, T l, T dl) {
  const T V = std::sqrt(U * U + W * W), k = T(0.5) / V;
  return {T(0.5) * V * l * W,
          T(-0.5) * V * l * U,
          k * W * (U * l - W * dl),
          k * (l * (W * W + V * V) + dl * U * W),
          -k * (l * (U * U + V * V) - dl * U * W),
          -k * U * (W * l + U * dl)};
}

template <class T>
ElementSlopes<T> dragging_element(T U, T W, T d, T dd) {
  const T V = std::sqrt(U * U + W * W), k = T(0.5) / V;
  return {T(-0.5) * V * d * U,
          T(-0.5) * V * d * W,
          -k * (d * (U * U + V * V) - dd * U * W),
          -k * U * (W * d + U * dd),
          -k * W * (U * d - W * dd),
          -k * (d * (W * W + V * V) + dd * U * W)};
}

template <class T>
void add_element(BladeIntegrals<T>& sum, int column, const ElementSlopes<T>& e, T r, T weight) {
  const T h = T(0.5) * weight;
  sum.part[kFx][column] += weight * e.F_x;
  sum.part[kFyV][column] += h * e.F_t_W;
  sum.part[kFyQ][column] -= h * r * e.F_t_U;
  sum.part[kMx][column] += weight * r * e.F_t;
  sum.part[kMyV][column] -= h * r * e.F_x_W;
  sum.part[kMyQ][column] += h * r * r * e.F_x_U;
}

template <class T>
void add_piece(const BladeShape<T>& blade, T alpha_max, T J1, T begin, T end,
               BladeIntegrals<T>& sum) {
  const T half = T(0.5) * (end - begin), middle = T(0.5) * (end + begin);
  for (int i = 0; i < kGaussPoints; ++i) {
    const T r = middle + half * T(kGaussAt[i]);
    const T weight = half * T(kGaussWeight[i]) * chord_at(blade, r);
    const T alpha = pitch_at(blade, r) - std::atan2(J1, r);
    if (alpha > alpha_max || alpha < -alpha_max)
      add_element(sum, 0, lifting_element(J1, r, alpha > T(0) ? T(1) : T(-1), T(0)), r, weight);
    else
      add_element(sum, 1, lifting_element(J1, r, alpha, T(1)), r, weight);
    add_element(sum, 2, dragging_element(J1, r, alpha * alpha, T(2) * alpha), r, weight);
  }
}

// The integrals at an advance ratio of the disk J1 = u1/(w' R), not below zero. A piece is split
// where the blade's stall begins, Eq. (2.26) for any distribution of pitch, so that a kink costs no
// accuracy.
template <class T>
BladeIntegrals<T> blade_integrals(const BladeShape<T>& blade, T alpha_max, T J1) {
  BladeIntegrals<T> sum;
  for_pieces(blade, [&](T begin, T end) {
    const auto beyond = [&](T r, T limit) {
      return pitch_at(blade, r) - std::atan2(J1, r) > limit;
    };
    T at = begin;
    for (const T limit : {alpha_max, -alpha_max}) {
      const bool first = beyond(begin, limit);
      if (first == beyond(end, limit)) continue;
      T low = begin, high = end;
      for (int i = 0; i < 48; ++i) {
        const T r = T(0.5) * (low + high);
        (beyond(r, limit) == first ? low : high) = r;
      }
      // Two limits in one piece: where alpha falls outward the upper one comes first.
      if (low > at) {
        add_piece(blade, alpha_max, J1, at, low, sum);
        at = low;
      }
    }
    add_piece(blade, alpha_max, J1, at, end, sum);
  });
  return sum;
}

// All blades together, Eq. (2.28).
template <class T>
HubCoefficients<T> hub_coefficients(const BladeShape<T>& blade, const BladeAerodynamics<T>& a,
                                    T J1) {
  const BladeIntegrals<T> one = blade_integrals(blade, a.alpha_max, J1);
  HubCoefficients<T> all;
  for (int i = 0; i < kHubLoads; ++i)
    all.of[i] = T(blade.count) * (a.c_l_alpha * (a.alpha_max * one.part[i][0] + one.part[i][1]) +
                                  a.c_d_alpha * one.part[i][2]);
  return all;
}

// Radius over the tip's inside which a helix is stalled, Eq. (2.26), within 0 and 1; no stall where
// the root is not real or alpha_max is not below a right angle.
template <class T>
T stall_radius(T helix, T J1, T alpha_max) {
  const T pi = T(3.14159265358979323846), tangent = std::tan(alpha_max);
  if (!(alpha_max < T(0.5) * pi)) return T(0);
  const T b = helix - T(2) * pi * J1;
  const T root = b * b - T(8) * pi * helix * J1 * tangent * tangent;
  if (root < T(0)) return T(0);
  const T r = (b + std::sqrt(root)) / (T(4) * pi * tangent);
  return r < T(0) ? T(0) : (r < T(1) ? r : T(1));
}

}  // namespace alula
