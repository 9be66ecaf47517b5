#include "technique/technique.h"

#include "technique/setting_rules.h"

namespace noonmark {
namespace {

std::optional<MomentLookup> moments_of(const Settings& settings) {
  return compares(settings) ? std::nullopt : std::optional<MomentLookup>(settings);
}

}  // namespace

Technique::Technique(const Scene& scene, const Settings& given)
    : settings(given),
      frame(make_light_frame(scene, given)),  // which validates
      bias(given.bias),
      filter(&find_filter(given.filter.kind)),
      taps(tap_pattern(given)),
      moments(moments_of(given)) {}

Technique::Technique(const Settings& given, const LightFrame& known)
    : settings((validate(given, known.kind), given)),
      frame(known),
      bias(given.bias),
      filter(&find_filter(given.filter.kind)),
      taps(tap_pattern(given)),
      moments(moments_of(given)) {}

Technique Technique::at(const LightFrame& other) const {
  Technique moved = *this;
  moved.frame = other;
  return moved;
}

}  // namespace noonmark
