#include "app/verbs/judge_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/pictures/frame_pictures.h"
#include "app/pictures/given_frame.h"
#include "app/pictures/image_file.h"
#include "app/sweep/frame_map.h"
#include "base/error.h"
#include "base/text.h"
#include "compare/judge/undecided.h"
#include "compare/ladder/measure.h"
#include "compare/report/cause_colors.h"
#include "compare/results/metrics.h"
#include "compare/results/number_text.h"
#include "raytrace/tracer.h"
#include "scenes/library.h"
#include "technique/light_kind.h"
#include "technique/setting_json.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

// What is judged: the scene, and the frame that shows it.
struct Subject {
  Scene scene;
  GivenFrame frame;
  JudgeRules rules;
  TruthMethod method = TruthMethod::automatic;
};

Subject subject_of(const JudgeOptions& options) {
  std::optional<Subject> subject;
  if (options.picture.empty()) {
    FrameFile file = read_frame_file(options.subject);
    if (options.without_map) file.map.reset();
    Scene scene = scene_of(file);
    GivenFrame frame = given_frame(file, scene);
    subject.emplace(Subject{std::move(scene), std::move(frame), rules_of(file)});
  } else {
    ExperimentArguments arguments = options.arguments;
    take_scene(arguments, options.subject);
    const Settings settings = points(experiment_from("", arguments)).at(0);
    Scene scene = make_scene(settings.scene);
    GivenFrame frame =
        given_frame(options.picture, options.srgb ? ValueEncoding::srgb : ValueEncoding::linear, scene, settings);
    subject.emplace(Subject{std::move(scene), std::move(frame), {}});
    subject->rules.standard_error = settings.truth.standard_error;
    subject->method = settings.truth.method;
  }
  subject->rules.accepted.insert(options.accepted.begin(), options.accepted.end());
  if (options.edge_pixels_given) {
    subject->rules.edge_m.reset();
    subject->rules.edge_pixels = options.edge_pixels;
  }
  if (options.edge_m) subject->rules.edge_m = options.edge_m;
  if (options.contact_m) subject->rules.contact_m = options.contact_m;
  return std::move(*subject);
}

std::string_view state_text(const CheckResult& check) {
  if (check.state == CheckState::passed) return "ok";
  if (check.state == CheckState::not_checked) return "not checked";
  return check.accepted ? "accepted" : "FAILED";
}

void print_verdict(const Subject& subject, const FrameVerdict& verdict) {
  const auto value = [&](std::string_view name) { return verdict.metrics.at(std::string(name)); };
  fmt::print("{}: {:.0f} receivers, {:.0f} face the light, {:.0f} counted", printable(subject.frame.name),
             value("receivers"), value("facing"), value("counted"));
  if (value("facing") > 0) fmt::print(" ({:.4f}% ambiguous)", 100 * value("ambiguous"));
  fmt::print("\n");
  for (const std::string& note : subject.frame.notes) fmt::print("  {}\n", printable(note));
  fmt::print("\n  the delivery\n");
  for (const CheckResult& check : verdict.checks)
    fmt::print("  {:<12}{:<13}{}\n", check.name, state_text(check), printable(check.says));
  if (verdict.refused()) return;
  fmt::print("\n  {:<14}{:>11.5f}%   mean |frame - truth|\n", "frame_error", 100 * value("frame_error"));
  fmt::print("  {:<14}{:>11.5f}%   share of receivers that are off by more than a half\n\n", "frame_wrong",
             100 * value("frame_wrong"));
  fmt::print("  the error by place (edge: within {:.3g} m of a true edge; contact: occluder nearer than {:.3g} m)\n",
             verdict.edge_m, verdict.contact_m);
  for (const FrameClassRow& row : frame_classes)
    if (row.what != FrameClass::missing || !subject.frame.not_in_map.empty())
      fmt::print("  {:<14}{:>11.5f}%   {}\n", row.metric, 100 * value(row.metric), row.label);
  if (verdict.worst.x >= 0)
    fmt::print("\n  the largest error is {:.3f}, at x = {}, y = {} (row 0 on top)\n",
               verdict.error.at(verdict.worst.x, verdict.worst.y), verdict.worst.x, verdict.worst.y);
}

