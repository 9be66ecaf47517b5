#include "app/advise/engine_adapters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "base/child_process.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

// Why an engine that could be asked for has no adapter here.
struct NoAdapter {
  std::string_view name, why;
};
constexpr NoAdapter no_adapters[] = {
    {"blender", "recommend prints no lines for Blender, whose EEVEE has one bias without a documented unit"},
    {"filament",
     "its npm package 1.53.4 cannot set the normal bias of the lines, so its frames would show other settings"},
};

constexpr uint64_t most_log_bytes = 1 << 24;

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

bool has_file(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(path, none);
}

// In the build and where it is installed (app/CMakeLists.txt).
std::string adapters_of_program() {
  return (fs::path(own_program()).parent_path() / NOONMARK_ENGINES).lexically_normal().string();
}

// The last line that says something.
std::string last_line(const std::string& text) {
  const size_t end = text.find_last_not_of(" \n");
  if (end == text.npos) return "it printed nothing";
  const size_t start = text.rfind('\n', end);
  return text.substr(start == text.npos ? 0 : start + 1, end - (start == text.npos ? 0 : start + 1) + 1);
}

std::vector<std::string> notes_in(const std::string& text) {
  constexpr std::string_view mark = "note: ";
  std::vector<std::string> notes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(mark)) notes.push_back(line.substr(mark.size()));
  return notes;
}

}  // namespace

std::span<const EngineAdapter> engine_adapters() {
  static const std::array<EngineAdapter, 3> adapters = {
      {{"three", "three.js", "three/page.html", {"three"}},
       {"babylon", "Babylon.js", "babylon/page.html", {"babylonjs", "babylonjs-loaders", "babylonjs-materials"}},
       {"playcanvas", "PlayCanvas", "playcanvas/page.html", {"playcanvas"}}}};
  return adapters;
}

const EngineAdapter& engine_adapter(const std::string& name) {
  for (const EngineAdapter& adapter : engine_adapters())
    if (adapter.name == name) return adapter;
  std::vector<std::string_view> names;
  for (const EngineAdapter& adapter : engine_adapters()) names.push_back(adapter.name);
  for (const NoAdapter& none : no_adapters)
    if (none.name == name)
      throw Error(ErrorKind::usage,
                  fmt::format("--engine {}: {}; these can be tried: {}", name, none.why, fmt::join(names, ", ")));
  throw Error(ErrorKind::usage, fmt::format("--engine '{}': there is no such engine; these can be tried: {}", name,
                                            fmt::join(names, ", ")));
}

AdapterTools find_adapters(const std::vector<std::string>& names, const std::string& folder) {
  std::vector<std::string> missing;
  AdapterTools tools;
  tools.folder = folder.empty() ? adapters_of_program() : folder;
  if (!has_file(fs::path(tools.folder) / "shoot.mjs"))
    missing.push_back(fmt::format("shoot.mjs in {} (--adapters names another folder)", tools.folder));
  tools.node = find_program("node").value_or("");
  if (tools.node.empty()) missing.push_back("node (Debian's package nodejs)");
  const std::string chromium = environment("CHROMIUM").empty() ? "chromium" : environment("CHROMIUM");
  if (!find_program(chromium))
    missing.push_back(fmt::format("{} (Debian's package chromium, or the variable CHROMIUM)", chromium));
  tools.modules = environment("NODE_MODULES");
  if (tools.modules.empty()) tools.modules = (fs::path(tools.folder) / "node_modules").string();
  std::vector<std::string_view> packages;
  for (const std::string& name : names)
    for (std::string_view package : engine_adapter(name).packages)
      if (std::error_code none; !fs::is_directory(fs::path(tools.modules) / package, none)) packages.push_back(package);
  if (!packages.empty())
    missing.push_back(fmt::format(
        "npm's {} in {} (npm install in a copy of the adapters' folder; NODE_MODULES names its node_modules)",
        fmt::join(packages, ", "), tools.modules));
  if (!missing.empty())
    throw Error(ErrorKind::usage, fmt::format("--engine needs what is missing here: {}; install it, or leave --engine "
                                              "out",
                                              fmt::join(missing, "; ")));
  return tools;
}

std::vector<std::string> shoot(const AdapterTools& tools, const EngineAdapter& adapter, const std::string& model,
                               const std::string& out, const std::vector<std::string>& settings) {
  make_folder(out);
  const std::string log = out + "/shoot.log";
  std::vector<std::string> command = {tools.node, tools.folder + "/shoot.mjs", std::string(adapter.page), model, out};
  command.insert(command.end(), settings.begin(), settings.end());
  const int code = run_program(command, log);
  const std::string said = read_file(log, most_log_bytes);
  if (code == 0 && has_file(out + "/frame.json")) return notes_in(said);
  throw Error(ErrorKind::device, fmt::format("{} gave no frame (code {}): {}; the whole text is in {}", adapter.engine,
                                             code, last_line(said), log));
}

}  // namespace noonmark
