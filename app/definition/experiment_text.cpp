#include "app/definition/experiment_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "app/definition/experiment_file.h"
#include "app/definition/experiment_keys.h"
#include "app/definition/toml_text.h"
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

// What stands behind a key. Empty: it is left out.
std::string text_of(std::monostate) { return ""; }
std::string text_of(const std::string* text) { return text->empty() ? "" : toml_string(*text); }
std::string text_of(const std::optional<double>* number) { return *number ? fmt::format("{}", **number) : ""; }
std::string text_of(const std::vector<double>* numbers) {
  return numbers->empty() ? "" : fmt::format("[{}]", fmt::join(*numbers, ", "));
}
std::string text_of(const std::vector<std::string>* names) {
  std::vector<std::string> texts;
  for (const std::string& name : *names) texts.push_back(toml_string(name));
  return texts.empty() ? "" : fmt::format("[{}]", fmt::join(texts, ", "));
}
template <class Value>  // a number or a flag
std::string text_of(const Value* value) {
  return fmt::format("{}", *value);
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
    Experiment written = e;  // the rows of the keys point into it
    if (!e.plot.empty()) {
      header("[plot]");
      lines(plot_keys(written));
    }
    if (e.frames.empty()) {
      header("[answer]");
      lines(answer_keys(written));
    }
    for (FrameRequest& frame : written.frames) {
      frame.file = from_folder(frame.file);
      header("[[frame]]");
      lines(keys_of(frame));
    }
    if (!e.frames.empty())
      for (Bound bound : e.bounds) write_bound(bound, "");
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

  // A line for each key that has a value. Calls without(name) for the others.
  template <class Without>
  void lines(const std::vector<ExperimentKey>& keys, const Without& without) {
    for (const ExperimentKey& key : keys)
      if (const std::string text = std::visit([](auto place) { return text_of(place); }, key.place); !text.empty())
        line(key.name, text);
      else
        without(key.name);
  }
  void lines(const std::vector<ExperimentKey>& keys) {
    lines(keys, [](std::string_view) {});
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
    Experiment written = e;  // the rows of the keys point into it
    lines(curve_keys(written), [&](std::string_view key) {
      if (key == "bias_depth") text_ += "# bias_depth: 0, then 20 values a decade from 1e-7 to 1\n";
    });
    header(fmt::format("[{}phase]", prefix));
    PhaseRequest& phase = written.phase;
    phase.acne_bound = phase.acne_bound.value_or(e.curve.acne_bound);
    phase.peter_panning_bound = phase.peter_panning_bound.value_or(e.curve.peter_panning_bound);
    lines(keys_of(phase));
    if (!e.let.empty()) header(fmt::format("[{}let]", prefix));
    for (const auto& [name, formula] : e.let) line(toml_string(name), toml_string(formula));
    for (Bound bound : e.bounds) write_bound(bound, prefix);
    for (Law law : e.laws) write_law(law, prefix);
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

  void write_bound(Bound& bound, const std::string& prefix) {
    header(fmt::format("[[{}bound]]", prefix));
    lines(keys_of(bound), [&](std::string_view key) {
      if (key == "where") write_where(key, bound.where);
    });
  }

  void write_law(Law& law, const std::string& prefix) {
    const char* const relation = law.relation == LawRelation::equal     ? "equals"
                                 : law.relation == LawRelation::at_most ? "at_most"
                                                                        : "at_least";
    header(fmt::format("[[{}law]]", prefix));
    lines(keys_of(law), [&](std::string_view key) {
      if (key == relation) line(key, toml_string(law.predicted));
      if (key == "where") write_where(key, law.where);
      if (key == "against") write_where(key, law.against);
    });
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
