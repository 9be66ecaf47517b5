#include "app/definition/experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "scenes/library.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// The values of point `index`, as one index into each swept list. The last index changes fastest.
std::vector<size_t> digits(const Experiment& experiment, int64_t index) {
  std::vector<size_t> result(experiment.swept.size());
  for (size_t i = result.size(); i-- > 0;) {
    const auto count = static_cast<int64_t>(experiment.swept[i].values.size());
    result[i] = static_cast<size_t>(index % count);
    index /= count;
  }
  return result;
}

// The id of the part's first point.
int64_t first_of_part(const Experiment& experiment, const Experiment& part) {
  int64_t first = 0;
  for (const Experiment& other : experiment.parts) {
    if (&other == &part) break;
    first += point_count(other);
  }
  return first;
}

// Whether the user names no fit of the map.
bool leaves_fit_open(const Experiment& part) {
  const auto fit = [](const Swept& swept) { return swept.name == "map.fit"; };
  return part.base.map.fit == MapSettings().fit && !part.locations.contains("map.fit") &&
         std::none_of(part.swept.begin(), part.swept.end(), fit);
}

}  // namespace

bool fits_cascades(const Experiment& experiment) {
  const auto several = [](const Swept& swept) {
    return swept.name == "cascades.count" && swept.values != std::vector<std::string>{"1"};
  };
  if (std::any_of(experiment.parts.begin(), experiment.parts.end(), fits_cascades)) return true;
  return leaves_fit_open(experiment) &&
         (experiment.base.cascades.count > 1 || std::any_of(experiment.swept.begin(), experiment.swept.end(), several));
}

void apply_override(Experiment& experiment, std::string_view assignment) {
  const size_t equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0)
    throw Error(ErrorKind::usage,
                fmt::format("--set {}: write it as name=value, such as map.resolution=2048", assignment));
  const std::string_view given = assignment.substr(0, equals);
  const std::string name(given == "scene" ? "scene.name" : given);
  try {
    find_setting(name).set(experiment.base, assignment.substr(equals + 1));
  } catch (const Error& error) {
    throw Error(ErrorKind::usage, fmt::format("--set {}: {}", assignment, error.what()));
  }
  experiment.locations[name] = fmt::format("--set {}", assignment);
  std::erase_if(experiment.swept, [&](const Swept& swept) { return swept.name == name; });
  for (Experiment& part : experiment.parts) apply_override(part, assignment);
  if (std::find(experiment.overridden.begin(), experiment.overridden.end(), name) == experiment.overridden.end())
    experiment.overridden.push_back(name);
}

void choose_parts(Experiment& experiment, const std::vector<std::string>& names) {
  if (experiment.parts.empty())
    throw Error(ErrorKind::usage, fmt::format("--part {}: {} has no parts", names.at(0), experiment.path));
  const auto chosen = [&](std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  std::vector<std::string_view> known;
  for (const Experiment& part : experiment.parts) known.push_back(part.part);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = nearest_name(name, known);
    throw Error(ErrorKind::usage, fmt::format("--part {}: {} has no such part{}", name, experiment.path,
                                              near.empty() ? fmt::format("; it has '{}'", fmt::join(known, "', '"))
                                                           : fmt::format("; did you mean '{}'?", near)));
  }
  const size_t all = experiment.parts.size();
  std::erase_if(experiment.parts, [&](const Experiment& part) { return !chosen(part.part); });
  experiment.chosen = names;
  if (!experiment.lights || experiment.parts.size() == all) return;
  // Without all its lights there is no frame.
  experiment.lights = false;
  size_t dropped = 0;
  for (Experiment& part : experiment.parts)
    dropped += std::erase_if(part.bounds, [](const Bound& bound) { return is_of_lights(bound.metric); });
  experiment.notes.push_back(fmt::format(
      "{}: --part leaves lights of the frame out, so what they give together is not measured{}", experiment.path,
      dropped == 0 ? "" : fmt::format(", and {} on it not judged", counted(dropped, "bound"))));
}

Experiment part_of_light(const Experiment& experiment, const std::string& light) {
  Experiment part = experiment;
  part.part = light;
  part.base.light.name = light;
  part.notes.clear();
  return part;
}

