// What a section (compare/ladder/section.h) shows, in words: why the pixel is right or wrong, and which bias would have
// changed it.
#pragma once
#include <string>
#include <vector>

#include "compare/ladder/section.h"

namespace noonmark::report {

// "Acne (too dark)"; of a right pixel "Right, lit".
std::string section_title(const ReceiverSection& section);

// One paragraph for the tap that decides, one for the bias, one for all taps if there are several, and one for what the
// drawing leaves out.
std::vector<std::string> section_words(const ReceiverSection& section);

}  // namespace noonmark::report
