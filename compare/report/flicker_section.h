// The report's strip of a motion: flicker from each frame to the next, split into its classes (compare/ladder/flicker.h).
#pragma once
#include "compare/report/element.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Whether a point has flicker; the report has the section only then.
bool has_flicker(const Results& results);

// One strip for each choice of each part: a bar for each frame, in the colours of the classes. Needs no JavaScript. If
// there are more than 12 choices, the 12 with the largest flicker are drawn.
Markup flicker_strips(const Results& results);

// "2 of 6 choices do not flicker in any frame: steady, and wrapped. The most flickers ...".
Markup flicker_sentence(const Results& results);

// The strips, unless the first screen has them, and a table of all choices.
Markup flicker_section(const Results& results, bool strips_on_first_screen);

}  // namespace noonmark::report
