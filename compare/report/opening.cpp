#include "compare/report/opening.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/judge/bounds.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/recommendation.h"
#include "compare/report/lights_section.h"
#include "compare/report/part_answers.h"
#include "compare/report/point_data.h"
#include "compare/report/speed.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

constexpr std::string_view bias_separator = " at ";  // no picture's own name has it

const PointRecord* point_to_open(const Findings& found) {
  const Results& results = found.all;
  for (const BoundResult& bound : results.bounds)
    // A bound of the whole frame names its first light, which may have no part in it.
    if (const PointRecord* point =
            breaks(bound) && !bound.metric.starts_with("lights_") ? find_point(results.points, bound.point) : nullptr;
        point && live_image(*point))
      return point;
  if (found.headline) {
    const PointRecord* worst = nullptr;
    for (const PointRecord& point : results.points)
      if (point.part == found.headline->part && live_image(point) &&
          (!worst || metric_of(point, "error") > metric_of(*worst, "error")))
        worst = &point;
    if (worst) return worst;
  }
  if (const PointRecord* light = largest_light(results); light && live_image(*light)) return light;
  if (const PointRecord* answer = answer_point(found); answer && live_image(*answer)) return answer;
  const auto first = std::find_if(results.points.begin(), results.points.end(),
                                  [](const PointRecord& point) { return live_image(point) != nullptr; });
  return first == results.points.end() ? nullptr : &*first;
}

}  // namespace

bool opens_as_set(const Findings& found) {
  return !passes(found.verdict) || found.headline || largest_light(found.all);
}

const ImageRecord* live_image(const PointRecord& point) {
  for (const ImageRecord& image : point.images)
    if (image.path.ends_with("-live.bin")) return &image;
  return nullptr;
}

const PointRecord* answer_point(const Findings& found) {
  const Results& results = found.all;
  const std::vector<const PointRecord*>& answered = found.recommended.choice.points;
  if (!has_parts(results)) return answered.empty() ? nullptr : answered.front();
  const ComparedChoice* const choice = answer_of_parts(results, found.groups);
  if (!choice) return nullptr;
  const PointRecord* const worst = value_of(*choice, error_shown_first(results)).at;
  return worst ? worst : &choice->choice.first();
}

Opening opening(const Findings& found) {
  Opening first{point_to_open(found), {}};
  if (!first.point || opens_as_set(found)) return first;
  const std::map<int64_t, double> biases = recommended_biases(found);
  const auto bias = biases.find(first.point->id);
  if (bias != biases.end() && number_of(setting_of(*first.point, curve_parameter(*first.point))) != bias->second)
    first.bias = bias->second;
  return first;
}

std::string name_at_bias(std::string_view picture, double bias) {
  return fmt::format("{}{}{}", picture, bias_separator, bias);
}

std::optional<NameAtBias> bias_in_name(const std::string& name) {
  const size_t at = name.find(bias_separator);
  if (at == name.npos) return std::nullopt;
  // NaN, which is never a recommended bias, if the rest is no number: a store can have been edited.
  return NameAtBias{name.substr(0, at), number_of(name.substr(at + bias_separator.size())).value_or(std::nan(""))};
}

std::string at_recommended_bias(std::string_view picture) { return fmt::format("{} as recommended", picture); }

std::vector<PictureRecord> pictures_for_page(const PointRecord& point, const std::map<int64_t, double>& biases) {
  std::vector<PictureRecord> shown;
  const auto recommended = biases.find(point.id);
  for (PictureRecord picture : point.pictures) {
    if (const std::optional<NameAtBias> at = bias_in_name(picture.name)) {
      if (recommended == biases.end() || at->bias != recommended->second) continue;
      picture.name = at_recommended_bias(at->picture);
    }
    shown.push_back(std::move(picture));
  }
  return shown;
}

}  // namespace noonmark::report
