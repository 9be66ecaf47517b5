#include "technique/filters/patterns.h"

namespace noonmark {

TapPattern gaussian_taps(const FilterSettings& f) {
  return fetches_of(gaussian_weights(f.whole("size"), f["sigma_texels"]));
}

}  // namespace noonmark