// Of a light of a capture: the answer, what was found, and the checks that are not held. The frame.json has the rest.
void print_capture(const Subject& subject, const FrameVerdict& verdict, const std::string& summary) {
  fmt::print("{}\n", printable(summary));
  for (const std::string& note : subject.frame.notes) fmt::print("  {}\n", printable(note));
  for (const CheckResult& check : verdict.checks)
    if (check.state == CheckState::failed) fmt::print("  check {}: {}\n", check.name, printable(check.says));
  if (verdict.worst.x >= 0 && !verdict.refused())
    fmt::print("  the largest error is {:.3f}, at x = {}, y = {} (row 0 on top), of {:.0f} receivers\n",
               verdict.error.at(verdict.worst.x, verdict.worst.y), verdict.worst.x, verdict.worst.y,
               verdict.metrics.at("counted"));
}

// A cause of a frame with its own map, as it is printed and written.
struct FrameCause {
  std::string name, label;
  double part;  // of frame_error
  double size;  // the metric
};

std::vector<FrameCause> causes_of_frame(const FrameVerdict& verdict, const Ladder& ladder) {
  PointRecord record;
  record.causes = ladder.brought;
  record.metrics = verdict.metrics;
  const std::vector<double> parts = parts_of_error(ladder);
  std::vector<FrameCause> causes;
  for (const CauseColor& cause : causes_of({&record, 1}))
    for (size_t c = 0; c < parts.size(); ++c)  // sums of others are no images of the ladder
      if (ladder.causes[c].name == cause.name)
        causes.push_back(
            {std::string(cause.name), std::string(cause.label), parts[c], verdict.metrics.at(std::string(cause.name))});
  return causes;
}

// By the rungs of the frame's own map.
void print_causes(const FrameVerdict& verdict, const Ladder& ladder) {
  fmt::print(
      "\n  the error by cause, from the frame's own map and its declared lookup\n"
      "  {:<14}{:>12}{:>12}\n",
      "", "its part", "by itself");
  for (const FrameCause& cause : causes_of_frame(verdict, ladder))
    fmt::print("  {:<14}{:>11.5f}%{:>11.5f}%   {}\n", cause.name, 100 * cause.part, 100 * cause.size, cause.label);
  fmt::print(
      "  the parts sum to frame_error; where causes of opposite signs meet in a pixel they cancel, so by itself a "
      "cause can "
      "be more than its part\n"
      "  acne here is what map and bias make dark; frame_acne above is a place, whatever made it dark\n"
      "  at {:.5f}% of the receivers the frame is not what that lookup gives\n",
      100 * verdict.metrics.at(std::string(frame_lookup_differs)));
  if (!verdict.bias.empty()) fmt::print("  {}\n", verdict.bias);
}

nlohmann::ordered_json frame_json(const Subject& subject, const FrameVerdict& verdict,
                                  const std::vector<BoundResult>& bounds, const Ladder* ladder) {
  using Json = nlohmann::ordered_json;
  Json checks = Json::array(), judged = Json::array(), metrics = Json::object();
  for (const CheckResult& check : verdict.checks)
    checks.push_back({{"name", check.name}, {"state", state_text(check)}, {"says", check.says}});
  if (!verdict.refused())
    for (const auto& [name, value] : verdict.metrics) metrics[name] = number_json(value);
  for (const BoundResult& bound : bounds)
    judged.push_back({{"bound", bound_text(bound)}, {"held", bound.held}, {"found", number_json(bound.found)}});
  Json all{{"scene", subject.scene.name},
           {"frame", subject.frame.name},
           {"refused", verdict.refused()},
           {"checks", std::move(checks)},
           {"metrics", std::move(metrics)},
           {"edge_m", number_json(verdict.edge_m)},
           {"contact_m", number_json(verdict.contact_m)},
           {"worst", {{"x", verdict.worst.x}, {"y", verdict.worst.y}}},
           {"bounds", std::move(judged)}};
  if (!verdict.bias.empty()) all["bias"] = verdict.bias;
  if (!subject.frame.notes.empty()) all["notes"] = subject.frame.notes;
  if (ladder)
    for (const FrameCause& cause : causes_of_frame(verdict, *ladder))
      all["causes"][cause.name] = {{"part", number_json(cause.part)}, {"size", number_json(cause.size)}};
  return all;
}

