#include "technique/filters/patterns.h"

namespace noonmark {

TapPattern gaussian_taps(const FilterSettings& f) { return linear_fetches(f.whole("size"), f["sigma_texels"]); }

}  // namespace noonmark
