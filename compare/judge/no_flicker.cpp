#include "compare/judge/no_flicker.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "compare/results/quantities.h"

namespace noonmark {
namespace {

double count_of(const PointRecord& point, const std::string& name) {
  const auto found = point.metrics.find(name);
  return found == point.metrics.end() ? 0 : found->second;
}

struct Reason {
  double points;
  const char* text;
  const char* advice;
};

}  // namespace

std::string why_no_flicker(const PointRecord& point) {
  const auto points = point.metrics.find("flicker_points");
  if (points == point.metrics.end() || points->second > 0) return "";
  constexpr const char *smaller_step =
                           "make the camera's step smaller (motion.move_m, motion.turn_deg, motion.zoom; "
                           "motion.time_s where a file's animation moves it)",
                       *smaller_turn =
                           "make the light's step smaller (motion.light_turn_deg, motion.light_move_m, motion.time_s)";
  const double outside = count_of(point, "flicker_outside"), hidden = count_of(point, "flicker_hidden"),
               unlit = count_of(point, "flicker_unlit"), judged = count_of(point, "counted"),
               changed = judged - outside - hidden - unlit;
  if (!(judged > 0)) return "";
  const Reason reasons[] = {
      {outside, "{:.0f} are not in the next frame's picture", smaller_step},
      {hidden, "{:.0f} are hidden there, or seen from their back", smaller_step},
      {unlit, "{:.0f} face away from the next frame's light, or have an ambiguous truth there", smaller_turn},
      {changed, "{:.0f} have another truth there", smaller_turn},
  };
  std::vector<std::string> texts;
  for (const Reason& reason : reasons)
    if (reason.points > 0) texts.push_back(fmt::format(fmt::runtime(reason.text), reason.points));
  const Reason& main = *std::max_element(std::begin(reasons), std::end(reasons),
                                         [](const Reason& a, const Reason& b) { return a.points < b.points; });
  return fmt::format(
      "flicker is not measured, because no point of the world is seen with one truth in this frame and in the next "
      "one: "
      "of {:.0f} that can be judged in this frame {}; {}",
      judged, fmt::join(texts, ", "), main.advice);
}

std::string no_flicker_note(std::span<const PointRecord> points) {
  size_t count = 0;
  const PointRecord* first = nullptr;
  for (const PointRecord& point : points)
    if (!why_no_flicker(point).empty() && count++ == 0) first = &point;
  if (!first) return "";
  const std::string why = why_no_flicker(*first);
  if (points.size() == 1) return why;
  return count == 1
             ? fmt::format("point {}: {}", first->id, why)
             : fmt::format("{} of {} points have no flicker; of point {}, {}", count, points.size(), first->id, why);
}

}  // namespace noonmark
