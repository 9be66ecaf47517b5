#include "app/sweep/verb_outputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "app/definition/default_folder.h"
#include "app/pictures/frame_pictures.h"
#include "app/pictures/pictures.h"
#include "base/error.h"

namespace noonmark {

namespace fs = std::filesystem;

VerbOutputs outputs_of(std::string_view verb, const std::string& subject, const std::string& out) {
  const auto folder = [&](const std::string& by_default) { return out.empty() ? by_default : out; };
  if (verb == "map") return {folder(default_folder(subject, "map-")), {"phase.html", "phase.csv"}};
  if (verb == "inspect") return {folder(default_folder(subject, "inspect-")), {"view.png"}};
  if (verb == "judge") {
    VerbOutputs judge{folder(default_folder(subject, "judge-")), {"judge.json", "frame.exr"}};
    for (const std::string_view name : frame_picture_names) judge.files.push_back(fmt::format("frame-{}.png", name));
    return judge;
  }
  if (verb != "render") throw std::logic_error(fmt::format("the outputs of {} are not listed", verb));
  VerbOutputs render{folder("out/render"), {"point.json", "ladder.exr", "map.exr"}};
  for (const std::string_view name : picture_names) render.files.push_back(fmt::format("point-{}.png", name));
  for (const std::string_view name : debug_picture_names) render.files.push_back(fmt::format("point-{}.png", name));
  return render;
}

void retract(const VerbOutputs& outputs) {
  for (const std::string& file : outputs.files) {
    const fs::path path = fs::path(outputs.folder) / file;
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (!fs::is_regular_file(status) && !fs::is_symlink(status)) continue;
    if (!fs::remove(path, error) && error)
      throw Error(ErrorKind::file,
                  fmt::format("{}: this file of an earlier run cannot be removed: {}; remove it, or give "
                              "another --out",
                              path.string(), error.message()));
  }
}

}  // namespace noonmark
