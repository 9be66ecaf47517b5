// Draws a section (compare/ladder/section.h) as an SVG of 400 pixels' width without scripts. It stands in the report, in
// the documents and in papers.
//
//   write_file_atomically("section.svg", report::section_svg(section, report::SectionTheme::light));
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/ladder/section.h"

namespace noonmark::report {

// automatic: light or dark as the reader's screen asks, by CSS custom properties. The others have their colours written
// out, for programs that read no custom properties, as those that print do.
enum class SectionTheme { automatic, light, dark };

inline const std::vector<std::string> section_themes{"auto", "light", "dark"};  // in the order of SectionTheme

// A complete SVG file. Its elements of class "tap" say each tap's verdict: data-tap (its number), data-texel ("12,40"),
// data-lit (1 or 0, on the exact map), data-shown (the same on OpenGL's map), data-cause (cause_name()).
std::string section_svg(const ReceiverSection& section, SectionTheme theme);

// The file of a point's section, below the folder of its results, and back: the pixel of such a path. Empty for others.
std::string section_path(int64_t point, glm::ivec2 pixel);
std::optional<glm::ivec2> section_pixel(std::string_view path);

}  // namespace noonmark::report
