#include "app/pictures/capture.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/child_process.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

constexpr const char *log_name = "capture.log", *list_name = "capture.json";

// In the build and where it is installed (app/CMakeLists.txt).
std::string reader_of_program() {
  return (fs::path(own_program()).parent_path() / NOONMARK_CAPTURES).lexically_normal().string();
}

// Debian's modules are the system's Python's, which another one that comes first in PATH does not have.
std::optional<std::string> find_python() {
  const std::optional<std::string> of_system = find_program("/usr/bin/python3");
  return of_system ? of_system : find_program("python3");
}

constexpr const char* no_python = "captures are read by python3, which is missing here; install Debian's python3";
constexpr std::string_view refusal = "noonmark: ";  // begins those of the reader, as those of this program

std::string sentence_of(const std::string& line) {
  return line.starts_with(refusal) ? line.substr(refusal.size()) : line;
}

std::string program_of(const std::string& reader) { return reader + "/capture.py"; }

}  // namespace

bool is_capture(const std::string& path) { return ends_with_any_case(path, ".rdc"); }

std::vector<std::string> capture_files() {
  return {log_name, list_name, "scene.glb", "light-*.json", "light-*.npy", "light-*.exr", "light-*.png", "depth.npy"};
}

std::vector<std::string> capture_command(const std::string& capture, const std::string& reader) {
  if (std::error_code none; !fs::is_regular_file(capture, none))
    throw Error(ErrorKind::file, fmt::format("{}: there is no such file", capture));
  const std::optional<std::string> python = find_python();
  if (!python) throw Error(ErrorKind::device, no_python);
  const std::string program = program_of(reader.empty() ? reader_of_program() : reader);
  if (std::error_code none; !fs::is_regular_file(program, none))
    throw Error(ErrorKind::usage,
                fmt::format("{} is missing, which reads captures; --reader names its folder", program));
  // -u: what it says on both streams stays in its order. -B: it leaves no files beside an installed program.
  return {*python, "-uB", program, capture};
}

std::vector<std::string> read_capture(std::vector<std::string> command, const std::string& folder,
                                      const std::vector<std::string>& options,
                                      const std::function<void(const std::string&)>& said) {
  make_folder(folder);
  const std::string log = folder + "/" + log_name;
  const std::string capture = command.back();
  command.push_back(folder);
  command.insert(command.end(), options.begin(), options.end());
  std::string last = "it printed nothing";
  const int code = run_program(command, log, [&](const std::string& line) {
    if (!line.empty()) last = line;
    if (!line.starts_with(refusal)) said(line);
  });
  if (code >= static_cast<int>(ErrorKind::usage) && code <= static_cast<int>(ErrorKind::device))
    throw Error(static_cast<ErrorKind>(code), sentence_of(last));
  if (code != 0)
    throw Error(ErrorKind::device,
                fmt::format("{}: the reader failed (code {}): {}; the whole text is in {}", capture, code, last, log));
  std::vector<std::string> frames;
  const nlohmann::json list = nlohmann::json::parse(read_file(folder + "/" + list_name));
  for (const std::string frame : list.at("frames")) frames.push_back(folder + "/" + frame);
  if (frames.empty()) throw Error(ErrorKind::file, fmt::format("{}: the reader found no light: {}", capture, last));
  return frames;
}

void print_line(const std::string& line) {
  fmt::print("{}\n", printable(line));
  std::fflush(stdout);
}

std::string missing_for_captures() {
  const std::optional<std::string> python = find_python();
  if (!python) return no_python;
  std::string missing;
  for (const std::string module :
       {"renderdoc", "numpy"})  // each is found, not loaded: RenderDoc's writes files when it is
    if (run_program(
            {*python, "-c", "import importlib.util, sys; sys.exit(not importlib.util.find_spec('" + module + "'))"},
            "/dev/null") != 0)
      missing += " python3-" + module;
  return missing.empty() ? "" : "captures need these packages of Debian:" + missing + "; install them with apt";
}

}  // namespace noonmark
