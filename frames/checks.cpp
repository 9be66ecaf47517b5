#include "frames/checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/suggestion.h"
#include "frames/check_outcome.h"

namespace noonmark {
namespace {

// ---- map

Outcome map(const CheckEvidence& e, const FrameStatistics&) {
  return not_checked(e.frame.map ? "the map is not looked at before the other checks have passed"
                                 : "no shadow map was handed over");
}

struct Row : FrameCheck {
  Outcome (*run)(const CheckEvidence&, const FrameStatistics&);
  bool reads_places = true;  // of the pixels: one of a picture in another place says nothing
  // What it finds in a normalised visibility is the renderer's own shadow, not the delivery's fault.
  bool is_excluded_by_normalising = false;
};
constexpr std::array<Row, 12> check_rows{{
    {{"values", "Every value is in [0,1], or says that there is no surface."}, check_values},
    {{"positions", "Given positions are 32-bit floats, lie on the scene, and project to their own pixels."},
     check_positions,
     false},
    {{"alignment", "The visibility lies on its own receivers: the picture is not flipped, and not shifted by a pixel."},
     check_alignment},
    {{"coverage", "The pixels with a surface are those of the scene through the frame's camera."}, check_coverage},
    {{"inverted", "1 is lit and 0 is shadowed."}, check_inverted, true, true},
    {{"shaded", "The values are the light's visibility, not a shaded frame."}, check_shaded, true, true},
    {{"intensity", "Shadows are 0: their intensity is 1 and no light was added."}, check_intensity, true, true},
    {{"match", "The frame's shadows are not elsewhere: scene and light are the frame's."}, check_match, true, true},
    {{"encoding", "The values are linear, not encoded with sRGB or a gamma."}, check_encoding},
    {{"samples", "Each value is its own pixel's: the picture was not blurred, resized or compressed."}, check_samples},
    {{"levels", "How many different values there are; it fails nothing."}, check_levels, false},
    {{map_check, "A shadow map that is handed over holds the scene's depths, seen from its light."}, map, false},
}};

}  // namespace

std::span<const FrameCheck> frame_checks() {
  static const std::vector<FrameCheck> checks(check_rows.begin(), check_rows.end());
  return checks;
}

void require_check(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Row& row : check_rows) names.push_back(row.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw Error(ErrorKind::usage, fmt::format("there is no check '{}'{}; there are {}", name, did_you_mean(name, names),
                                            fmt::join(names, ", ")));
}

std::vector<CheckResult> check_frame(const CheckEvidence& evidence) {
  const FrameStatistics statistics = frame_statistics(evidence);
  std::vector<CheckResult> results;
  std::string_view spoilt;
  for (const Row& row : check_rows) {
    Outcome outcome =
        row.reads_places && !spoilt.empty() ? not_checked(std::string(spoilt)) : row.run(evidence, statistics);
    if (spoilt.empty()) spoilt = outcome.spoils;
    results.push_back({row.name, outcome.state, std::move(outcome.says), false});
    CheckResult& result = results.back();
    if (result.state != CheckState::failed || !row.is_excluded_by_normalising || !evidence.frame.normalised) continue;
    result.accepted = true;
    result.says += "; but the visibility is normalised, so this is the renderer's own shadow";
  }
  return results;
}

CheckResult check_given_map(double off_m, double spread_m, bool is_scenes_map) {
  const std::string found = fmt::format(
      "half of the texels that are read are within {:.3g} m of the scene, of depths that spread over {:.3g} m", off_m,
      spread_m);
  if (is_scenes_map) return {map_check, CheckState::passed, found};
  return {map_check, CheckState::failed,
          found +
              ": the map is another one, turned over or mirrored, or fills only a part of its texels; check "
              "'first_row', 'y', "
              "'reversed', the order of the columns, the matrix and the viewport"};
}

}  // namespace noonmark
