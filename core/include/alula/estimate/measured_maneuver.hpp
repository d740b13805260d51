#pragma once
// One maneuver as the estimators see it: a model whose values are asked for, the aircraft's mass,
// what was measured. Views on the caller's arrays; nothing is owned and nothing grows.
#include "alula/aero/term_table.hpp"
#include "alula/math/capacity.hpp"
#include "alula/math/vec3.hpp"

namespace alula {

// The motion's variables: states, or inputs as measured where they are not states. Angles rad,
// V m/s against the air, rates rad/s.
enum MotionVariable : int {
  kMotionV,
  kMotionAlpha,
  kMotionBeta,
  kMotionP,
  kMotionQ,
  kMotionR,
  kMotionPhi,
  kMotionTheta
};
inline constexpr int kMotionVariables = 8;

// What can be measured: the motion's variables, specific force (m/s2, level flight: az = -g) at the
// center of gravity, angular acceleration (rad/s2).
enum MeasuredOutput : int {
  kOutAx = kMotionVariables,
  kOutAy,
  kOutAz,
  kOutPdot,
  kOutQdot,
  kOutRdot
};
inline constexpr int kMeasuredOutputs = 14;
static_assert(kMeasuredOutputs <= kMaxOutputs);

// Columns of a row of inputs. Force (N) and moment (N m, about the center of gravity) are all that
// acts beside aerodynamics and gravity: the engines. Slowness: 1 over the speed of sound, s/m.
// Coefficients as measured are added to the model's: those it has no terms for.
enum ManeuverInput : int {
  kInMotion = 0,
  kInControls = kMotionVariables,  // de da dr df dt
  kInDensity = kInControls + 5,
  kInSlowness,
  kInForce,
  kInMoment = kInForce + 3,
  kInCoefficients = kInMoment + 3,
  kInUnused = kInCoefficients + kCoefficients,
};
inline constexpr int kManeuverInputs = kInUnused + 1;
static_assert(kManeuverInputs % 4 == 0);

struct MeasuredManeuver {
  // Model and aircraft.
  const TermTable* table = nullptr;
  const Lookup<double>* lookups = nullptr;
  bool stability_axes = false;
  double S = 1, b = 1, c = 1;  // m2, m, m
  double mass = 1, gravity = 9.80665;
  Mat3<double> inertia{}, inertia_inverse{};
  Vec3<double> arm{};  // from the center of gravity to the moments' reference point, m

  // Which variables are states, and how strongly each is pulled to its measurement (1/s): the
  // stabilizing correction of an aircraft that diverges. The pulled one must be an output.
  bool is_state[kMotionVariables] = {};
  double pull[kMotionVariables] = {};

  // What is estimated: the column of each quantity in the vector of parameters, -1 where fixed. A
  // term's value is its weight times the parameter (several terms may share one) plus a constant
  // that the caller has put in.
  int columns = 0;
  int term_column[kMaxTerms] = {};
  double term_weight[kMaxTerms] = {};
  int initial_column[kMotionVariables] = {};
  int bias_column[kMeasuredOutputs] = {};  // by place among the outputs

  // Data: times (n), inputs (n, kManeuverInputs), measured outputs (n, outputs), NaN where a
  // sensor says nothing. Inputs are straight lines from sample to sample.
  int samples = 0, substeps = 1;
  int outputs = 0;
  int output[kMeasuredOutputs] = {};
  const double* t = nullptr;
  const double* inputs = nullptr;
  const double* measured = nullptr;
};

}  // namespace alula
