#include "technique/filters/patterns.h"

namespace noonmark {

TapPattern hardware_taps(const FilterSettings&) { return linear_fetches(1, 1); }

}  // namespace noonmark
