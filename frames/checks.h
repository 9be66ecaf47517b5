// Whether a delivered frame is what it should be. Each check has evidence in numbers and a consequence, and it corrects
// nothing. None of them moves the shadows to make them fit: they ask coverage, values and positions.
//
//   for (const CheckResult& check : check_frame(evidence))
//     if (check.state == CheckState::failed) fmt::print("{}: {}\n", check.name, check.says);
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frames/frame.h"
#include "raytrace/tracer.h"
#include "technique/evidence.h"
#include "technique/light_frame.h"

namespace noonmark {

enum class CheckState { passed, failed, not_checked };

struct CheckResult {
  std::string_view name;  // of the row in frame_checks(); what --accept names
  CheckState state = CheckState::passed;
  std::string says;       // evidence and consequence, one line. Of one that was not checked: why
  bool accepted = false;  // by the caller, or because the frame's visibility is normalised
};

struct FrameCheck {
  std::string_view name;
  std::string_view asks;  // for the documents: one sentence
};
std::span<const FrameCheck> frame_checks();
// Throws Error(usage) that suggests the nearest name.
void require_check(std::string_view name);

// What the checks read. All images have the frame's size.
struct CheckEvidence {
  const Scene& scene;
  const raytrace::Tracer& tracer;  // of the scene
  const GivenFrame& frame;
  const Image<uint32_t>& seen;  // what the scene shows through the frame's camera: Tracer::seen_primitives
  const ReceiverImage& receivers;
  const Image<float>& moved_m;  // of given receivers: how far they were from the scene
  const ReceiverTruth& truth;
  const Image<uint8_t>& counted;
  const Image<float>& pixel_m;  // pixel_width_m() of the receivers
  const LightFrame& light;      // of the frame's light; its map is not read
};
std::vector<CheckResult> check_frame(const CheckEvidence& evidence);

inline constexpr std::string_view map_check = "map";
// The check "map", which needs the exact map. off_m: the median distance of its depths from the scene's, over the texels that
// are read. spread_m: how far apart the scene's depths there are. is_scenes_map: what that means.
CheckResult check_given_map(double off_m, double spread_m, bool is_scenes_map);

}  // namespace noonmark
