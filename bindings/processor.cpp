// Which instruction sets this module needs and this processor has, so that the right module is
// chosen at import.
#include "bind.hpp"

void bind_processor(nb::module_& m) {
  m.def(
      "instruction_set",
      [] {
#if defined(__AVX2__)
        return "x86-64-v3";
#else
        return "baseline";
#endif
      },
      "What this module was compiled for: 'baseline' or 'x86-64-v3'.");
  m.def(
      "has_x86_64_v3",
      [] {
#if defined(__x86_64__) && defined(__GNUC__)
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
               __builtin_cpu_supports("bmi2");
#else
        return false;
#endif
      },
      "True where the processor executes AVX2, FMA and BMI2 (x86-64-v3).");
}
