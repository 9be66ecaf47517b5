#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/definition/frame_metrics.h"
#include "app/definition/share_text.h"
#include "app/pictures/frame_pictures.h"
#include "app/pictures/given_frame.h"
#include "app/pictures/image_file.h"
#include "app/sweep/frame_map.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/experiment_arguments.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/build_facts.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "base/threads.h"
#include "compare/judge/bounds.h"
#include "compare/judge/undecided.h"
#include "compare/judge/verdict.h"
#include "compare/ladder/measure.h"
#include "compare/report/cause_colors.h"
#include "compare/results/metrics.h"
#include "frames/frame_keys.h"
#include "frames/judge.h"
#include "raytrace/tracer.h"
#include "scenes/library.h"
#include "technique/setting_json.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

struct JudgeOptions {
  std::string subject;  // a frame.json, or a scene
  std::string picture;  // of a scene: the visibility
  bool srgb = false;
  std::vector<std::string> accepted;
  std::vector<std::string> most;  // "frame_acne=0.05%"
  std::optional<double> edge_m, contact_m;
  double edge_pixels = JudgeRules().edge_pixels;
  bool edge_pixels_given = false;
  bool without_map = false;
  ExperimentArguments arguments;
};

// "frame_acne=0.05%" as a bound.
Bound bound_of(const std::string& text) {
  const size_t equals = text.find('=');
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::usage, fmt::format("--max {}: {}", text, why));
  };
  if (equals == text.npos || equals == 0) refuse("write NAME=VALUE, for example frame_acne=0.05%");
  Bound bound;
  bound.metric = text.substr(0, equals);
  const std::string value = text.substr(equals + 1);
  if (find_metric(bound.metric).unit == "fraction") {
    bound.max = share_from(value);
    if (!bound.max || *bound.max < 0 || *bound.max > 1)
      refuse(fmt::format("'{}' is not a share: a number from 0 to 1, or a percentage such as 0.05%", value));
  } else {
    double number = 0;
    const auto [end, fault] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (fault != std::errc{} || end != value.data() + value.size()) refuse(fmt::format("'{}' is not a number", value));
    bound.max = number;
  }
  check_bound(bound);
  require_frame_metric(bound.metric);
  return bound;
}

// A setting of Noonmark's own technique or picture says nothing about a frame that is there already.
void require_used(const std::string& assignment) {
  const std::string name = assignment.substr(0, assignment.find('='));
  const auto starts = [&](std::string_view group) { return name.starts_with(group); };
  if (name == "scene.name")
    throw Error(ErrorKind::usage, "--set scene.name: the scene is the argument before --picture");
  const bool of_picture = name == "view.width_px" || name == "view.height_px";
  if (!of_picture && (starts("scene.") || starts("view.") || starts("light.") || starts("truth."))) return;
  find_setting(name);  // an unknown name has its own message
  throw Error(ErrorKind::usage, fmt::format("--set {}: {}", name,
                                            of_picture ? "the picture's own size counts; leave it out"
                                                       : "judge draws nothing, so only scene.*, view.*, light.* and "
                                                         "truth.* have an effect; leave it out"));
}

// What is judged: the scene, and the frame that shows it.
struct Subject {
  Scene scene;
  GivenFrame frame;
  JudgeRules rules;
  TruthMethod method = TruthMethod::automatic;
};

