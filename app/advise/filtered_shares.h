// What filtered maps do wrong in place of acne.
#pragma once

namespace noonmark {

// Shares of the counted receivers: of several points the largest of each.
struct FilteredShares {
  double leak = 0, over_darkening = 0, reduction = 0, peter_panning = 0;
};

}  // namespace noonmark
