#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/advise/engines/engine.h"
#include "app/advise/map_places.h"

namespace noonmark {
namespace {

// Lines have 6 digits, so amounts that differ by less than half a unit of the last are one number.
constexpr double same_amount = 5e-6;

bool alike(std::span<const double> values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least <= same_amount * std::max(std::abs(*least), std::abs(*most));
}

// A filtered map has no casters that move: a depth that is added to each stored one is the same as one that is taken from the
// receiver's, because lookups see their difference. Empty if that is not so.
std::vector<const BiasPart*> parts_of(const EngineKnob& knob, bool filtered) {
  if (!filtered || knob.target() != BiasTarget::caster) return knob.parts();
  if (knob.form() == BiasForm::constant) return {&bias_part("constant")};
  return {};
}

// Parts of a bias, one number for each map: in texels of the map, or in `unit`, which is metres or depth.
class Amounts {
 public:
  Amounts(std::span<const AdvicePlace> places, BiasUnit unit) : places_(places), unit_(unit) {}

  void add(const BiasPart& part, std::span<const double> metres) {
    std::vector<double>& sums = of_.try_emplace(part.name, places_.size(), 0.0).first->second;
    const std::vector<double> amounts = in_unit(part, metres);
    for (size_t k = 0; k < sums.size(); ++k) sums[k] += amounts[k];
  }

  bool one_number(const BiasPart& part, std::span<const double> metres) const { return alike(in_unit(part, metres)); }

  // Writes them. Parts of the compared depth may differ from map to map by one factor of all, cascades.bias_scales. Returns the
  // part that differs otherwise, or null.
  const BiasPart* write(Settings& settings) const {
    settings.bias = {};
    settings.bias.unit = unit_;
    std::vector<double> scales;
    for (const auto& [name, amounts] : of_) {
      const BiasPart& part = bias_part(name);
      settings.bias[name] += amounts.front();
      if (part.acts_on != BiasTarget::compared_depth) {
        if (!alike(amounts)) return &part;
        continue;
      }
      if (amounts.front() == 0) return &part;
      std::vector<double> own;
      for (const double amount : amounts) own.push_back(amount / amounts.front());
      if (scales.empty()) scales = own;
      for (size_t k = 0; k < own.size(); ++k)
        if (!(own[k] > 0) || std::abs(own[k] / scales[k] - 1) > same_amount) return &part;
    }
    if (!alike(scales.empty() ? std::vector<double>{1} : scales)) settings.cascades.bias_scales = scales;
    return nullptr;
  }

 private:
  std::vector<double> in_unit(const BiasPart& part, std::span<const double> metres) const {
    std::vector<double> amounts(metres.begin(), metres.end());
    for (size_t k = 0; k < amounts.size(); ++k) {
      if (part.unit == "bias.offset_unit") amounts[k] /= places_[k].map.texel_m;
      if (part.unit == "bias.unit" && unit_ == BiasUnit::depth) amounts[k] /= places_[k].range_m();
    }
    return amounts;
  }