bool is_of_frame(std::string_view setting) {
  return setting.starts_with("scene.") || setting.starts_with("view.") || setting.starts_with("motion.");
}

void require_one_frame(const Experiment& experiment) {
  const std::vector<Settings> all = points(experiment);
  const size_t frames = all.size() / std::max<size_t>(1, experiment.parts.size());
  // The first of the wanted settings in which two points differ; empty: none.
  const auto differing = [&](size_t a, size_t b, const auto& wanted) -> std::string_view {
    for (const Setting& row : settings_table())
      if (wanted(row.name) && row.get(all[a]) != row.get(all[b])) return row.name;
    return "";
  };
  const auto of_light = [](std::string_view name) { return name.starts_with("light."); };
  for (size_t f = 0; f < frames; ++f)
    for (size_t l = 1; l < experiment.parts.size(); ++l)
      for (size_t other = 0; other < l; ++other) {
        const size_t a = other * frames + f, b = l * frames + f;
        const std::string names =
            fmt::format("the lights '{}' and '{}'", experiment.parts[other].part, experiment.parts[l].part);
        if (const std::string_view name = differing(a, b, is_of_frame); !name.empty())
          throw Error(ErrorKind::usage,
                      fmt::format("{} of one frame differ in {}; it is one for all of them", names, name));
        if (differing(a, b, of_light).empty())
          throw Error(ErrorKind::usage, fmt::format("{} of one frame are the same light", names));
      }
}

void give_lights(Experiment& experiment, std::vector<Experiment> lights) {
  // A bound on the frame has one value for all its lights, so the first one has it.
  for (size_t l = 1; l < lights.size(); ++l)
    std::erase_if(lights[l].bounds, [](const Bound& bound) { return bound.metric.starts_with("lights_"); });
  experiment.parts = std::move(lights);
  experiment.lights = true;
  experiment.all_lights = false;
  experiment.swept.clear();
  experiment.bounds.clear();
}

namespace {

// The name of this light, or of its node, that no other light and node has; else "".
std::string only_name(const std::vector<Named<Light>>& lights, size_t at) {
  for (const std::string& name : {lights[at].name, lights[at].node}) {
    const auto has = [&](const Named<Light>& one) { return one.name == name || one.node == name; };
    if (name != LightSettings().name && !name.empty() && std::count_if(lights.begin(), lights.end(), has) == 1)
      return name;
  }
  return "";
}

Experiment the_only_light(const Experiment& experiment) {
  Experiment part = part_of_light(experiment, "the light");
  part.base.light.name = LightSettings().name;
  return part;
}

}  // namespace

void take_all_lights(Experiment& experiment) {
  if (!experiment.all_lights) return;
  for (const Swept& swept : experiment.swept)
    if (swept.name.starts_with("scene.name"))
      throw Error(ErrorKind::usage,
                  fmt::format("{}: lights = \"all\" needs one scene, and scene.name is swept; name the lights",
                              experiment.path));
  const Scene scene = make_scene(experiment.base.scene);
  experiment.all_lights = false;
  std::vector<Experiment> lights;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const std::string name = only_name(scene.lights, i);
    if (!scene.lights[i].value) {
      experiment.notes.push_back(fmt::format("{}: lights = \"all\" leaves {} out: {}", experiment.path,
                                             name.empty() ? fmt::format("light {}", i) : name,
                                             scene.lights[i].why_not));
      continue;
    }
    Experiment part = part_of_light(experiment, name);
    if (name.empty()) {  // or another light has the same
      part.part = fmt::format("light {}", i);
      part.base.light.name = LightSettings().name;
      part.base.light.index = static_cast<int>(i);
    }
    lights.push_back(std::move(part));
  }
  if (lights.empty()) lights.push_back(the_only_light(experiment));
  give_lights(experiment, std::move(lights));
}

const Experiment& part_of_point(const Experiment& experiment, int64_t id) {
  for (const Experiment& part : experiment.parts) {
    const int64_t count = point_count(part);
    if (id < count) return part;
    id -= count;
  }
  return experiment;
}

