#include "app/sweep/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "app/advise/engine_trial.h"
#include "app/advise/recommend.h"
#include "app/definition/default_folder.h"
#include "app/pictures/capture.h"
#include "app/pictures/frame_pictures.h"
#include "app/pictures/pictures.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

constexpr const char* list_name = ".noonmark-files";
constexpr std::string_view list_head =
    "# The files that Noonmark made in this folder. It replaces these, and no others.\n";

bool is_there(const fs::path& path) {
  std::error_code none;
  return fs::exists(fs::symlink_status(path, none));
}

// Of a folder that a verb filled: the files of these names (patterns of fnmatch) in it and in its folders, and then those of the folders that are
// empty. Links are not followed.
void remove_below(const fs::path& folder, std::span<const std::string> names) {
  std::error_code none;
  if (!fs::is_directory(fs::symlink_status(folder, none))) return;
  std::vector<fs::path> folders = {folder};
  for (const auto& entry : fs::recursive_directory_iterator(folder, none)) {
    const bool named = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return fnmatch(name.c_str(), entry.path().filename().c_str(), FNM_PERIOD) == 0;
    });
    if (entry.symlink_status(none).type() == fs::file_type::directory)
      folders.push_back(entry.path());
    else if (named)
      fs::remove(entry.path(), none);
  }
  for (auto one = folders.rbegin(); one != folders.rend(); ++one) fs::remove(*one, none);  // fails unless it is empty
}

}  // namespace

void make_output_folder(const std::string& path) {
  try {
    make_folder(path);
  } catch (const Error& error) {
    throw Error(ErrorKind::usage, fmt::format("{}, or give another --out", error.what()));
  }
}

void make_folder_above(const std::string& file) {
  if (const std::string above = fs::path(file).parent_path().string(); !above.empty()) make_output_folder(above);
}

void require_new_file(const std::string& file, std::string_view ending, bool overwrite) {
  std::error_code none;
  if (!ends_with_any_case(file, ending))
    throw Error(ErrorKind::usage,
                fmt::format("{} does not end in {}, which is the format that is written", file, ending));
  if (fs::is_directory(file, none))
    throw Error(ErrorKind::usage, fmt::format("{} is a folder; give the path of a file with --out", file));
  if (!overwrite && is_there(file))
    throw Error(ErrorKind::usage, fmt::format("{} is there already; choose another --out, or pass --overwrite", file));
}

FolderLock::FolderLock(const std::string& folder)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(descriptor_);
  throw Error(ErrorKind::usage,
              fmt::format("another run is writing into {}; wait for it, or give another --out", folder));
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

MadeFiles::MadeFiles(const std::string& folder) : folder_(folder) {
  if (!is_there(fs::path(folder) / list_name)) return;
  constexpr uint64_t most_bytes = 1 << 20;
  std::string text;
  try {
    text = read_file_below(folder, list_name, most_bytes);
  } catch (const Error& error) {
    throw Error(ErrorKind::usage, fmt::format("{}, or give another --out", error.what()));
  }
  if (!text.starts_with(list_head))
    throw Error(ErrorKind::usage, fmt::format("{}/{}: is not a list that Noonmark wrote; remove it, or give another "
                                              "--out",
                                              folder, list_name));
  std::istringstream lines(text.substr(list_head.size()));
  for (std::string name; std::getline(lines, name);)
    if (!name.empty()) names_.insert(name);
}

std::string MadeFiles::foreign(std::span<const std::string> names) const {
  for (const std::string& name : names)
    if (!has(name) && is_there(fs::path(folder_) / name)) return name;
  return "";
}

void MadeFiles::require_ours(std::span<const std::string> names) const {
  if (const std::string name = foreign(names); !name.empty())
    throw Error(ErrorKind::usage,
                fmt::format("{0}/{1}: would be replaced, and Noonmark's list of this folder ({2}) does not name it, so "
                            "it may be yours; move it away, or give another --out",
                            folder_, name, list_name));
}

void MadeFiles::add(std::span<const std::string> names) {
  names_.insert(names.begin(), names.end());
  write();
}

void MadeFiles::remove(std::span<const std::string> names) {
  const size_t before = names_.size();
  for (const std::string& name : names) {
    if (!has(name)) continue;
    const fs::path path = fs::path(folder_) / name;
    std::error_code error;
    if (const fs::file_status status = fs::symlink_status(path, error);
        (fs::is_regular_file(status) || fs::is_symlink(status)) && !fs::remove(path, error) && error)
      throw Error(ErrorKind::file,
                  fmt::format("{}: this file of an earlier run cannot be removed: {}; remove it, or give another --out",
                              path.string(), error.message()));
    names_.erase(name);
  }
  if (names_.size() != before) write();
}

void MadeFiles::forget_absent(std::span<const std::string> names) {
  const size_t before = names_.size();
  for (const std::string& name : names)
    if (!is_there(fs::path(folder_) / name)) names_.erase(name);
  if (names_.size() != before) write();
}

void MadeFiles::write() const {
  const std::string path = folder_ + "/" + list_name;
  std::error_code none;
  if (names_.empty()) {
    fs::remove(path, none);
    return;
  }
  std::string text(list_head);
  for (const std::string& name : names_) text += name + "\n";
  write_file_atomically(path, text);
}

OutputFolder::OutputFolder(const VerbOutputs& outputs) : outputs_(outputs) {
  std::error_code none;
  if (fs::is_directory(outputs.folder, none)) take();
}

OutputFolder::~OutputFolder() {
  if (!made_) return;
  try {
    MadeFiles(outputs_.folder).forget_absent(outputs_.all());
  } catch (const Error&) {
    // The list then names more than there is.
  }
}

void OutputFolder::make() {
  make_output_folder(outputs_.folder);
  if (!lock_) take();
  clear_abandoned_files(outputs_.folder);
  MadeFiles(outputs_.folder).add(outputs_.all());
  made_ = true;
}

void OutputFolder::take() {
  lock_.emplace(outputs_.folder);
  MadeFiles made(outputs_.folder);
  made.require_ours(outputs_.all());
  std::error_code none;
  for (const std::string& name : outputs_.files)
    if (fs::is_directory(fs::symlink_status(fs::path(outputs_.folder) / name, none)))
      throw Error(ErrorKind::usage,
                  fmt::format("{}/{}: is a folder, where a file would be written; move it away, or give another --out",
                              outputs_.folder, name));
  if (!outputs_.inner.empty() && made.has(outputs_.inner))
    remove_below(fs::path(outputs_.folder) / outputs_.inner, outputs_.inner_files);
  made.remove(outputs_.all());
}

void retract(const VerbOutputs& outputs) try {
  std::error_code none;
  if (!fs::is_directory(outputs.folder, none)) return;
  const FolderLock lock(outputs.folder);
  MadeFiles(outputs.folder).remove(outputs.files);
} catch (const Error& error) {
  if (error.kind() != ErrorKind::usage) throw;  // another run's folder, or a user's
}

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
