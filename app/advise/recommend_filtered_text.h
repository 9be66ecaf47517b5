// The words on filtered maps in a recommendation (app/advise/recommend_text.h).
#pragma once
#include <string>

#include "app/advise/recommend.h"

namespace noonmark {

// "VSM with a box of 5 texels", or the field of an engine.
std::string lookup_text(const Settings& settings);

// The bounds on the causes of a filtered map; glossed: with a word on each for readers who meet them here first.
std::string filtered_bounds_text(const CurveOptions& bounds);
std::string glossed_filtered_bounds_text(const CurveOptions& bounds);
// The same as a sentence for a table that has comparing lookups too.
std::string filtered_beside_compared(const CurveOptions& bounds);

// "0.01% leak, 0% Peter Panning, ..."
std::string shares_text(const FilteredShares& shares);

// A search allows less than the bounds. So it can refuse settings that keep them. The sentence says what it allows; it begins with
// a blank. Empty if the settings were not refused for that.
std::string allowed_text(const Tried& tried);

// The bounds that the settings of this point would keep, as a sentence.
std::string enough_bounds_text(const PointRecord& worst, const CurveOptions& bounds);

// What the answer keeps, where, and why a search asks for more than the bounds. Empty of a lookup that compares.
std::string kept_filtered_text(const Answer& answer, const CurveOptions& bounds);

// The errors of a filtered map: the search judges exact maps at its placements, and OpenGL its own map at others. Empty of a lookup
// that compares.
std::string promise_of_both(const Answer& answer);

}  // namespace noonmark
