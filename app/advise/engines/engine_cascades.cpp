#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "app/advise/engines/engine.h"
#include "technique/cascade_splits.h"

namespace noonmark {
namespace {

std::vector<double> practical(double near_m, std::span<const double> ends_m, double lambda) {
  CascadeSettings settings;
  settings.lambda = lambda;
  return find_cascade_split("practical").bounds({near_m, ends_m.back(), static_cast<int>(ends_m.size()), settings});
}

std::vector<std::string> numbers_of(std::span<const double> values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(number(value));
  return texts;
}

}  // namespace

double blend_in(const EngineCascades& engine, const CascadeSettings& asked) {
  const bool can = engine.blend_of == asked.blend_of && asked.blend_shape == "linear" &&
                   (!engine.only_blend || engine.only_blend == asked.blend);
  return can ? asked.blend : 0;
}

std::vector<std::string> AdvisedCascades::inner(const std::function<double(double end_m)>& of) const {
  std::vector<std::string> texts;
  for (size_t k = 0; k + 1 < ends_m.size(); ++k) texts.push_back(number(of(ends_m[k])));
  return texts;
}

// Every end is even + lambda (logarithmic - even).
double nearest_lambda(double near_m, std::span<const double> ends_m) {
  const std::vector<double> even = practical(near_m, ends_m, 0), logarithmic = practical(near_m, ends_m, 1);
  double along = 0, squares = 0;
  for (size_t k = 0; k < even.size(); ++k) {
    const double way = logarithmic[k] - even[k];
    along += way * (ends_m[k] - even[k]);
    squares += way * way;
  }
  return squares > 0 ? std::clamp(along / squares, 0.0, 1.0) : 0.5;
}

std::string missed_ends(const AdvisedCascades& cascades, double lambda) {
  constexpr double told = 1e-3;
  const std::vector<double> ends = practical(cascades.near_m, cascades.ends_m, lambda);
  bool right = true;
  for (size_t k = 0; k < ends.size(); ++k) right = right && std::abs(ends[k] / cascades.ends_m[k] - 1) <= told;
  if (right) return "";
  return fmt::format(
      "cascades.splits = {}: the engine knows no ends but those of a lambda. With {} the cascades end at {} m, the "
      "nearest to "
      "the recommended {} m.",
      cascades.settings().cascades.splits, number(lambda), fmt::join(numbers_of(ends), ", "),
      fmt::join(cascades.inner([](double end) { return end; }), ", "));
}

Settings laid_by(const Engine& engine, Settings settings, double near_m, std::span<const double> ends_m) {
  MapSettings& map = settings.map;
  map.reach_m = ends_m.back();
  map.extent_m = map.near_m = map.far_m = std::nullopt;
  map.aspect = 1;
  map.roll_deg = 0;
  map.depth_range = DepthRange::fit;
  map.snap = true;
  settings.view.near_m = near_m;
  settings.map.fit_fov_deg.reset();
  settings.cascades.depths = CascadeDepths::planes;
  settings.cascades.splits = "manual";
  settings.cascades.bounds_m.assign(ends_m.begin(), ends_m.end() - 1);
  settings.cascades.resolutions.clear();
  settings.cascades.bias_scales.clear();
  settings.cascades.select = "depth";
  settings.cascades.blend = blend_in(*engine.cascades, settings.cascades);
  settings.cascades.radius_round_m = engine.cascades->radius_round_m;
  map.fit = engine.cascades->fit;
  map.pancake = map.pancake || engine.map.pancake;
  if (engine.map.width_m) map.resolution = static_cast<int>(std::bit_ceil(static_cast<unsigned>(map.resolution)));
  map.extent_scale = map.resolution / std::max(1.0, static_cast<double>(map.resolution - engine.map.border));
  if (engine.cascades->lay) engine.cascades->lay(settings);
  return settings;
}

std::vector<std::string> unexpressed_cascades(const Engine& engine_row, const AdvisedCascades& cascades) {
  const EngineCascades& engine = *engine_row.cascades;
  const CascadeSettings& asked = cascades.settings().cascades;
  std::vector<std::string> said;
  if (asked.blend != cascades.blend)
    said.push_back(fmt::format(
        "cascades.blend = {} with cascades.blend_of = {}{}: the engine has no such blending{}. The lines switch it "
        "off.",
        number(asked.blend), find_setting("cascades.blend_of").get(cascades.settings()),
        asked.blend_shape == "linear" ? "" : fmt::format(" and cascades.blend_shape = {}", asked.blend_shape),
        engine.other_blending));
  if (asked.select != engine.select)
    said.push_back(fmt::format("cascades.select = {}: the engine chooses a receiver's cascade by its {}.", asked.select,
                               engine.select));
  if (asked.depths != CascadeDepths::planes)
    said.push_back(
        "cascades.depths = visible: the lines lay cascades between the camera's planes, as the engine does.");
  if (!asked.resolutions.empty())
    said.push_back("cascades.resolutions: all maps of the engine have one resolution, map.resolution.");
  std::vector<double> laid, recommended;
  for (const AdvicePlace& place : cascades.places) {
    laid.push_back(place.map.texel_m);
    recommended.push_back(place.texel_m);
  }
  const std::vector<std::string> of_engine = numbers_of(laid), wanted = numbers_of(recommended);
  said.push_back(fmt::format(
      "map.fit = {}: the engine fits each map to {}. Its texels are {} m wide, for which the bias is computed{}. A "
      "wider "
      "picture or another angle of view needs other numbers.",
      find_setting("map.fit").get(cascades.settings()), engine.fitted_to, fmt::join(of_engine, ", "),
      of_engine == wanted ? "; so are the recommended ones"
                          : fmt::format("; the recommended ones are {} m", fmt::join(wanted, ", "))));
  return said;
}

std::string one_for_all(std::string_view field, std::span<const double> typed) {
  constexpr double same = 1.01;  // less is not worth a sentence
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto least = std::min_element(typed.begin(), typed.end(), smaller);
  const auto most = std::max_element(typed.begin(), typed.end(), smaller);
  if (!(std::abs(*most) > same * std::abs(*least))) return "";
  const std::string much =
      *least == 0 ? "and cascade {} needs none" : fmt::format("{:.3g} times what cascade {{}} needs", *most / *least);
  return fmt::format("{} is one number for all cascades. It is what cascade {} needs, {}.", field,
                     most - typed.begin() + 1, fmt::format(fmt::runtime(much), least - typed.begin() + 1));
}

}  // namespace noonmark