// " (directional, map 1024 x 1024 D24, pass 47-85): error 0.767%, edge 0.281%, acne 0.269%", the largest part first. Of the notes
// it has the head of those about the map.
std::string summary_of(const Subject& subject, const FrameVerdict& verdict, const Ladder* ladder) {
  std::string text = fmt::format(" ({}", kind_of_light(subject.frame.light.kind).name());
  for (const std::string& note : subject.frame.notes)
    if (note.starts_with("map ")) text += ", " + note.substr(0, note.find(':'));
  text += "): ";
  if (verdict.refused()) {
    text += "refused by";
    for (const CheckResult& check : verdict.checks)
      if (check.state == CheckState::failed && !check.accepted) text += fmt::format(" {}", check.name);
    return text;
  }
  std::vector<FrameCause> parts;
  if (ladder)
    parts = causes_of_frame(verdict, *ladder);
  else
    for (const FrameClassRow& row : frame_classes)
      parts.push_back({std::string(row.metric.substr(std::string_view("frame_").size())), "",
                       verdict.metrics.at(std::string(row.metric)), 0});
  std::stable_sort(parts.begin(), parts.end(),
                   [](const FrameCause& a, const FrameCause& b) { return std::abs(a.part) > std::abs(b.part); });
  text += fmt::format("error {}", quantity_text(verdict.metrics.at("frame_error"), "fraction", 3));
  for (const FrameCause& one : parts)
    if (one.part != 0) text += fmt::format(", {} {}", one.name, quantity_text(one.part, "fraction", 3));
  if (!verdict.bias.empty()) text += "; " + verdict.bias;
  return text;
}

// The ladder of a frame with its own map; empty without one, or where the map refuses the frame or explains nothing of it.
std::optional<Ladder> climb(const JudgeOptions& options, const Subject& subject, const raytrace::Tracer& tracer,
                            FrameVerdict& verdict) {
  if (!subject.frame.map || verdict.refused()) return std::nullopt;
  CheckResult& check = *std::find_if(verdict.checks.begin(), verdict.checks.end(),
                                     [](const CheckResult& one) { return one.name == map_check; });
  std::optional<Ladder> ladder;
  try {
    ladder = FrameMap(subject.scene, tracer).climb(subject.frame, check.accepted, verdict);
  } catch (const Error& error) {
    if (!options.map_may_fail || error.kind() != ErrorKind::file) throw;
    check = {map_check, CheckState::failed, error.what(), false};
  }
  if (options.map_may_fail && check.state == CheckState::failed && !check.accepted) {
    check.accepted = true;
    check.says += "; so the error has classes by place, and no causes";
  }
  return ladder;
}

}  // namespace

JudgedFrame judge_frame_file(const JudgeOptions& options, const std::vector<Bound>& bounds, const std::string& folder,
                             const std::string& stem, const std::function<void()>& make_folder) {
  const Subject subject = subject_of(options);
  const raytrace::Tracer tracer(subject.scene, subject.method);
  FrameVerdict verdict = judge_frame(subject.scene, tracer, subject.frame, subject.rules);
  const std::optional<Ladder> climbed = climb(options, subject, tracer, verdict);
  const Ladder* const ladder = climbed ? &*climbed : nullptr;

  Results results;
  PointRecord& record = results.points.emplace_back();
  record.metrics = verdict.metrics;
  record.settings["given.frame"] = subject.frame.name;
  for (const CheckResult& check : verdict.checks)
    if (check.state == CheckState::failed && !check.accepted) record.delivery.refused = check.says;
  if (!verdict.refused())
    results.bounds =
        evaluate_bounds(results.points, bounds, [&](const PointRecord&) { return options.arguments.command; });
  const std::vector<BoundResult>& judged = results.bounds;

  make_folder();
  write_frame_pictures(verdict, subject.frame, ladder, folder, ".", stem);
  write_frame_exr(verdict, subject.frame, ladder, fmt::format("{}/{}.exr", folder, stem),
                  fmt::format("./{}.exr", stem));
  JudgedFrame frame{verdict_of(results), frame_json(subject, verdict, judged, ladder),
                    summary_of(subject, verdict, ladder)};
  if (options.arguments.json) return frame;
  if (options.map_may_fail) {
    print_capture(subject, verdict, stem + frame.summary);
  } else {
    print_verdict(subject, verdict);
    if (ladder) print_causes(verdict, *ladder);
  }
  for (const BoundResult& bound : judged)
    fmt::print("{}  {}: {}, found {}\n", &bound == &judged.front() ? "\n" : "", bound.held ? "held" : "BROKEN",
               bound_text(bound), found_text(bound, {&record, 1}));
  if (const std::string doubt = ambiguous_note(record); !doubt.empty() && !verdict.refused())
    fmt::print("  note: {}\n", doubt);
  if (const std::string note = notes_line(subject.scene); !note.empty()) fmt::print("  note: {}\n", printable(note));
  if (verdict.refused())
    fmt::print(
        stderr,
        "noonmark: {}: the frame is not what was declared, so its shadows are not judged; deliver it anew, or judge it "
        "all the same with --accept NAME\n",
        printable(subject.frame.name));
  return frame;
}

}  // namespace noonmark
