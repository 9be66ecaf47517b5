#include "technique/lookup_formulas.h"

#define precise
namespace noonmark::in_float {
namespace {
#include "technique/where_less.glsl"
constexpr real rounded(double constant) { return static_cast<real>(constant); }
}  // namespace
#include "lookup_formulas.inc"
}  // namespace noonmark::in_float
namespace noonmark::in_double {
namespace {
#include "technique/where_less.glsl"
constexpr real rounded(double constant) { return static_cast<real>(constant); }
}  // namespace
#include "lookup_formulas.inc"
}  // namespace noonmark::in_double
namespace noonmark::in_extended {
namespace {
#include "technique/where_less.glsl"
constexpr real rounded(double constant) { return static_cast<real>(constant); }
}  // namespace
#include "lookup_formulas.inc"
}  // namespace noonmark::in_extended
namespace noonmark::in_bounds {
#include "lookup_formulas.inc"
}
#undef precise