  std::span<const AdvicePlace> places_;
  BiasUnit unit_;
  std::map<std::string_view, std::vector<double>> of_;
};

// Sets the bias that acts. The result says why no settings have it; empty: they do.
std::string set_bias(const Engine& engine, std::span<const AdvicePlace> places, const ActingMetres& metres,
                     const std::vector<EngineKnob>& knobs, Settings& settings) {
  const bool filtered = places.front().filter.lookup.has_value();
  const bool of_depth = places.size() > 1 && engine.cascades->bias_of_depth;
  Amounts amounts(places, of_depth ? BiasUnit::depth : BiasUnit::m);
  for (size_t i = 0; i < knobs.size(); ++i) {
    if (std::all_of(metres[i].begin(), metres[i].end(), [](double one) { return one == 0; })) continue;
    const std::vector<const BiasPart*> parts = parts_of(knobs[i], filtered);
    if (parts.empty())
      return fmt::format("Noonmark does not measure what a map of moments shows with {}", knobs[i].field);
    for (const BiasPart* part : parts) {
      // A depth that is added to all that a map stores shows what one shows that is taken from each receiver's, which may differ
      // from cascade to cascade.
      if (knobs[i].form() == BiasForm::constant && !amounts.one_number(*part, metres[i])) part = &bias_part("constant");
      amounts.add(*part, metres[i]);
    }
  }
  if (const BiasPart* differs = amounts.write(settings))
    return fmt::format(
        "bias.{} of Noonmark has one number for all cascades, and with these lines each cascade has another",
        differs->name);
  for (const auto& [part, amount] : engine.always) settings.bias[part] += amount;
  return "";
}

// The map as the lines lay it. The result says why no settings have it; empty: they do.
std::string set_map(const EngineText& of, Settings& settings) {
  if (of.cascades) {
    settings = of.cascades->laid;
    settings.cascades.select = of.engine.cascades->select;
    const std::vector<std::string> unlike = text_lines(of.engine.cascades->unlike, of);
    return unlike.empty() ? "" : unlike.front();
  }
  const AdvicePlace& place = of.place;
  if (place.kind() != LightKind::directional)
    return "a spot or point light's bias changes with the distance in another way here";
  settings = place.settings;
  if (place.filter.lookup) settings.lookup = *place.filter.lookup, settings.map.moments = place.filter.format;
  settings.map.resolution = place.map.resolution;
  if (place.map.reach_m) {
    settings.map.fit = MapFit::sphere;
    settings.map.reach_m = *place.map.reach_m;
    settings.map.extent_m = place.map.extent_m;
    settings.map.extent_scale = 1;
    settings.map.near_m = settings.map.far_m = std::nullopt;
  } else if (fits_view(settings.map.fit)) {
    lay_as(place.frame, settings);  // the lines are numbers: the map stays where the given view needs it
  }
  return "";
}

}  // namespace

void emulate(const EngineText& of, const std::vector<EngineKnob>& knobs, const ActingMetres& metres,
             EngineAdvice& advice) {
  const AdvicePlace& place = of.place;
  Settings settings;
  advice.why_not_emulated = set_map(of, settings);
  if (advice.why_not_emulated.empty() && !place.filter.as)
    advice.why_not_emulated = "no filter of Noonmark has the taps of " + place.filter.what;
  if (!advice.why_not_emulated.empty()) return;
  settings.filter = *place.filter.as;
  advice.why_not_emulated =
      set_bias(of.engine, of.cascades ? std::span(of.cascades->places) : std::span(&place, 1), metres, knobs, settings);
  if (!advice.why_not_emulated.empty()) return;
  settings.map.cull = of.engine.culled(place);
  if (of.engine.map.format) settings.map.format = *of.engine.map.format;
  settings.map.pancake = settings.map.pancake || of.engine.map.pancake;
  if (of.engine.also) of.engine.also(settings, place);
  advice.emulated = std::move(settings);
}

Settings as_engine(const EngineAdvice& advice, Settings condition) {
  const Settings& engine = *advice.emulated;
  const int placements = condition.map.placements;
  condition.bias = engine.bias;
  condition.filter = engine.filter;
  condition.lookup = engine.lookup;
  if (engine.cascades.count > 1 || engine.map.fit == MapFit::sphere) {
    condition.map = engine.map;
    condition.map.placements = placements;
    if (engine.cascades.count > 1) {
      condition.cascades = engine.cascades;
      condition.view.near_m = engine.view.near_m;  // the lines set it
    }
    return condition;
  }
  if (fits_view(condition.map.fit)) {
    condition.light = engine.light;
    condition.map = engine.map;
    condition.map.placements = placements;
  }
  condition.map.resolution = engine.map.resolution;
  condition.map.cull = engine.map.cull;
  condition.map.format = engine.map.format;
  condition.map.moments = engine.map.moments;
  condition.map.pancake = engine.map.pancake;
  return condition;
}

}  // namespace noonmark
