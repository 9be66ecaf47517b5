// What was found out about other renderers' frames before their shadows were judged (PointRecord::Delivery): which are
// refused, in words. A refused frame has no values, so bounds are judged over the other frames.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

// The frames that are not judged.
std::vector<const PointRecord*> refused_frames(std::span<const PointRecord> points);

// The frame's name in the experiment.
std::string frame_name(const PointRecord& point);

// Of one frame, for a table: "refused", "accepted: coverage ...", "ok, not checked: inverted, match", "ok".
std::string delivery_text(const PointRecord& point);

// "frame a is refused, so its shadows are not judged: coverage: ..."; without a full stop. The point is refused.
std::string why_refused(const PointRecord& point);

}  // namespace noonmark
