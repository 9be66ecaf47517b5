#include "app/definition/experiment_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "app/definition/experiment.h"
#include "app/definition/experiment_keys.h"
#include "app/definition/promise_reader.h"
#include "app/definition/toml_reader.h"
#include "app/definition/toml_text.h"
#include "base/error.h"
#include "base/file.h"
#include "base/shell_words.h"
#include "compare/results/quantities.h"
#include "frames/checks.h"
#include "scenes/builtin.h"
#include "scenes/library.h"
#include "technique/placements.h"

namespace noonmark {
namespace {

class Reader : private SettingsReader {
 public:
  Reader(const std::string& path, const std::vector<std::string>& sets)
      : SettingsReader(path), promises_(path, experiment_), sets_(sets) {
    experiment_.path = path;
  }
  // Reads a part, which starts with the settings that stand outside the parts.
  Reader(const Experiment& defaults, const std::vector<std::string>& sets)
      : SettingsReader(defaults.path),
        experiment_(defaults),
        promises_(defaults.path, experiment_),
        in_part_(true),
        sets_(sets) {}

  Experiment read(const toml::table& root) {
    const std::vector<ExperimentKey> keys = keys_of(experiment_);
    for (const Item& item : items(root)) {
      const auto key = std::find_if(keys.begin(), keys.end(), [&](const ExperimentKey& one) {
        return one.name == item.key && (in_part_ ? one.in_part : one.in_root);
      });
      if (key != keys.end()) {
        fill(*key, *item.node, item.key);
        keys_.emplace(item.key, item.node);
      } else if (item.key == "scene" && item.node->is_string()) {
        fix("scene.name", *item.node);
      } else if (is_group(item.key)) {
        read_settings(table(*item.node, "[" + item.key + "]"), item.key,
                      [this](const auto&... value) { fix(value...); });
      } else {
        unknown(item, "key", with_groups(key_names(keys, in_part_)), in_part_ ? "part." : "");
      }
    }
    experiment_.pictures_given = experiment_.pictures_given || given("pictures");
    if (const toml::table* plot = table_of("plot")) read_keys(*plot, plot_keys(experiment_), "plot.", "plot.");
    if (const toml::table* answer = table_of("answer"))
      read_keys(*answer, answer_keys(experiment_), "answer.", "answer.");
    if (const toml::table* curve = table_of("curve")) read_curve(*curve);
    if (const toml::table* phase = table_of("phase")) {
      experiment_.phase.enabled = true;
      read_keys(*phase, keys_of(experiment_.phase), "phase.", "phase.");
    }
    if (const toml::table* let = table_of("let")) promises_.read_let(*let);
    if (const toml::node* frames = given("frame")) read_frames(root, *frames);
    if (in_part_ && experiment_.part.empty()) fail(root, "a [[part]] needs a name");
    const toml::node *parts = given("part"), *lights = given("lights"), *times = given("times");
    if (parts) {
      for (const char* inside : {"sweep", "over", "bound", "law"})
        if (const toml::node* node = given(inside))
          fail(*node, "in a file with parts, sweep, over, bounds and laws must stand inside a [[part]]");
      experiment_.sweep_location = location_text(parts->source());
      read_parts(*parts);
      if (lights) read_parts_as_lights(*lights);
      if (times) read_times(*times);
      take_sets();
      points(experiment_);
      require_curve_over();
      return std::move(experiment_);
    }
    // These are read last, because they depend on the fixed settings, which may stand anywhere in the file.
    read_sweeps();
    if (const toml::node* bounds = given("bound")) promises_.read_bounds(*bounds);
    if (const toml::node* laws = given("law")) promises_.read_laws(*laws);
    if (times) read_times(*times);
    take_sets();
    if (!in_part_) points(experiment_);
    if (lights) read_lights(*lights);
    require_curve_over();
    return std::move(experiment_);
  }

  // Reads one of [[lights]]: the experiment with the settings that this light has for itself.
  Experiment read_light(const toml::table& root) {
    std::string name;
    for (const Item& item : items(root)) {
      if (item.key == "name")
        name = string(*item.node, "lights.name");
      else if (is_group(item.key))
        read_settings(
            table(*item.node, "[" + item.key + "]"), item.key, [this](const std::string& key, const toml::node& value) {
              if (is_of_frame(key))
                fail(value, fmt::format("{} is one for all lights of a frame; give it outside of [[lights]]", key));
              if (key == "light.name" || key == "light.index")
                fail(value, fmt::format("{} is the name of the [[lights]]; leave it out", key));
              for (const Swept& swept : experiment_.swept)
                if (swept.name == key)
                  fail(value, fmt::format("{} is swept, and fixed for this light; drop one of the two", key));
              fix(key, value);
            });
      else
        unknown(item, "key", with_groups(key_names(keys_of_light(name))), "lights.");
    }
    if (name.empty()) fail(root, "a [[lights]] needs the name of a light");
    return named_light(name, root);
  }

