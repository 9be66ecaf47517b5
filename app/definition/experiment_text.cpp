#include "app/definition/experiment_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "app/definition/experiment_file.h"
#include "app/definition/toml_writer.h"
#include "base/error.h"
#include "base/text.h"
#include "scenes/library.h"

namespace noonmark {
namespace {

// Whether two absolute paths have more in common than the root.
bool below_one_folder(const std::filesystem::path& a, const std::filesystem::path& b) {
  const std::filesystem::path here = a.relative_path(), there = b.relative_path();
  return !here.empty() && !there.empty() && *here.begin() == *there.begin();
}

// The path as the reader takes it: it starts at the folder of the file.
std::string path_from_folder(const std::string& path, const std::filesystem::path& folder) {
  const std::filesystem::path scene(path);
  if (folder.empty()) return path;
  const std::filesystem::path relative = scene.lexically_relative(folder);
  if (scene.is_absolute()) {
    const bool together = folder.is_absolute() && below_one_folder(scene, folder);
    return together && (folder / relative).lexically_normal() == scene ? relative.string() : path;
  }
  if (!relative.empty() && !folder.is_absolute()) return relative.string();
  std::error_code none;
  return std::filesystem::absolute(scene, none).string();
}

class Writer {
 public:
  explicit Writer(const Experiment& experiment) : folder_(std::filesystem::path(experiment.path).parent_path()) {}

  std::string write(const Experiment& e) {
    text_ = fmt::format("# {}, with every default written out. Paths of scenes start at this file's folder.\n",
                        printable(e.path));
    line("title", toml_string(e.title));
    line("pictures", toml_string(e.pictures));
    if (e.frames.empty()) line("exr", e.exr ? "true" : "false");
    if (e.lights) line("lights", toml_string("parts"));
    if (e.frames.empty()) line("times", times_measured(e) ? "true" : "false");
    if (!e.plot.empty()) {
      header("[plot]");
      line("metrics", names(e.plot));
    }
    if (e.frames.empty()) {
      header("[answer]");
      line("cost", toml_string(e.cost));
      line("accuracy", toml_string(e.accuracy));
      if (!e.choose.empty()) line("choose", names(e.choose));
    }
    for (const FrameRequest& frame : e.frames) {
      header("[[frame]]");
      line("file", toml_string(from_folder(frame.file)));
      line("name", toml_string(frame.name));
      if (!frame.accepted.empty()) line("accept", names(frame.accepted));
      if (frame.without_map) line("without_map", "true");
    }
    if (!e.frames.empty())
      for (const Bound& bound : e.bounds) write_bound(bound, "");
    else if (e.parts.empty())
      points_of(e, "");
    for (const Experiment& part : e.parts) {
      header("[[part]]");
      line("name", toml_string(part.part));
      points_of(part, "part.");
    }
    return std::move(text_);
  }

 private:
  void header(const std::string& name) { text_ += "\n" + name + "\n"; }
  void line(std::string_view key, const std::string& value) { text_ += fmt::format("{} = {}\n", key, value); }

  static std::string names(const std::vector<std::string>& list) {
    std::vector<std::string> texts;
    for (const std::string& name : list) texts.push_back(toml_string(name));
    return fmt::format("[{}]", fmt::join(texts, ", "));
  }

  std::string value(const Setting& row, const std::string& canonical) const {
    return toml_value(row, row.name == "scene.name" && names_file(canonical) ? from_folder(canonical) : canonical);
  }
  std::string from_folder(const std::string& path) const { return path_from_folder(path, folder_); }

