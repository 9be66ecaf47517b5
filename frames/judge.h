// Judges a frame: the truth of its receivers, the share of each class of error by place, and the checks of the delivery.
//
//   FrameVerdict verdict = judge_frame(scene, tracer, frame, {.accepted = {"coverage"}});
//   if (!verdict.refused())                  // otherwise a check failed that was not accepted: the numbers say nothing
//   verdict.metrics.at("frame_error");
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "frames/checks.h"
#include "frames/frame.h"
#include "raytrace/tracer.h"
#include "technique/evidence.h"
#include "technique/light_frame.h"

namespace noonmark {

// Why a pixel of the frame differs from the truth, by its place alone: the frame's own map and bias are not known. The first
// that holds. The sizes of the classes sum to the error.
enum class FrameClass : uint8_t {
  none,      // no error, or not counted
  penumbra,  // the truth is between lit and shadowed, because the light has a size
  edge,      // a true shadow edge lies within the edge distance
  acne,      // the truth is lit, the frame is too dark, and no edge is near
  contact,   // the truth is dark, the frame is too light, and the occluder is nearer than the contact distance
  leak,      // the truth is dark, the frame is too light, and the occluder is further away
  missing  // before edge: the truth is dark, the frame is too light, and only GivenFrame::not_in_map is in the light's way
};
struct FrameClassRow {
  FrameClass what;
  std::string_view metric;  // its mean size over the counted receivers
  std::string_view label;
  std::array<uint8_t, 3> color;  // sRGB, as in compare/results/causes.h where the causes are kin
};
inline constexpr std::array<FrameClassRow, 6> frame_classes{{
    {FrameClass::penumbra, "frame_penumbra", "Penumbra", {202, 186, 60}},
    {FrameClass::missing, "frame_missing", "Missing caster (the frame's map lacks it)", {102, 17, 0}},
    {FrameClass::edge, "frame_edge", "Edge (near a true shadow edge)", {230, 159, 0}},
    {FrameClass::acne, "frame_acne", "Acne (lit in truth, too dark)", {213, 94, 0}},
    {FrameClass::contact, "frame_contact", "Contact (dark in truth, occluder near)", {0, 114, 178}},
    {FrameClass::leak, "frame_leak", "Leak (dark in truth, occluder far)", {0, 158, 115}},
}};

struct JudgeRules {
  // The edge distance, across the light's rays: metres, or pixels of the frame at the receiver.
  std::optional<double> edge_m = {};
  double edge_pixels = 2;
  // The contact distance along the light's ray, in metres; empty: contact_share of the scene's diagonal.
  std::optional<double> contact_m = {};
  static constexpr double contact_share = 0.01;
  double standard_error = 0.01;         // of the truth at each receiver, for a light with a size
  std::set<std::string> accepted = {};  // names of checks whose failure does not refuse the frame
};

struct FrameVerdict {
  ReceiverImage receivers;
  LightFrame light;
  ReceiverTruth truth;
  Image<uint8_t> counted;  // 1: facing, firm, with a surface in the scene and in the frame
  Image<float> error;      // |visibility - truth|, 0 where not counted
  Image<FrameClass> classes;
  std::vector<CheckResult> checks;        // in the order of frame_checks()
  std::map<std::string, double> metrics;  // by the rows of compare/results/metrics.h. Without a counted receiver NaN
  std::string bias = {};                  // of a frame with its own map: which bias would do (app/sweep/frame_map.h)
  glm::ivec2 worst{-1, -1};               // the counted pixel with the largest error; row 0 on top
  double edge_m = 0;                      // the median edge distance that was used
  double contact_m = 0;                   // the contact distance that was used

  // The truth that the frame is compared with: R0, which is R1 for a light without a size.
  float truth_at(size_t pixel) const { return truth.soft[pixel]; }
  bool refused() const;  // a check failed and was not accepted
};

// tracer: of the scene. Throws Error(file) if the sizes of the images differ, if the frame does not fit into memory, if a given
// position is not in the world, if the scene has no part of a name in not_in_map, or if no receiver is counted and no check says why; Error(usage) if a number of the light or of
// the rules is outside the range that it has in frame.json (frames/frame_keys.h), or the light has no direction.
FrameVerdict judge_frame(const Scene& scene, const raytrace::Tracer& tracer, const GivenFrame& frame,
                         const JudgeRules& rules);

}  // namespace noonmark
