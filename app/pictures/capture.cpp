#include "app/pictures/capture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <tuple>

#include "base/child_process.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

constexpr const char* log_name = "capture.log";
constexpr uint64_t most_log_bytes = 1 << 24;

// In the build and where it is installed (app/CMakeLists.txt).
std::string reader_of_program() {
  return (fs::path(own_program()).parent_path() / NOONMARK_CAPTURES).lexically_normal().string();
}

// Debian's modules are the system's Python's, which another one that comes first in PATH does not have.
std::optional<std::string> find_python() {
  const std::optional<std::string> of_system = find_program("/usr/bin/python3");
  return of_system ? of_system : find_program("python3");
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

// Of a refusal of the reader's, which begins as this program's do.
std::string sentence_of(const std::string& line) {
  constexpr std::string_view name = "noonmark: ";
  return line.starts_with(name) ? line.substr(name.size()) : line;
}

// light-1.json, light-1-map-1.json, light-2.json ... by their numbers.
std::vector<std::string> frames_in(const std::string& folder) {
  std::vector<std::tuple<int, int, std::string>> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    int light = 0, map = 0;
    if (entry.path().extension() == ".json" &&
        std::sscanf(entry.path().filename().c_str(), "light-%d-map-%d", &light, &map) >= 1)
      found.emplace_back(light, map, entry.path().string());
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> frames;
  for (const auto& [light, map, path] : found) frames.push_back(path);
  return frames;
}

}  // namespace

bool is_capture(const std::string& path) { return ends_with_any_case(path, ".rdc"); }

std::vector<std::string> capture_files() {
  return {"capture.json", log_name,      "scene.glb",   "light-*.json",
          "light-*.npy",  "light-*.exr", "light-*.png", "depth.npy"};
}

std::vector<std::string> capture_command(const std::string& capture, const std::string& reader) {
  if (std::error_code none; !fs::is_regular_file(capture, none))
    throw Error(ErrorKind::file, fmt::format("{}: there is no such file", capture));
  const std::optional<std::string> python = find_python();
  if (!python)
    throw Error(ErrorKind::device, "captures are read by python3, which is missing here; install Debian's python3");
  const std::string program = (reader.empty() ? reader_of_program() : reader) + "/capture.py";
  if (std::error_code none; !fs::is_regular_file(program, none))
    throw Error(ErrorKind::usage,
                fmt::format("{} is missing, which reads captures; --reader names its folder", program));
  // -u: what it says on both streams stays in its order. -B: it leaves no files beside an installed program.
  return {*python, "-uB", program, capture};
}

ReadCapture read_capture(std::vector<std::string> command, const std::string& folder,
                         const std::vector<std::string>& options) {
  make_folder(folder);
  const std::string log = folder + "/" + log_name;
  const std::string capture = command.back();
  command.push_back(folder);
  command.insert(command.end(), options.begin(), options.end());
  const int code = run_program(command, log);
  ReadCapture read{.frames = {}, .said = lines_of(read_file(log, most_log_bytes))};
  const std::string last = read.said.empty() ? "it printed nothing" : read.said.back();
  if (code >= static_cast<int>(ErrorKind::usage) && code <= static_cast<int>(ErrorKind::device))
    throw Error(static_cast<ErrorKind>(code), sentence_of(last));
  if (code != 0)
    throw Error(ErrorKind::device,
                fmt::format("{}: the reader failed (code {}): {}; the whole text is in {}", capture, code, last, log));
  read.frames = frames_in(folder);
  if (read.frames.empty())
    throw Error(ErrorKind::file, fmt::format("{}: the reader found no light: {}", capture, last));
  return read;
}

std::vector<std::string> missing_for_captures() {
  std::vector<std::string> missing;
  const std::optional<std::string> python = find_python();
  if (!python) missing.emplace_back("python3");
  const auto imports = [&](const char* module) {
    return python && run_program({*python, "-c", std::string("import ") + module}, "/dev/null") == 0;
  };
  if (!imports("renderdoc")) missing.emplace_back("python3-renderdoc");
  if (!imports("numpy")) missing.emplace_back("python3-numpy");
  if (!find_program("renderdoccmd")) missing.emplace_back("renderdoc");
  if (!find_program("Xvfb") && !std::getenv("DISPLAY")) missing.emplace_back("xvfb");
  return missing;
}

}  // namespace noonmark
