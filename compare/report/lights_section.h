// The report's section on frames of several lights (measure/lights_frame.h): which light makes how much of the error, and why.
#pragma once
#include <functional>
#include <string>

#include "compare/report/element.h"
#include "compare/results/records.h"

namespace noonmark::report {

// Of the names of the pictures that this section shows, and the section of pictures does not.
inline constexpr std::string_view lights_pictures = "lights-";

// A table for each frame, with a row for each light. The frame with the largest error comes first. Empty if the experiment has no
// frame of several lights. read_file: as for render_report().
Markup lights_section(const Results& results, const std::function<std::string(const std::string&)>& read_file);

// Of the frame with the largest error, the light that makes the largest share of it; null if there is no frame, or if the frame has no
// error. The page opens with it, because lights_sentence() speaks of it.
const PointRecord* largest_light(const Results& results);

// "Of the frame's error of 0.42 %, spot makes 69 %: Peter Panning." Of the worst frame; empty if there is none.
Markup lights_sentence(const Results& results);

}  // namespace noonmark::report
