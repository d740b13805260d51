#pragma once
// Numbers side by side, and what is calculated with them.
#include "alula/math/lanes_exponential.hpp"
#include "alula/math/lanes_trigonometry.hpp"
#include "alula/math/lanes_type.hpp"
