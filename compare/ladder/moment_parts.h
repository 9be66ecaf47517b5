// How the change from the taps to a filtered result is parted into causes (compare/ladder/moment_climb.h).
#pragma once
#include <algorithm>

namespace noonmark {

// Of one receiver, all in [0, 1].
struct MomentChain {
  double from = 0, texels = 0;  // the taps at the places looked up, and at the centres of their texels: D and R3
  double bare = 0, bound = 0;   // the bound without and with bias and floors
  // The weight of the taps that no texel covers, and of those whose truth float error can change.
  double uncovered = 0, unsure = 0;
};

// Their sum is the change. A part is negative if it darkens. No two parts have opposite signs.
struct MomentParts {
  double coverage = 0, undecided = 0, aliasing = 0, to_bare = 0, to_floors = 0, reduction = 0;

  double leak() const { return std::max(0.0, to_bare); }
  double peter_panning() const { return std::max(0.0, to_floors); }
  double over_darkening() const { return std::min(0.0, to_bare) + std::min(0.0, to_floors); }
};

// shown: the bound after light-bleed reduction.
MomentParts moment_parts(const MomentChain& chain, double shown);

}  // namespace noonmark
