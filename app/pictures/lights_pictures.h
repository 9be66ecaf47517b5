// The pictures of a frame of several lights (measure/lights_frame.h). They are pictures of the point of its first light.
#pragma once
#include <string>
#include <vector>

#include "app/pictures/image_file.h"
#include "compare/report/lights_section.h"
#include "compare/results/records.h"
#include "measure/lights_frame.h"

namespace noonmark {

inline constexpr std::string_view lights_prefix = report::lights_pictures;  // of their names

inline bool is_lights_picture(const PictureRecord& picture) { return picture.name.starts_with(lights_prefix); }

// Writes them below out/images. id: of the point. names: of the lights, in order.
std::vector<PictureRecord> keep_lights(const LightsFrame& frame, const std::vector<std::string>& names, int64_t id,
                                       const std::string& out);

}  // namespace noonmark