Subject subject_of(const JudgeOptions& options) {
  const bool is_file = ends_with_any_case(options.subject, ".json");
  if (std::error_code none; std::filesystem::is_directory(options.subject, none))
    throw Error(ErrorKind::usage, fmt::format("{} is a folder; give the frame.json in it", options.subject));
  if (options.picture.empty())
    for (const char* ending : {".exr", ".png", ".npy"})
      if (ends_with_any_case(options.subject, ending))
        throw Error(ErrorKind::usage, fmt::format("{} is a picture; write noonmark judge SCENE --picture {}",
                                                  options.subject, options.subject));
  if (is_file != options.picture.empty())
    throw Error(ErrorKind::usage, is_file
                                      ? "a frame.json names its picture itself; --picture is for a scene"
                                      : fmt::format("{} is a scene: give the frame's visibility with --picture, or a "
                                                    "frame.json in the scene's place",
                                                    options.subject));
  std::optional<Subject> subject;
  if (is_file) {
    if (options.srgb || !options.arguments.sets.empty())
      throw Error(
          ErrorKind::usage,
          "a frame.json says camera, light and encoding itself; --set and --srgb are for a scene with --picture");
    FrameFile file = read_frame_file(options.subject);
    if (options.without_map) file.map.reset();
    Scene scene = scene_of(file);
    GivenFrame frame = given_frame(file, scene);
    subject.emplace(Subject{std::move(scene), std::move(frame), rules_of(file)});
  } else {
    for (const std::string& assignment : options.arguments.sets) require_used(assignment);
    if (options.without_map)
      throw Error(ErrorKind::usage, "--without-map is for a frame.json that names a map; leave it out");
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
  fmt::print("\n\n  the delivery\n");
  for (const CheckResult& check : verdict.checks)
    fmt::print("  {:<12}{:<13}{}\n", check.name, state_text(check), printable(check.says));
  if (verdict.refused()) return;
  fmt::print("\n  {:<14}{:>11.5f}%   mean |frame - truth|\n", "frame_error", 100 * value("frame_error"));
  fmt::print("  {:<14}{:>11.5f}%   share of receivers that are off by more than a half\n\n", "frame_wrong",
             100 * value("frame_wrong"));
  fmt::print("  the error by place (edge: within {:.3g} m of a true edge; contact: occluder nearer than {:.3g} m)\n",
             verdict.edge_m, verdict.contact_m);
  for (const FrameClassRow& row : frame_classes)
    fmt::print("  {:<14}{:>11.5f}%   {}\n", row.metric, 100 * value(row.metric), row.label);
  if (verdict.worst.x >= 0)
    fmt::print("\n  the largest error is {:.3f}, at x = {}, y = {} (row 0 on top)\n",
               verdict.error.at(verdict.worst.x, verdict.worst.y), verdict.worst.x, verdict.worst.y);
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
}

std::string judge_json(const Subject& subject, const FrameVerdict& verdict, const std::vector<BoundResult>& bounds,
                       const Ladder* ladder, const JudgeOptions& options, const std::string& out, Verdict whole) {
  using Json = nlohmann::ordered_json;
  Json checks = Json::array(), judged = Json::array(), metrics = Json::object();
  for (const CheckResult& check : verdict.checks)
    checks.push_back({{"name", check.name}, {"state", state_text(check)}, {"says", check.says}});
  if (!verdict.refused())
    for (const auto& [name, value] : verdict.metrics) metrics[name] = number_json(value);
  for (const BoundResult& bound : bounds)
    judged.push_back({{"bound", bound_text(bound)}, {"held", bound.held}, {"found", number_json(bound.found)}});
  Json all{{"noonmark", build_facts().version},
           {"command", options.arguments.command},
           {"exit_code", exit_code_of(whole)},
           {"verdict", word_of(whole)},
           {"scene", subject.scene.name},
           {"frame", subject.frame.name},
           {"refused", verdict.refused()},
           {"checks", std::move(checks)},
           {"metrics", std::move(metrics)},
           {"edge_m", number_json(verdict.edge_m)},
           {"contact_m", number_json(verdict.contact_m)},
           {"worst", {{"x", verdict.worst.x}, {"y", verdict.worst.y}}},
           {"bounds", std::move(judged)},
           {"folder", out}};
  if (ladder)
    for (const FrameCause& cause : causes_of_frame(verdict, *ladder))
      all["causes"][cause.name] = {{"part", number_json(cause.part)}, {"size", number_json(cause.size)}};
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

int judge_one(const JudgeOptions& options) {
  const VerbOutputs outputs = outputs_of("judge", options.subject, options.arguments.out);
  OutputFolder folder(outputs);
  std::vector<Bound> bounds;
  for (const std::string& text : options.most) bounds.push_back(bound_of(text));
  const Subject subject = subject_of(options);
  for (const Bound& bound : bounds)
    if (needs_own_map(bound.metric) && !subject.frame.map)
      throw Error(ErrorKind::usage,
                  fmt::format("--max {}: known only of a frame with its own shadow map; {}", bound.metric,
                              options.without_map ? "leave out --without-map"
                                                  : fmt::format("add the key 'map' to {}", options.subject)));
  const raytrace::Tracer tracer(subject.scene, subject.method);
  FrameVerdict verdict = judge_frame(subject.scene, tracer, subject.frame, subject.rules);
  std::optional<Ladder> climbed;
  if (subject.frame.map && !verdict.refused())
    climbed = FrameMap(subject.scene, tracer).climb(subject.frame, subject.rules.accepted.contains("map"), verdict);
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
  const Verdict whole = verdict_of(results);
  const int exit_code = exit_code_of(whole);

  folder.make();
  write_frame_pictures(verdict, subject.frame, ladder, outputs.folder, ".", "frame");
  write_frame_exr(verdict, subject.frame, ladder, outputs.folder + "/frame.exr", "./frame.exr");
  const std::string json = judge_json(subject, verdict, judged, ladder, options, outputs.folder, whole);
  write_file_atomically(outputs.folder + "/judge.json", json);
  if (options.arguments.json) {
    fmt::print("{}", json);
    return exit_code;
  }
  print_verdict(subject, verdict);
  if (ladder) print_causes(verdict, *ladder);
  for (const BoundResult& bound : judged)
    fmt::print("{}  {}: {}, found {}\n", &bound == &judged.front() ? "\n" : "", bound.held ? "held" : "BROKEN",
               bound_text(bound), found_text(bound));
  if (const std::string doubt = ambiguous_note(record); !doubt.empty() && !verdict.refused())
    fmt::print("  note: {}\n", doubt);
  if (const std::string note = notes_line(subject.scene); !note.empty()) fmt::print("  note: {}\n", printable(note));
  fmt::print("\n{0}/judge.json, {0}/frame.exr and {0}/frame-*.png are written\n", printable(outputs.folder));
  if (verdict.refused())
    fmt::print(
        stderr,
        "noonmark: {}: the frame is not what was declared, so its shadows are not judged; deliver it anew, or judge it "
        "all the same with --accept NAME\n",
        printable(subject.frame.name));
  return exit_code;
}

std::vector<std::string> check_names() {
  std::vector<std::string> names;
  for (const FrameCheck& check : frame_checks()) names.emplace_back(check.name);
  return names;
}

RunVerb add_judge(CLI::App& verb) {
  const auto options = std::make_shared<JudgeOptions>();
  ExperimentArguments& arguments = options->arguments;
  verb.add_option("frame", options->subject, "A frame.json, or a scene whose camera and light --set gives")
      ->required()
      ->check(not_empty())
      ->type_name(value_kind::frame);
  verb.add_option(
          "--picture", options->picture,
          "Of a scene: the visibility of the frame, 1 lit and 0 shadowed, -1, NaN or alpha 0 without a surface; the "
          "top row first, one sample at each pixel's centre")
      ->check(not_empty())
      ->type_name(value_kind::picture);
  verb.add_flag("--srgb", options->srgb, "The picture's values are encoded with sRGB's transfer function");
  verb.add_option("--max", options->most, "A bound: the largest value of a metric, frame_acne=0.05% (repeatable)")
      ->expected(1)
      ->take_all()
      ->type_name(value_kind::metric);
  verb.add_option("--accept", options->accepted, "Judge although this check of the delivery fails (repeatable)")
      ->expected(1)
      ->take_all()
      ->check(one_of(check_names()))
      ->type_name(joined(check_names()));
  verb.add_option("--edge-pixels", options->edge_pixels,
                  "How near to a true shadow edge an error belongs to the edge, in pixels at the receiver")
      ->check(number_in(range_of("edge.pixels").numbers))
      ->type_name(value_kind::number)
      ->capture_default_str();
  verb.add_option("--edge-m", options->edge_m, "The same in metres across the light's rays")
      ->check(number_in(range_of("edge.distance").numbers))
      ->type_name(value_kind::number);
  verb.add_option("--contact-m", options->contact_m,
                  "How near an occluder is where light leaks at a contact; without it 1% of the scene's diagonal")
      ->check(number_in(range_of("contact.distance").numbers))
      ->type_name(value_kind::number);
  verb.add_flag("--without-map", options->without_map,
                "Judge by place alone, though frame.json names the frame's shadow map; needs no OpenGL");
  add_sets(verb, arguments);
  add_threads(verb, arguments);
  add_json(verb, arguments, "Print what judge.json says");
  add_out(verb, arguments, "Folder for the files",
          folders_of({"shots/frame.json", "cube-room"},
                     [](const std::string& frame) { return outputs_of("judge", frame, "").folder; }));
  CLI::Option* const pixels = verb.get_option("--edge-pixels");
  return [options, pixels](const std::string& command) {
    options->arguments.command = command;
    options->edge_pixels_given = pixels->count() > 0;
    const ThreadLimit limit(options->arguments.threads);
    return judge_one(*options);
  };
}

}  // namespace

Verb verb_judge() {
  return {"judge", "Judge the shadows of another renderer's frame against the truth, without OpenGL", add_judge};
}

}  // namespace noonmark
