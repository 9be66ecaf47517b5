#include "app/sweep/results_folder.h"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "compare/store/store.h"

namespace noonmark {

namespace fs = std::filesystem;

namespace {

void remove_verdict(const std::string& folder) {
  for (const char* verdict : {"junit.xml", "summary.md"}) {
    std::error_code error;
    fs::remove(fs::path(folder) / verdict, error);
    if (error)
      throw Error(ErrorKind::file, fmt::format("{}/{}: the verdict of an earlier run cannot be removed: {}; remove it, "
                                               "or give another --out",
                                               folder, verdict, error.message()));
  }
}

// The pictures that summary.md shows (app/sweep/failing_pixels.cpp).
std::vector<std::string> summary_pictures(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (const std::string name = entry.path().filename().string();
        name.starts_with(summary_picture) && name.ends_with(".png"))
      names.push_back(name);
  return names;
}

// Whether a store of Noonmark is there. A damaged one cannot tell.
bool has_store(const std::string& folder) {
  std::error_code none;
  if (!fs::is_regular_file(folder + "/results.sqlite", none)) return false;
  try {
    ResultStore::open(folder + "/results.sqlite");
    return true;
  } catch (const Error&) {
    return false;
  }
}

// All that a run writes into its folder, but for the pictures of summary.md. The store has its own protection: it is replaced with
// --overwrite only.
const std::vector<std::string> written = {"junit.xml", "summary.md", "report.html", "results.csv", "images"};

// Through a link, pictures would be written and removed in another folder, and the report would not read them.
void require_own_images(const std::string& folder) {
  std::error_code none;
  const fs::file_status images = fs::symlink_status(fs::path(folder) / "images", none);
  if (fs::exists(images) && !fs::is_directory(images))
    throw Error(ErrorKind::file, fmt::format("{}/images: is {}, but pictures need a folder of that name; "
                                             "remove it, or give another --out",
                                             folder, fs::is_symlink(images) ? "a symbolic link" : "not a folder"));
}

// The file may be a link, or be there no longer; its folder decides.
fs::path resolved(const fs::path& file) {
  std::error_code none;
  const fs::path whole = fs::absolute(file, none).lexically_normal();
  return fs::weakly_canonical(whole.parent_path(), none) / whole.filename();
}

}  // namespace

std::string seen_from(const std::string& folder, const std::string& experiment) {
  std::error_code none;
  const fs::path here = fs::weakly_canonical(fs::absolute(folder, none), none);
  return resolved(experiment).lexically_proximate(here).string();
}

ResultsFolder::ResultsFolder(const std::string& path, const std::string& experiment)
    : path_((make_output_folder(path), path)), lock_(path) {
  const std::string owner = experiment.empty() ? "" : ResultStore::experiment_file(path + "/results.sqlite");
  if (!experiment.empty() && (owner.empty() || owner == seen_from(path, experiment))) take();
  require_own_images(path);
}

void ResultsFolder::take() const {
  if (ours_) return;
  MadeFiles made(path_);
  const std::vector<std::string> pictures = summary_pictures(path_);
  if ((!made.foreign(written).empty() || (!made.has("summary.md") && !pictures.empty())) && !has_store(path_)) {
    made.require_ours(written);
    made.require_ours(pictures);
  }
  made.add(written);
  remove_verdict(path_);
  std::error_code none;
  for (const std::string& picture : pictures) fs::remove(fs::path(path_) / picture, none);
  clear_abandoned_files(path_);
  clear_abandoned_files(path_ + "/images");
  ours_ = true;
}

void ResultsFolder::remove_report() const {
  std::error_code none;
  for (const char* file : {"report.html", "results.csv"}) fs::remove(fs::path(path_) / file, none);
}

void ResultsFolder::remove_earlier_results() const {
  remove_report();
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(path_ + "/images", none)) {
    const std::string name = entry.path().filename().string();
    if (name.size() > 5 && name[0] == 'p' && std::isdigit(static_cast<unsigned char>(name[1])) &&
        (name.ends_with(".png") || name.ends_with(".exr") || name.ends_with("-live.bin") || name.ends_with(".svg")))
      fs::remove(entry.path(), none);
  }
}

void EarlyFolder::open(const std::string& path, const std::string& experiment) {
  try {
    folder_.emplace(path, experiment);
  } catch (...) {
    fault_ = std::current_exception();
  }
}

const ResultsFolder& EarlyFolder::get() const {
  if (fault_) std::rethrow_exception(fault_);
  return *folder_;
}

}  // namespace noonmark