namespace {

// The names of the swept settings that are wanted, of all parts, each once.
template <class Wanted>
std::vector<std::string> names_of(const Experiment& experiment, const Wanted& wanted) {
  std::vector<std::string> names;
  for (const Swept& swept : experiment.swept)
    if (wanted(swept)) names.push_back(swept.name);
  for (const Experiment& part : experiment.parts)
    for (const std::string& name : names_of(part, wanted))
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

}  // namespace

std::string time_asked_for(const Experiment& experiment) {
  std::vector<std::string> names = experiment.plot;
  names.push_back(experiment.cost);
  names.push_back(experiment.accuracy);
  for (const Bound& bound : experiment.bounds) names.push_back(bound.metric);
  for (const Law& law : experiment.laws)
    for (const std::string& name : metric_names(law)) names.push_back(name);
  for (const Experiment& part : experiment.parts) names.push_back(time_asked_for(part));

  for (const std::string& name : names)
    if (quantity_unit(name) == "ms") return name;
  return "";
}

bool times_measured(const Experiment& experiment) {
  return experiment.times.value_or(!time_asked_for(experiment).empty());
}

std::vector<std::string> swept_names(const Experiment& experiment) {
  return names_of(experiment, [](const Swept&) { return true; });
}

std::vector<std::string> condition_names(const Experiment& experiment) {
  return names_of(experiment, [](const Swept& swept) { return swept.condition; });
}

int64_t point_count(const Experiment& experiment) {
  int64_t count = experiment.parts.empty() ? 1 : 0;
  for (const Experiment& part : experiment.parts) count += point_count(part);
  for (const Swept& swept : experiment.swept) {
    count *= static_cast<int64_t>(swept.values.size());
    // Each list fits in memory, so the product stays far from overflow when it is checked at every step.
    if (count > max_points)
      throw Error(
          ErrorKind::usage,
          fmt::format("{}: the sweep has more than {} points; sweep fewer values",
                      experiment.sweep_location.empty() ? experiment.path : experiment.sweep_location, max_points));
  }
  return count;
}

std::string swept_text(const Experiment& experiment, int64_t id) {
  const Experiment& part = part_of_point(experiment, id);
  std::vector<std::string> choice;
  const std::vector<size_t> at = digits(part, id - first_of_part(experiment, part));
  for (size_t i = 0; i < at.size(); ++i)
    choice.push_back(fmt::format("{} = {}", part.swept[i].name, setting_text(part.swept[i].values[at[i]])));
  return fmt::format("{}", fmt::join(choice, ", "));
}

Error error_of_point(const Experiment& experiment, int64_t id, const Error& error) {
  if (experiment.path.empty()) return error;  // a point given only by the command line has no name and no place
  const Experiment& part = part_of_point(experiment, id);
  std::string place = part.sweep_location;
  if (const auto* conflict = dynamic_cast<const SettingConflict*>(&error)) {
    // The file can give any of the settings that the message names.
    const std::string what = error.what();
    const auto named = part.locations.find(conflict->setting());
    size_t first = std::string::npos;
    if (named != part.locations.end())
      place = named->second;
    else
      for (const auto& [name, where] : part.locations)
        if (const size_t found = what.find(name); found < first) {
          first = found;
          place = where;
        }
  }
  const std::string choice = swept_text(experiment, id);
  return Error(error.kind(), fmt::format("{}: {}point {}{}: {}", place.empty() ? experiment.path : place,
                                         part.part.empty() ? "" : fmt::format("part '{}', ", part.part), id,
                                         choice.empty() ? "" : fmt::format(" ({})", choice), error.what()));
}

std::vector<Settings> points(const Experiment& experiment) {
  std::vector<Settings> all;
  const auto add = [&](const Experiment& part) {
    const int64_t count = point_count(part);
    for (int64_t index = 0; index < count; ++index) {
      Settings settings = part.base;
      const std::vector<size_t> at = digits(part, index);
      for (size_t i = 0; i < at.size(); ++i)
        find_setting(part.swept[i].name).set(settings, part.swept[i].values[at[i]]);
      if (settings.cascades.count > 1 && leaves_fit_open(part)) find_setting("map.fit").set(settings, fit_of_cascades);
      at_point(experiment, static_cast<int64_t>(all.size()), [&] {
        validate(settings);
        if (experiment.frames.empty() && settings.given.frame != GivenSettings().frame)
          throw Error(ErrorKind::usage,
                      "given.frame names no [[frame]] of the experiment; remove it, or add the frame");
      });
      all.push_back(std::move(settings));
    }
  };
  all.reserve(static_cast<size_t>(point_count(experiment)));
  if (experiment.parts.empty()) add(experiment);
  for (const Experiment& part : experiment.parts) add(part);
  return all;
}

std::string reproduce_command(const Experiment& experiment, const PointRecord& point) {
  if (!experiment.frames.empty()) {
    const FrameRequest& frame = experiment.frames.at(static_cast<size_t>(point.id));
    std::string judge = "noonmark judge " + shell_quoted(frame.file);
    for (const std::string& name : frame.accepted) judge += " --accept " + shell_quoted(name);
    if (frame.without_map) judge += " --without-map";
    return judge;
  }
  std::string command = "noonmark render " + shell_quoted(experiment.path);
  const auto add = [&](const std::string& name) {
    const auto setting = point.settings.find(name);
    if (setting != point.settings.end()) command += " --set " + shell_quoted(name + "=" + setting->second);
  };
  for (const std::string& name : experiment.overridden) add(name);
  for (const std::string& name : experiment.chosen) command += " --part " + shell_quoted(name);
  if (!experiment.parts.empty()) return command + fmt::format(" --point {}", point.id);
  for (const Swept& swept : experiment.swept) add(swept.name);
  return command;
}

namespace {

// Everything that determines the points of one experiment, or of one part.
std::string points_text(const Experiment& experiment) {
  std::string text;
  for (const Setting& row : settings_table()) {
    const auto swept = std::find_if(experiment.swept.begin(), experiment.swept.end(),
                                    [&](const Swept& s) { return s.name == row.name; });
    if (swept == experiment.swept.end()) text += fmt::format("{} = {}\n", row.name, row.get(experiment.base));
  }
  // The order of the sweep is included, because it gives the points their ids.
  for (const Swept& swept : experiment.swept)
    text += fmt::format("sweep {} = [{}]\n", swept.name, fmt::join(swept.values, " | "));
  text += fmt::format("curve.enabled = {}\n", experiment.curve_enabled);
  if (experiment.curve_enabled) {
    const auto& [acne_bound, peter_panning_bound] = static_cast<const CauseBounds&>(experiment.curve);
    const std::vector<double>& bias_depth = experiment.curve.bias_depth;
    const auto& [over, over_values] = experiment.curve.over;
    static_assert(sizeof(CurveOptions) == sizeof(CauseBounds) + sizeof bias_depth + sizeof(ParameterValues),
                  "every member must stand here");
    text += fmt::format("curve.acne_bound = {}\ncurve.peter_panning_bound = {}\n", acne_bound, peter_panning_bound);
    text += bias_depth.empty() ? "curve.bias_depth = auto\n"
                               : fmt::format("curve.bias_depth = [{}]\n", fmt::join(bias_depth, ", "));
    if (!over.empty()) text += fmt::format("curve.over = {} at [{}]\n", over, fmt::join(over_values, ", "));
  }
  return text;
}

// The lines of a part, each with the part's name.
std::string in_part(const std::string& part, const std::string& lines) {
  std::string text;
  for (size_t begin = 0; begin < lines.size();) {
    const size_t end = lines.find('\n', begin);
    text += fmt::format("part '{}': {}\n", part, lines.substr(begin, end - begin));
    begin = end + 1;
  }
  return text;
}

}  // namespace

std::string fingerprint(const Experiment& experiment, std::span<const std::pair<std::string, std::string>> more) {
  std::string text;
  for (const auto& [name, value] : more) text += fmt::format("{} = {}\n", name, value);
  if (experiment.parts.empty()) text += points_text(experiment);
  for (const Experiment& part : experiment.parts) text += in_part(part.part, points_text(part));
  if (experiment.lights) text += "the parts are the lights of one frame\n";
  return text + fmt::format("times = {}\npictures = {}\n", times_measured(experiment), experiment.pictures);
}

}  // namespace noonmark
