#include "app/sweep/verb_outputs.h"

#include <fmt/format.h>

#include <stdexcept>

#include "app/advise/engine_trial.h"
#include "app/advise/recommend.h"
#include "app/definition/default_folder.h"
#include "app/pictures/capture.h"
#include "app/pictures/frame_pictures.h"
#include "app/pictures/pictures.h"

namespace noonmark {

namespace {

constexpr const char* frames_folder = "frames";  // of a capture

VerbOutputs outputs_of_recommend(const std::string& out) {
  VerbOutputs outputs{out, {"engines.txt", "recommended.json", "recommended.txt"}};
  std::vector<std::string> stems = {"recommended"};
  for (const AnswerKind kind : answer_kinds) stems.push_back("recommended-" + answer_name(kind));
  for (const std::string& stem : stems) {
    outputs.files.push_back(stem + ".toml");
    for (const std::string_view name : picture_names) outputs.files.push_back(fmt::format("{}-{}.png", stem, name));
  }
  outputs.inner = trial_folder;
  // What examples/engines/shoot.mjs and the pages write for it, beside what the trial writes.
  outputs.inner_files = {"scene.glb",      "lines.txt",     "shoot.log", "frame.json",
                         "visibility.npy", "positions.npy", "map.npy"};
  return outputs;
}

}  // namespace

std::vector<std::string> VerbOutputs::all() const {
  std::vector<std::string> names = files;
  if (!inner.empty()) names.push_back(inner);
  return names;
}

VerbOutputs outputs_of(std::string_view verb, const std::string& subject, const std::string& out) {
  const auto folder = [&](const std::string& by_default) { return out.empty() ? by_default : out; };
  if (verb == "map") return {folder(default_folder(subject, "map-")), {"phase.html", "phase.csv"}};
  if (verb == "inspect") return {folder(default_folder(subject, "inspect-")), {"view.png"}};
  if (verb == "judge") {
    VerbOutputs judge{folder(default_folder(subject, "judge-")), {"judge.json", "frame.exr"}};
    for (const std::string_view name : frame_picture_names) judge.files.push_back(fmt::format("frame-{}.png", name));
    if (!is_capture(subject)) return judge;
    judge.inner = frames_folder;
    judge.inner_files = capture_files();
    return judge;
  }
  if (verb == "capture") return {folder(default_folder(subject, "capture-")), {}, frames_folder, capture_files()};
  if (verb == "texels") return {out, {"texels.toml", "texels.json"}};
  if (verb == "recommend") return outputs_of_recommend(out);
  if (verb != "render") throw std::logic_error(fmt::format("the outputs of {} are not listed", verb));
  VerbOutputs render{folder("out/render"), {"point.json", "ladder.exr", "map.exr"}};
  for (const std::string_view name : picture_names) render.files.push_back(fmt::format("point-{}.png", name));
  for (const std::string_view name : debug_picture_names) render.files.push_back(fmt::format("point-{}.png", name));
  return render;
}

}  // namespace noonmark
