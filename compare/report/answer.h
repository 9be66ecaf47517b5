// The report's verdict, and its section with what breaks, what to set, bounds and laws.
#pragma once
#include "compare/report/element.h"
#include "compare/report/shown.h"
#include "compare/results/records.h"

namespace noonmark::report {

// The verdict's sentence, as the coloured line at the top of the page.
Markup verdict_line(const Findings& found);
// Empty if there is nothing to say.
Markup answer_section(const ShownPoints& shown);
// The section's name in the page's head: "Answer" if a setting is recommended, otherwise "Findings".
const char* answer_label(const ShownPoints& shown);

}  // namespace noonmark::report
