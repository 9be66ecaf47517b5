#include "compare/judge/deliveries.h"

#include <fmt/format.h>

#include "base/text.h"

namespace noonmark {

std::vector<const PointRecord*> refused_frames(std::span<const PointRecord> points) {
  std::vector<const PointRecord*> refused;
  for (const PointRecord& point : points)
    if (!point.delivery.refused.empty()) refused.push_back(&point);
  return refused;
}

std::string frame_name(const PointRecord& point) {
  const auto name = point.settings.find("given.frame");
  return name == point.settings.end() ? fmt::format("frame {}", point.id) : name->second;
}

std::string delivery_text(const PointRecord& point) {
  const PointRecord::Delivery& delivery = point.delivery;
  if (!delivery.refused.empty()) return "refused";
  std::string text = delivery.accepted.empty() ? "ok" : "accepted: " + delivery.accepted;
  if (!delivery.not_checked.empty()) text += "; not checked: " + delivery.not_checked;
  return text;
}

std::string why_refused(const PointRecord& point) {
  return fmt::format("{} is refused, so its shadows are not judged: {}", frame_name(point), point.delivery.refused);
}

}  // namespace noonmark
