// A phase diagram for its readers: as words, as a page of its own, and as CSV. compare/results/phase_record.h says what it
// is.
//
//   write_file_atomically(dir + "/phase.html", render_phase(diagram));
#pragma once
#include <string>
#include <vector>

#include "compare/results/phase_record.h"

namespace noonmark {

// "Usable from 0.053 m to 0.51 m at 1024 texels ...": what the diagram shows, as sentences.
std::vector<std::string> phase_words(const PhaseDiagram& diagram);

// A page of its own, which needs no other file.
std::string render_phase(const PhaseDiagram& diagram);
// One line for each texel size and bias, with every number of the diagram.
std::string phase_csv(const PhaseDiagram& diagram);

}  // namespace noonmark
