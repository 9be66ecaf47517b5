// The metrics that another renderer's frame can have, and so its bounds.
#pragma once
#include <string>
#include <string_view>

namespace noonmark {

// Of every frame: its error, its classes, its receivers. Of a frame with its own map also the causes of the ladder. Throws
// Error(usage) with the nearest name for any other metric.
void require_frame_metric(std::string_view metric);

// Whether a frame has this metric only if its own shadow map was handed over.
bool needs_own_map(std::string_view metric);

}  // namespace noonmark
