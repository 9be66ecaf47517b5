#include "app/definition/default_folder.h"

#include <filesystem>

namespace noonmark {
namespace {

namespace fs = std::filesystem;

constexpr const char* results_root = "out";

bool leaves(const fs::path& relative) { return relative.empty() || *relative.begin() == ".."; }

// The path below the working folder. "." for the working folder itself.
fs::path below_working_folder(const std::string& path) {
  std::error_code none;
  const fs::path here = fs::current_path(none), whole = (here / path).lexically_normal();
  fs::path below = whole.lexically_relative(here);
  // A working folder that is named by a link. The file's own name stays, also if it is a link.
  if (leaves(below))
    below = (fs::weakly_canonical(whole.parent_path(), none) / whole.filename()).lexically_relative(here);
  return leaves(below) ? whole.relative_path() : below;
}

// A file below out/ stays there, so that its folder is beside it.
fs::path in_results_root(const fs::path& folder) {
  if (folder.empty() || folder == ".") return results_root;
  return *folder.begin() == results_root ? folder : results_root / folder;
}

}  // namespace

std::string default_folder(const std::string& file, std::string_view before_name) {
  const fs::path below = below_working_folder(file);
  return (in_results_root(below.parent_path()) / (std::string(before_name) + below.stem().string())).string();
}

std::string default_folder_of_folder(const std::string& folder) {
  const fs::path below = below_working_folder(folder);
  return in_results_root(below.has_filename() ? below : below.parent_path()).string();  // "tests/" is "tests"
}

}  // namespace noonmark