 private:
  // A key of the table that is read; null: it is not given.
  const toml::node* given(const char* key) const {
    const auto found = keys_.find(key);
    return found == keys_.end() ? nullptr : found->second;
  }
  const toml::table* table_of(const char* key) const {
    const toml::node* node = given(key);
    return node ? &table(*node, fmt::format("[{}]", key)) : nullptr;
  }
  static std::vector<std::string_view> with_groups(const std::vector<std::string_view>& keys) {
    std::vector<std::string_view> names = groups();
    names.insert(names.end(), keys.begin(), keys.end());
    return names;
  }

  // ---- lights

  Experiment named_light(const std::string& name, const toml::node& node) const {
    if (name == LightSettings().name)
      fail(node,
           fmt::format("a light with the name '{0}' cannot be named, because light.name = {0} stands for none; take "
                       "lights = \"all\", or light.index in a [[part]] with lights = \"parts\"",
                       name));
    Experiment part = part_of_light(experiment_, name);
    part.locations["light.name"] = location_text(node.source());
    return part;
  }

  void read_lights(const toml::node& node) {
    if (const toml::node* laws = given("law"))
      fail(*laws, "in a file with lights, laws must stand inside a [[part]], with lights = \"parts\"");
    for (const char* chooses : {"light.name", "light.index", "light.kind"})
      if (given_.contains(chooses))
        fail(node, fmt::format("lights and {} both choose what is measured; leave one of them out", chooses));
    if (node.is_string()) {
      const std::string which = node.as_string()->get();
      if (which == "parts") fail(node, "lights = \"parts\" needs [[part]]s, one for each light");
      if (which != "all") fail(node, fmt::format("lights = \"{}\" is not \"all\" or a list of names", which));
      experiment_.all_lights = true;
      return;
    }
    std::vector<Experiment> lights;
    if (node.is_array_of_tables())
      for (const toml::node& element : *node.as_array())
        lights.push_back(Reader(experiment_, sets_).read_light(*element.as_table()));
    else
      for (const toml::node* element : list(node, "lights"))
        lights.push_back(named_light(string(*element, "lights"), *element));
    for (size_t i = 0; i < lights.size(); ++i)
      for (size_t j = 0; j < i; ++j)
        if (lights[i].part == lights[j].part) fail(node, fmt::format("lights names '{}' twice", lights[i].part));
    give_lights(experiment_, std::move(lights));
  }
  void read_parts_as_lights(const toml::node& node) {
    if (!node.is_string() || node.as_string()->get() != "parts")
      fail(node, "in a file with parts, lights is \"parts\": each part is a light of one frame");
    for (const Experiment& part : experiment_.parts)
      if (point_count(part) != point_count(experiment_.parts.front()))
        fail(node,
             fmt::format("the parts '{}' and '{}' have not as many points, so they are not lights of the same frames",
                         experiment_.parts.front().part, part.part));
    experiment_.lights = true;
    at(node.source(), [&] { require_one_frame(experiment_); });
  }

  // ---- [[frame]]

  void read_frames(const toml::table& root, const toml::node& node) {
    for (const Item& item : items(root))
      if (item.key != "title" && item.key != "pictures" && item.key != "exr" && item.key != "plot" &&
          item.key != "frame" && item.key != "bound")
        fail(*item.node,
             fmt::format("a file with frames has title, pictures, exr, plot and bounds beside them, and no {}; each "
                         "frame.json says scene, camera and light",
                         item.key));
    Swept names{"given.frame", {}};
    for (const toml::table* one : tables(node, "frames", "frame")) {
      const FrameRequest frame = read_frame(*one);
      if (std::find(names.values.begin(), names.values.end(), frame.name) != names.values.end())
        fail(*one, fmt::format("two frames have the name '{}'", frame.name));
      names.values.push_back(frame.name);
      experiment_.frames.push_back(frame);
    }
    experiment_.sweep_location = location_text(node.source());
    sweep_order_.emplace_back(true, 0, 0, experiment_.swept.size());
    experiment_.swept.push_back(std::move(names));
    experiment_.curve_enabled = false;
    experiment_.accuracy = "frame_error";
  }
  FrameRequest read_frame(const toml::table& table) {
    FrameRequest frame;
    const toml::node* accept = nullptr;
    read_keys(table, keys_of(frame), "frame.", "frame.", [&](const ExperimentKey& key, const Item& item) {
      if (key.name == "accept") accept = item.node;
    });
    for (const std::string& name : frame.accepted) at(accept->source(), [&] { require_check(name); });
    if (frame.file.empty()) fail(table, "a [[frame]] needs a file");
    if (frame.name.empty()) frame.name = frame.file;
    const std::filesystem::path file(frame.file), folder = std::filesystem::path(path()).parent_path();
    frame.file = (file.is_absolute() ? file : folder / file).lexically_normal().string();
    if (frame.name.empty() || frame.name == GivenSettings().frame) fail(table, "a [[frame]] needs another name");
    return frame;
  }