  void points_of(const Experiment& e, const std::string& prefix) {
    std::string group;
    for (const Setting& row : settings_table()) {
      const auto swept = [&](const Swept& s) { return s.name == row.name; };
      if (std::any_of(e.swept.begin(), e.swept.end(), swept)) continue;
      const size_t dot = row.name.find('.');
      if (const std::string of_row(row.name.substr(0, dot)); of_row != group) {
        group = of_row;
        header(fmt::format("[{}{}]", prefix, group));
      }
      // Written out, the default would be a fit that is given, and points with cascades cannot have it.
      const char* comment = row.name == "map.fit" && fits_cascades(e) ? "# one map for all: " : "";
      text_ += fmt::format("{}{} = {}  # {}\n", comment, row.name.substr(dot + 1), value(row, row.get(e.base)),
                           row.range_with_unit());
    }
    for (const bool condition : {true, false}) {
      bool any = false;
      for (const Swept& swept : e.swept) {
        if (swept.condition != condition) continue;
        if (!any) header(fmt::format("[{}{}]", prefix, condition ? "over" : "sweep"));
        any = true;
        line(swept.name, list(find_setting(swept.name), swept.values));
      }
    }
    header(fmt::format("[{}curve]", prefix));
    line("enabled", e.curve_enabled ? "true" : "false");
    line("acne_bound", fmt::format("{}", e.curve.acne_bound));
    line("peter_panning_bound", fmt::format("{}", e.curve.peter_panning_bound));
    if (e.curve.bias_depth.empty())
      text_ += "# bias_depth: 0, then 20 values a decade from 1e-7 to 1\n";
    else
      line("bias_depth", fmt::format("[{}]", fmt::join(e.curve.bias_depth, ", ")));
    if (!e.curve.over.setting.empty()) line("over", toml_string(e.curve.over.setting));
    if (!e.curve.over.values.empty()) line("over_values", fmt::format("[{}]", fmt::join(e.curve.over.values, ", ")));
    header(fmt::format("[{}phase]", prefix));
    line("enabled", e.phase.enabled ? "true" : "false");
    line("acne_bound", fmt::format("{}", e.phase.acne_bound.value_or(e.curve.acne_bound)));
    line("peter_panning_bound", fmt::format("{}", e.phase.peter_panning_bound.value_or(e.curve.peter_panning_bound)));
    line("placements", fmt::format("{}", e.phase.placements));
    line("texel_sizes", fmt::format("{}", e.phase.texel_sizes));
    line("width_px", fmt::format("{}", e.phase.width_px));
    if (!e.let.empty()) header(fmt::format("[{}let]", prefix));
    for (const auto& [name, formula] : e.let) line(toml_string(name), toml_string(formula));
    for (const Bound& bound : e.bounds) write_bound(bound, prefix);
    for (const Law& law : e.laws) write_law(law, prefix);
  }

  std::string list(const Setting& row, const std::vector<std::string>& values) const {
    std::vector<std::string> texts;
    for (const std::string& one : values) texts.push_back(value(row, one));
    return fmt::format("[{}]", fmt::join(texts, ", "));
  }

  void write_where(std::string_view key, const Conditions& where) {
    if (where.empty()) return;
    std::vector<std::string> texts;
    for (const auto& [name, values] : where)
      texts.push_back(fmt::format("\"{}\" = {}", name, list(find_setting(name), values)));
    line(key, fmt::format("{{{}}}", fmt::join(texts, ", ")));
  }

  void write_bound(const Bound& bound, const std::string& prefix) {
    header(fmt::format("[[{}bound]]", prefix));
    line("metric", toml_string(bound.metric));
    if (bound.max) line("max", fmt::format("{}", *bound.max));
    if (bound.min) line("min", fmt::format("{}", *bound.min));
    line("join", toml_string(bound.join));
    line("placement", toml_string(bound.placement));
    line("level", toml_string(bound.level));
    write_where("where", bound.where);
  }

  void write_law(const Law& law, const std::string& prefix) {
    header(fmt::format("[[{}law]]", prefix));
    line("name", toml_string(law.name));
    if (!law.says.empty()) line("says", toml_string(law.says));
    if (!law.found.empty()) line("found", toml_string(law.found));
    line("measured", toml_string(law.measured));
    line(law.relation == LawRelation::equal     ? "equals"
         : law.relation == LawRelation::at_most ? "at_most"
                                                : "at_least",
         toml_string(law.predicted));
    line("within", fmt::format("{}", law.within));
    if (!law.slack.empty()) line("slack", toml_string(law.slack));
    line("join", toml_string(law.join));
    if (!law.over.empty()) line("over", toml_string(law.over));
    write_where("where", law.where);
    write_where("against", law.against);
  }

  std::filesystem::path folder_;
  std::string text_;
};

}  // namespace

std::string scene_path_in(const std::string& scene, const std::string& file) {
  return path_from_folder(scene, std::filesystem::path(file).parent_path());
}

std::string experiment_text(const Experiment& experiment) {
  const std::string text = Writer(experiment).write(experiment);
  try {
    const Experiment read = parse_experiment(text, experiment.path);
    // A scene of --set is a path from the working folder; from the file's folder the same file can have another path.
    const auto& given = experiment.overridden;
    const bool other_path = std::find(given.begin(), given.end(), "scene.name") != given.end();
    if (other_path || fingerprint(read, {}) == fingerprint(experiment, {})) return text;
  } catch (const Error& error) {
    throw Error(ErrorKind::usage, fmt::format("{}: with these options it cannot be written as a file: {}",
                                              experiment.path, error.what()));
  }
  throw std::logic_error("the printed experiment has other points");
}

}  // namespace noonmark
