// The two bounds of a usable bias.
#pragma once

namespace noonmark {

// Fractions of the counted receivers. Options and records that have them derive from this, so that the pair is handed on as
// one: static_cast<CauseBounds&>(curve) = options.
struct CauseBounds {
  double acne_bound = 0.001, peter_panning_bound = 0.001;
  bool operator==(const CauseBounds&) const = default;
};

}  // namespace noonmark
