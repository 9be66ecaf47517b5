#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/definition/frame_metrics.h"
#include "app/definition/share_text.h"
#include "app/pictures/capture.h"
#include "app/pictures/given_frame.h"
#include "app/sweep/output_folder.h"
#include "app/verbs/judge_frame.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/build_facts.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "base/threads.h"
#include "compare/results/metrics.h"
#include "frames/frame_keys.h"
#include "technique/setting_json.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

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

// The options that go with what is judged.
void require_fitting(const JudgeOptions& options) {
  const bool of_capture = is_capture(options.subject), is_file = ends_with_any_case(options.subject, ".json");
  if (std::error_code none; std::filesystem::is_directory(options.subject, none))
    throw Error(ErrorKind::usage, fmt::format("{} is a folder; give the frame.json in it", options.subject));
  if (options.picture.empty())
    for (const char* ending : {".exr", ".png", ".npy"})
      if (ends_with_any_case(options.subject, ending))
        throw Error(ErrorKind::usage, fmt::format("{} is a picture; write noonmark judge SCENE --picture {}",
                                                  options.subject, options.subject));
  if (!of_capture && options.capture.any())
    throw Error(ErrorKind::usage, "--light, --filter, --bias and --reader are for a capture (FILE.rdc)");
  if ((is_file || of_capture) != options.picture.empty())
    throw Error(ErrorKind::usage, is_file || of_capture
                                      ? "a frame.json or a capture has its picture itself; --picture is for a scene"
                                      : fmt::format("{} is a scene: give the frame's visibility with --picture, or a "
                                                    "frame.json in the scene's place",
                                                    options.subject));
  if ((is_file || of_capture) && (options.srgb || !options.arguments.sets.empty()))
    throw Error(ErrorKind::usage,
                "a frame.json or a capture says camera, light and encoding itself; --set and --srgb are for a scene "
                "with --picture");
  if (!is_file && !of_capture && options.without_map)
    throw Error(ErrorKind::usage, "--without-map is for a frame.json that names a map; leave it out");
  for (const std::string& assignment : options.arguments.sets) require_used(assignment);
}

// The bounds that a frame can have: some are known only with its own map. Throws Error(usage) where that is none of the frames.
std::vector<Bound> bounds_for(const JudgeOptions& options, const std::vector<Bound>& bounds, bool has_map,
                              bool required) {
  std::vector<Bound> kept;
  for (const Bound& bound : bounds)
    if (has_map || !needs_own_map(bound.metric))
      kept.push_back(bound);
    else if (required)
      throw Error(ErrorKind::usage,
                  fmt::format("--max {}: known only of a frame with its own shadow map; {}", bound.metric,
                              options.without_map           ? "leave out --without-map"
                              : is_capture(options.subject) ? "no light of this capture has a map that can be read"
                                                            : fmt::format("add the key 'map' to {}", options.subject)));
  return kept;
}

bool names_map(const JudgeOptions& options, const std::string& frame) {
  return !options.without_map && ends_with_any_case(frame, ".json") && read_frame_file(frame).map;
}

// What a caller of the program reads first.
nlohmann::ordered_json head_json(const JudgeOptions& options, Verdict whole) {
  return {{"noonmark", build_facts().version},
          {"command", options.arguments.command},
          {"exit_code", exit_code_of(whole)},
          {"verdict", word_of(whole)}};
}

void write_judge_json(const JudgeOptions& options, const std::string& folder, const nlohmann::ordered_json& json) {
  const std::string text = readable_json(json) + "\n";
  write_file_atomically(folder + "/judge.json", text);
  if (options.arguments.json) fmt::print("{}", text);
}