  // ---- [[part]]

  void read_parts(const toml::node& node) {
    std::vector<Experiment> parts;
    std::vector<std::string> notes;
    for (const toml::table* one : tables(node, "parts", "part")) {
      Experiment part = Reader(experiment_, sets_).read(*one);
      for (const Experiment& other : parts) {
        if (other.part == part.part) fail(*one, fmt::format("two parts have the name '{}'", part.part));
        for (const Law& law : part.laws)
          for (const Law& there : other.laws)
            if (there.name == law.name) fail(*one, fmt::format("two laws have the name '{}'", law.name));
      }
      notes.insert(notes.end(), part.notes.begin(), part.notes.end());
      parts.push_back(std::move(part));
    }
    experiment_.parts = std::move(parts);
    experiment_.notes = std::move(notes);
  }

  void fix(const std::string& name, const toml::node& value) {
    const Setting& row = find_setting(name);
    row.set(experiment_.base, canonical(row, value));
    give(name, value);
  }

  void give(const std::string& name, const toml::node& value) {
    given_.insert(name);
    experiment_.locations[name] = location_text(value.source());
  }

  // ---- [sweep] [over]

  void read_sweeps() {
    for (const char* key : {"over", "sweep"}) {
      const toml::table* const table = table_of(key);
      if (!table) continue;
      experiment_.sweep_location = location_text(table->source());
      const bool condition = key == std::string_view("over");
      read_settings(*table, "", [this, condition](const std::string& name, const toml::node& value) {
        sweep(name, value, condition);
      });
    }
    std::stable_sort(sweep_order_.begin(), sweep_order_.end());
    std::vector<Swept> ordered;
    for (const auto& [is_choice, line, column, index] : sweep_order_)
      ordered.push_back(std::move(experiment_.swept[index]));
    experiment_.swept = std::move(ordered);
  }

  void sweep(const std::string& name, const toml::node& value, bool condition) {
    const Setting& row = find_setting(name);
    Swept swept{name, {}, condition};
    std::set<std::string> seen;
    const auto add = [&](const toml::node& node, const std::string& text) {
      if (!seen.insert(text).second) fail(node, fmt::format("{} = {} is swept twice; drop one of the two", name, text));
      swept.values.push_back(text);
    };
    for (const Swept& other : experiment_.swept)
      if (other.name == name)
        fail(value, fmt::format("{} is swept twice; keep one of the two lists ([over] or [sweep])", name));
    if (given_.contains(name)) fail(value, fmt::format("{} is both fixed and swept; drop one of the two", name));

    if (const toml::table* range_table = value.as_table()) {
      if (row.type != ValueType::integer && row.type != ValueType::real)
        fail(value, fmt::format("{} has no ranges; list its values", name));
      for (double v : range(*range_table, name)) add(value, at(value.source(), [&] { return range_text(row, v); }));
    } else {
      if (!value.is_array())
        fail(value, fmt::format("[{}] {} must be a list or a range; fixed values go into their own table",
                                condition ? "over" : "sweep", name));
      for (const toml::node* node : list(value, name)) add(*node, canonical(row, *node));
    }
    give(name, value);
    const toml::source_position place = value.source().begin;
    sweep_order_.emplace_back(!condition, place.line, place.column, experiment_.swept.size());
    experiment_.swept.push_back(std::move(swept));
  }

  // Read last, because it depends on what the file asks for.
  void read_times(const toml::node& node) {
    experiment_.times = boolean(node, "times");
    if (const std::string asked = time_asked_for(experiment_); !asked.empty() && !*experiment_.times)
      fail(node, fmt::format("times = false, but the experiment asks for {}", asked));
  }

  // ---- [curve]

  void read_curve(const toml::table& table) {
    const toml::node *biases = nullptr, *over_values = nullptr;
    read_keys(table, curve_keys(experiment_), "curve.", "curve.", [&](const ExperimentKey& key, const Item& item) {
      if (key.name == "bias_depth") biases = item.node;
      if (key.name == "over") curve_over_ = item.node;
      if (key.name == "over_values") over_values = item.node;
    });
    CurveOptions& curve = experiment_.curve;
    if (biases) {
      require_values(*biases, "curve.bias_depth", "bias.constant", curve.bias_depth);
      if (curve.bias_depth.front() != 0)
        curve.bias_depth.insert(curve.bias_depth.begin(), 0.0);  // starts without a bias
    }
    if (!over_values) return;
    if (curve.over.setting.empty())
      fail(*over_values, "curve.over_values are values of curve.over, which is not given");
    require_values(*over_values, "curve.over_values", curve.over.setting, curve.over.values);
  }
  // Before what the settings mean together is checked.
  void take_sets() {
    for (const std::string& assignment : sets_) apply_override(experiment_, assignment);
  }

