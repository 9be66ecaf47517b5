// The numbers that the formulas of filtered shadow maps read, for every type of number (technique/lookup_formulas.h).
//
//   in_float::LookupParameters vsm{};  // bare: all 0
//   vsm.v_min = 1e-6f;
#pragma once
#include "technique/formulas.h"

namespace noonmark::in_float {
#include "technique/lookups/parameters.glsl"
}
namespace noonmark::in_double {
#include "technique/lookups/parameters.glsl"
}
namespace noonmark::in_extended {
#include "technique/lookups/parameters.glsl"
}
namespace noonmark::in_bounds {
#include "technique/lookups/parameters.glsl"
}