// Each light of a capture, and each map of a light that has several. A frame that cannot be judged does not end the others.
int judge_capture(const JudgeOptions& options, const std::vector<Bound>& bounds, const VerbOutputs& outputs,
                  OutputFolder& folder) {
  const std::vector<std::string> command = capture_command(options.subject, options.capture.reader);
  folder.make();
  const std::string frames = outputs.folder + "/" + outputs.inner;
  const std::vector<std::string> read =
      read_capture(command, frames, options.capture.words(), [&](const std::string& line) {
        int light = 0, end = 0;  // what it says of a light stands beside the verdict of the light
        if (!options.arguments.json && (std::sscanf(line.c_str(), "light %d:%n", &light, &end) < 1 || end == 0))
          print_line(line);
      });
  const auto has_map = [&](const std::string& frame) { return names_map(options, frame); };
  bounds_for(options, bounds, std::any_of(read.begin(), read.end(), has_map), true);
  auto lights = nlohmann::ordered_json::array();
  Verdict worst = bounds.empty() ? Verdict::measured : Verdict::held;
  for (const std::string& path : read) {
    const std::string stem = std::filesystem::path(path).stem().string();
    JudgeOptions of_frame = options;
    of_frame.subject = path;
    of_frame.map_may_fail = true;
    if (!options.arguments.json) fmt::print("\n");
    JudgedFrame frame{Verdict::refused, {{"frame", path}}, ""};
    try {
      frame = judge_frame_file(of_frame, bounds_for(options, bounds, has_map(path), false), frames, stem, [] {});
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::file) throw;
      frame.json["error"] = error.what();
      frame.summary = fmt::format(": {}", error.what());
      if (!options.arguments.json) fmt::print("{}{}\n", stem, printable(frame.summary));
    }
    frame.json["verdict"] = word_of(frame.verdict);
    worst = std::min(worst, frame.verdict);
    frame.json["summary"] = stem + frame.summary;
    lights.push_back(std::move(frame.json));
  }
  nlohmann::ordered_json json = head_json(options, worst);
  json["capture"] = options.subject;
  json["lights"] = std::move(lights);
  json["folder"] = outputs.folder;
  write_judge_json(options, outputs.folder, json);
  if (options.arguments.json) return exit_code_of(worst);
  fmt::print(
      "\n{0}/judge.json and, in {1}, the frames and their pictures are written; noonmark judge {2} prints all of one\n",
      printable(outputs.folder), printable(frames), printable(read.front()));
  return exit_code_of(worst);
}

int judge_one(const JudgeOptions& options) {
  const VerbOutputs outputs = outputs_of("judge", options.subject, options.arguments.out);
  OutputFolder folder(outputs);
  std::vector<Bound> bounds;
  for (const std::string& text : options.most) bounds.push_back(bound_of(text));
  require_fitting(options);
  if (is_capture(options.subject)) return judge_capture(options, bounds, outputs, folder);
  bounds_for(options, bounds, names_map(options, options.subject), true);
  const JudgedFrame frame = judge_frame_file(options, bounds, outputs.folder, "frame", [&] { folder.make(); });
  nlohmann::ordered_json json = head_json(options, frame.verdict);
  json.update(frame.json);
  json["folder"] = outputs.folder;
  write_judge_json(options, outputs.folder, json);
  if (!options.arguments.json)
    fmt::print("\n{0}/judge.json, {0}/frame.exr and {0}/frame-*.png are written\n", printable(outputs.folder));
  return exit_code_of(frame.verdict);
}

std::vector<std::string> check_names() {
  std::vector<std::string> names;
  for (const FrameCheck& check : frame_checks()) names.emplace_back(check.name);
  return names;
}

RunVerb add_judge(CLI::App& verb) {
  const auto options = std::make_shared<JudgeOptions>();
  ExperimentArguments& arguments = options->arguments;
  verb.add_option("frame", options->subject,
                  "A frame.json, a capture of RenderDoc, or a scene whose camera and light --set gives")
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
  add_capture_options(verb, options->capture);
  add_sets(verb, arguments);
  add_threads(verb, arguments);
  add_json(verb, arguments, "Print what judge.json says");
  add_out(verb, arguments, "Folder for the files",
          folders_of({"shots/frame.json", "shots/frame.rdc", "cube-room"},
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
  return {"judge", "Judge the shadows of another renderer's frame against the truth, without OpenGL",
          "noonmark judge frame.json", add_judge};
}

}  // namespace noonmark
