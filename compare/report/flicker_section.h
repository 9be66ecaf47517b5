// The report's strip of a motion: flicker from each frame to the next, split into its classes (compare/ladder/flicker.h).
#pragma once
#include <string>

#include "compare/store/records.h"

namespace noonmark::report {

// Whether a point has flicker; the report has the section only then.
bool has_flicker(const Results& results);

// One strip for each choice of each part: a bar for each frame, in the classes' colours, and a table. Needs no JavaScript.
// Of more than 12 choices those with the largest flicker are drawn; the table has all of them.
std::string flicker_section(const Results& results);

}  // namespace noonmark::report