  // That a point has the curve that this table asks for.
  void require_curve_over() const {
    if (!curve_over_) return;
    if (!experiment_.curve_enabled) fail(*curve_over_, "curve.over is given, and curve.enabled is false");
    const std::string& over = experiment_.curve.over.setting;
    const auto sweeps = [&](const Experiment& one) {
      return std::any_of(one.swept.begin(), one.swept.end(), [&](const Swept& swept) { return swept.name == over; });
    };
    if (sweeps(experiment_) ||
        std::any_of(experiment_.parts.begin(), experiment_.parts.end(),
                    [&](const Experiment& part) { return part.curve.over.setting == over && sweeps(part); }))
      fail(*curve_over_,
           fmt::format("curve.over = '{0}' gives the errors at many values of {0} at each point, and {0} is "
                       "swept too, so all its points would have the same curve; leave one of them out",
                       over));
    const std::vector<Settings> all = points(experiment_);
    if (std::none_of(all.begin(), all.end(), [&](const Settings& one) { return has_curve_over(one, over); }))
      fail(*curve_over_,
           fmt::format("curve.over = '{}', but no point has a lookup.kind that reads it from a filtered map, "
                       "without cascades that blend",
                       over));
  }
  // The values are those of a setting.
  void require_values(const toml::node& node, const std::string& name, std::string_view setting,
                      const std::vector<double>& values) const {
    for (const double value : values) {
      try {
        canonical_text(find_setting(setting), fmt::format("{}", value));
      } catch (const Error& error) {
        fail(node, fmt::format("{}: {}", name, error.what()));
      }
    }
  }

  Experiment experiment_;
  PromiseReader promises_;
  bool in_part_ = false;
  const std::vector<std::string>& sets_;
  std::set<std::string> given_;                                 // the settings that this part of the file gives
  std::map<std::string, const toml::node*, std::less<>> keys_;  // of the table, beside settings
  const toml::node* curve_over_ = nullptr;
  // Whether it is a choice, line, column, index into experiment_.swept. Conditions come first, because scene, view and
  // light are the most costly to change from point to point.
  std::vector<std::tuple<bool, uint32_t, uint32_t, size_t>> sweep_order_;
};

}  // namespace

Experiment parse_experiment(std::string_view toml, const std::string& path, const std::vector<std::string>& sets) {
  check_toml_text(toml, path);
  try {
    const toml::table root = toml::parse(toml, path);
    return Reader(path, sets).read(root);
  } catch (const toml::parse_error& error) {
    const bool named_before = error.description().find("existing string 'scene' as table") != std::string_view::npos;
    throw Error(ErrorKind::usage, fmt::format("{}:{}:{}: {}{}", path, error.source().begin.line,
                                              error.source().begin.column, error.description(),
                                              named_before ? "; write name = \"...\" below [scene], in place of "
                                                             "scene = \"...\" above"
                                                           : ""));
  }
}

namespace {

// Far larger than any experiment that a person or a script writes. A device can be endless.
constexpr uint64_t max_experiment_bytes = uint64_t{1} << 24;

// Whether the text has only white space and comments. Then the file was most likely cut short, and a user does not want
// the default settings measured.
bool says_nothing(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a byte order mark
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const size_t first = text.substr(0, end).find_first_not_of(" \t\r");
    if (first != std::string_view::npos && text[first] != '#') return false;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return true;
}

}  // namespace

Experiment load_experiment(const std::string& path, const std::vector<std::string>& sets) {
  if (names_file(path))
    throw Error(ErrorKind::usage,
                fmt::format("{} is a model, not an experiment; noonmark init {} writes a first experiment for it", path,
                            shell_quoted(path)));
  for (const BuiltinScene& scene : builtin_scenes())
    if (path == scene.name && !std::filesystem::exists(path))
      throw Error(ErrorKind::usage,
                  fmt::format("{0} is a built-in scene, not an experiment; noonmark render, section, live, map and "
                              "recommend take its name",
                              path));
  std::string text;
  try {
    text = read_file(path, max_experiment_bytes);
  } catch (const Error& error) {
    throw Error(ErrorKind::usage, error.what());
  }
  if (says_nothing(text))
    throw Error(ErrorKind::usage, fmt::format("{}: is empty; name at least a scene (scene = \"cube-room\")", path));
  return parse_experiment(text, path, sets);
}

}  // namespace noonmark
