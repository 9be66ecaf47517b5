#include "technique/filters/patterns.h"

namespace noonmark {

TapPattern hardware_taps(const FilterSettings&) { return fetches_of({1.0}); }

}  // namespace noonmark
