#include "app/sweep/results_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/build_facts.h"
#include "compare/judge/bounds.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/deliveries.h"
#include "compare/judge/laws.h"
#include "compare/results/quantities.h"
#include "technique/setting_json.h"

namespace noonmark {
namespace {

using Json = nlohmann::ordered_json;

Json settings_of(const PointRecord& point, const std::vector<std::string>& names) {
  Json json = Json::object();
  for (const std::string& name : names)
    if (const auto found = point.settings.find(name); found != point.settings.end())
      json[name] = setting_json(find_setting(name), found->second);
  return json;
}

Json point_of(const PointRecord& point, const RunInfo& info) {
  Json json = {{"point", point.id}};
  if (!point.part.empty()) json["part"] = point.part;
  json["settings"] = settings_of(point, info.swept);
  if (judges_frames({&point, 1}))
    json["delivery"] = {{"refused", point.delivery.refused},
                        {"accepted", point.delivery.accepted},
                        {"not_checked", point.delivery.not_checked}};
  json["metrics"] = Json::object();
  for (const auto& [name, value] : point.metrics) json["metrics"][name] = number_json(value);
  if (point.curve) {
    json["curve"] = {{"parameter", point.curve->parameter}};
    for (const CurveQuantity& row : curve_quantities()) {
      const auto& known = known_curve(point);
      const std::optional<double> value = known ? row.value(*known) : std::nullopt;
      json["curve"][row.name] = value ? Json(number_json(*value)) : Json();
    }
  }
  if (point.worst.x >= 0)
    json["worst_pixel"] = {{"x", point.worst.x},
                           {"y", point.worst.y},
                           {"error", number_json(point.worst.error)},
                           {"cause", point.worst.cause}};
  for (const PointRecord::WorstOf& worst : point.worst_of)
    json["worst_pixels"][worst.metric] = {{"x", worst.x}, {"y", worst.y}, {"size", number_json(worst.size)}};
  for (const PointRecord::Cascade& cascade : point.cascades) {
    Json one = {{"begin_m", cascade.begin_m}, {"end_m", cascade.end_m}};
    one["bias_needed"] = cascade.bias_needed ? Json(*cascade.bias_needed) : Json();
    for (const auto& [name, value] : cascade.metrics) one["metrics"][name] = number_json(value);
    json["cascades"].push_back(std::move(one));
  }
  return json;
}

Json bound_of(const BoundResult& bound, std::span<const PointRecord> points) {
  Json json = {{"metric", bound.metric}};
  if (!bound.part.empty()) json["part"] = bound.part;
  if (bound.max) json["max"] = *bound.max;
  if (bound.min) json["min"] = *bound.min;
  json["join"] = bound.join;
  if (!bound.placement.empty()) json["placement"] = bound.placement;
  if (!bound.where.empty()) json["where"] = bound.where;
  json["verdict"] = verdict_of(bound);
  json["found"] = bound.points == 0 ? Json() : Json(number_json(bound.found));
  if (const double room = room_of(bound, points); room > 0) json["found_room"] = number_json(room);
  if (bound.before) json["found_before"] = number_json(*bound.before);
  json["points"] = bound.points;
  json["worst_point"] = bound.point < 0 ? Json() : Json(bound.point);
  if (!bound.held) json["reproduce"] = bound.reproduce;
  return json;
}

Json law_of(const LawResult& law) {
  Json json = {{"name", law.name}};
  if (!law.part.empty()) json["part"] = law.part;
  json["law"] = law_text(law);
  json["verdict"] = law.held ? "held" : "broken";
  json["samples"] = law.samples.size();
  if (law.worst >= 0) {
    const LawResult::Sample& worst = law.samples[static_cast<size_t>(law.worst)];
    json["worst"] = {{"point", worst.point},
                     {"measured", number_json(worst.measured)},
                     {"predicted", number_json(worst.predicted)},
                     {"allowed", number_json(worst.allowed)}};
  }
  if (!law.found.empty()) json["found"] = law.found;
  if (!law.held) json["reproduce"] = law.reproduce;
  return json;
}

Json answer_of(const Recommendation& found, const Results& results) {
  using Outcome = Recommendation::Outcome;
  Json json;
  json["outcome"] = found.outcome == Outcome::found          ? "found"
                    : found.outcome == Outcome::none_holds   ? "none_holds"
                    : found.outcome == Outcome::no_criterion ? "no_criterion"
                                                             : "incomplete";
  if (found.outcome != Outcome::found) return json;
  const PointRecord& first = found.choice.first();
  if (!first.part.empty()) json["part"] = first.part;
  json["points"] = Json::array();
  for (const PointRecord* point : found.choice.points) json["points"].push_back(point->id);
  std::vector<std::string> chosen = choice_settings(results.info);
  if (found.bias) std::erase(chosen, found.bias->parameter);  // the answer's bias is below
  json["settings"] = settings_of(first, chosen);
  if (found.bias)
    json["bias"] = {{"parameter", found.bias->parameter},
                    {"unit", found.bias->unit},
                    {"value", found.bias->value},
                    {"as_set", found.bias->as_set},
                    {"usable_from", found.bias->window.low},
                    {"usable_to", found.bias->window.high}};
  json["cost"] = {{"metric", results.info.cost}, {"value", number_json(found.cost.middle)}};
  if (found.cost.low < found.cost.high)  // a time
    json["cost"]["interval"] = {number_json(found.cost.low), number_json(found.cost.high)};
  json["error"] = {{"metric", results.info.accuracy},
                   {"worst", number_json(found.error.worst)},
                   {"mean", number_json(found.error.mean)},
                   {"p95", number_json(found.error.p95)}};
  return json;
}

}  // namespace

Json results_json(const SweepOutcome& outcome, const Findings& found, const JsonRun& run) {
  const Results& results = outcome.results;
  const RunInfo& info = results.info;
  Json json = {{"experiment", run.experiment}, {"title", info.title}, {"exit_code", run.exit_code}};
  json["verdict"] = word_of(found.verdict);
  json["verdict_text"] = found.sentence;
  json["folder"] = run.folder;
  json["points_planned"] = results.planned_points;
  json["points_measured"] = outcome.measured;
  json["points_kept"] = outcome.kept;
  json["swept"] = info.swept;
  json["conditions"] = info.over;
  json["warnings"] = info.sweep_notes;
  json["notes"] = info.scene_notes;
  json["doubts"] = Json::array();
  for (const Note& note : found.notes)
    if (note.of == Note::Of::picture) json["doubts"].push_back(note.text);
  for (const char* list : {"bounds", "laws"}) json[list] = Json::array();
  for (const BoundResult& bound : results.bounds) json["bounds"].push_back(bound_of(bound, results.points));
  for (const LawResult& law : results.laws) json["laws"].push_back(law_of(law));
  if (const auto& baseline = results.baseline)
    json["baseline"] = {{"held", baseline->held()}, {"compared", baseline->compared}, {"changed", baseline->changed},
                        {"worse", baseline->worse}, {"better", baseline->better},     {"notes", baseline->notes}};
  json["answer"] = answer_of(found.recommended, results);
  json["points"] = Json::array();
  for (const PointRecord& point : results.points) json["points"].push_back(point_of(point, info));
  return json;
}

Json failure_json(const std::string& experiment, const std::string& message, int exit_code) {
  return {{"experiment", experiment}, {"exit_code", exit_code}, {"verdict", "not judged"}, {"error", message}};
}

std::string results_text(const std::string& command, int exit_code, const std::vector<Json>& experiments) {
  const Json json = {{"noonmark", {{"version", build_facts().version}, {"commit", build_facts().commit}}},
                     {"command", command},
                     {"exit_code", exit_code},
                     {"experiments", experiments}};
  return readable_json(json) + "\n";
}

}  // namespace noonmark
