#include "app/sweep/results_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "compare/store/store.h"

namespace noonmark {

namespace fs = std::filesystem;

void make_output_folder(const std::string& path) {
  try {
    make_folder(path);
  } catch (const Error& error) {
    throw Error(ErrorKind::usage, fmt::format("{}, or give another --out", error.what()));
  }
}

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

// The pictures that summary.md shows (app/sweep/sweep.cpp).
void remove_summary_pictures(const std::string& folder) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(summary_picture) && name.ends_with(".png")) fs::remove(entry.path(), none);
  }
}

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

ResultsFolder::ResultsFolder(const std::string& path, const std::string& experiment) : path_(path), descriptor_(-1) {
  make_output_folder(path);
  descriptor_ = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // Some file systems have no locks. There another run is not kept out.
  if (descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(descriptor_);
    throw Error(ErrorKind::usage,
                fmt::format("another run is writing into {}; wait for it, or give another --out", path));
  }
  try {
    const std::string owner = experiment.empty() ? "" : ResultStore::experiment_file(path + "/results.sqlite");
    if (!experiment.empty() && (owner.empty() || owner == seen_from(path, experiment))) take();
    require_own_images(path);
  } catch (...) {
    if (descriptor_ >= 0) close(descriptor_);
    throw;
  }
}

void ResultsFolder::take() const {
  if (ours_) return;
  remove_verdict(path_);
  remove_summary_pictures(path_);
  clear_abandoned_files(path_);
  clear_abandoned_files(path_ + "/images");
  ours_ = true;
}

ResultsFolder::~ResultsFolder() {
  if (descriptor_ >= 0) close(descriptor_);
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
        (name.ends_with(".png") || name.ends_with(".exr")))
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
