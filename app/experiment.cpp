#include "app/experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scenes/error.h"

namespace noonmark {
namespace {

// The values of point `index`: one index into each swept list, the last fastest.
std::vector<size_t> digits(const Experiment& experiment, int64_t index) {
  std::vector<size_t> result(experiment.swept.size());
  for (size_t i = result.size(); i-- > 0;) {
    const auto count = static_cast<int64_t>(experiment.swept[i].values.size());
    result[i] = static_cast<size_t>(index % count);
    index /= count;
  }
  return result;
}

// FNV-1a over 64 bits (Fowler, Noll, Vo): tells an edited scene from the one that was measured, nothing more.
class Digest {
 public:
  void bytes(const void* data, size_t size) {
    for (size_t i = 0; i < size; ++i) hash_ = (hash_ ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3;
  }
  template <class T>
  void value(const T& v) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    bytes(&v, sizeof v);
  }
  void point(const glm::dvec3& p) {
    for (int axis = 0; axis < 3; ++axis) value(p[axis]);
  }
  std::string text() const { return fmt::format("{:016x}", hash_); }

 private:
  uint64_t hash_ = 0xcbf29ce484222325;
};

}  // namespace

std::string shell_quoted(const std::string& word) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./,=+:@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
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
  std::erase_if(experiment.swept, [&](const Swept& swept) { return swept.name == name; });
  for (Experiment& part : experiment.parts) apply_override(part, assignment);
  if (std::find(experiment.overridden.begin(), experiment.overridden.end(), name) == experiment.overridden.end())
    experiment.overridden.push_back(name);
}

const Experiment& part_of_point(const Experiment& experiment, int64_t id) {
  for (const Experiment& part : experiment.parts) {
    const int64_t count = point_count(part);
    if (id < count) return part;
    id -= count;
  }
  return experiment;
}

std::vector<std::string> swept_names(const Experiment& experiment) {
  std::vector<std::string> names;
  for (const Swept& swept : experiment.swept) names.push_back(swept.name);
  for (const Experiment& part : experiment.parts)
    for (const std::string& name : swept_names(part))
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

int64_t point_count(const Experiment& experiment) {
  int64_t count = experiment.parts.empty() ? 1 : 0;
  for (const Experiment& part : experiment.parts) count += point_count(part);
  for (const Swept& swept : experiment.swept) {
    count *= static_cast<int64_t>(swept.values.size());
    // Each list fits in memory, so the product stays far from overflow when it is checked at every step.
    if (count > max_points)
      throw Error(ErrorKind::usage, fmt::format("{}: the sweep has more than {} points; sweep fewer values",
                                                experiment.path, max_points));
  }
  return count;
}

std::vector<Settings> points(const Experiment& experiment) {
  const int64_t count = point_count(experiment);
  std::vector<Settings> all;
  if (!experiment.parts.empty()) {
    for (const Experiment& part : experiment.parts)
      for (Settings& settings : points(part)) all.push_back(std::move(settings));
    return all;
  }
  all.reserve(static_cast<size_t>(count));
  for (int64_t id = 0; id < count; ++id) {
    Settings settings = experiment.base;
    std::vector<std::string> choice;
    const std::vector<size_t> at = digits(experiment, id);
    for (size_t i = 0; i < at.size(); ++i) {
      const Swept& swept = experiment.swept[i];
      find_setting(swept.name).set(settings, swept.values[at[i]]);
      choice.push_back(fmt::format("{} = {}", swept.name, swept.values[at[i]]));
    }
    try {
      validate(settings);
    } catch (const Error& error) {
      if (experiment.path.empty()) throw;  // a point from the command line alone has no name to add
      throw Error(
          ErrorKind::usage,
          fmt::format("{}: {}point {}{}{}{}: {}", experiment.path,
                      experiment.part.empty() ? "" : fmt::format("part '{}': ", experiment.part), id,
                      choice.empty() ? "" : " (", fmt::join(choice, ", "), choice.empty() ? "" : ")", error.what()));
    }
    all.push_back(std::move(settings));
  }
  return all;
}

std::map<std::string, std::string> settings_map(const Settings& settings) {
  std::map<std::string, std::string> map;
  for (const Setting& row : settings_table()) map[std::string(row.name)] = row.get(settings);
  return map;
}

std::string reproduce_command(const Experiment& experiment, const PointRecord& point) {
  std::string command = "noonmark render " + shell_quoted(experiment.path);
  const auto add = [&](const std::string& name) {
    const auto setting = point.settings.find(name);
    if (setting != point.settings.end()) command += " --set " + shell_quoted(name + "=" + setting->second);
  };
  for (const std::string& name : experiment.overridden) add(name);
  if (!experiment.parts.empty()) return command + fmt::format(" --point {}", point.id);
  for (const Swept& swept : experiment.swept) add(swept.name);
  return command;
}

namespace {

// What determines the points of one experiment, or of one part.
std::string points_text(const Experiment& experiment) {
  std::string text;
  for (const Setting& row : settings_table()) {
    const auto swept = std::find_if(experiment.swept.begin(), experiment.swept.end(),
                                    [&](const Swept& s) { return s.name == row.name; });
    if (swept == experiment.swept.end()) text += fmt::format("{} = {}\n", row.name, row.get(experiment.base));
  }
  // The order of the sweep is part of it: it gives the points their ids.
  for (const Swept& swept : experiment.swept)
    text += fmt::format("sweep {} = [{}]\n", swept.name, fmt::join(swept.values, " | "));
  const CurveOptions& curve = experiment.curve;
  text += fmt::format("curve.enabled = {}\n", experiment.curve_enabled);
  if (experiment.curve_enabled) {
    text += fmt::format("curve.acne_bound = {}\ncurve.peter_panning_bound = {}\n", curve.acne_bound,
                        curve.peter_panning_bound);
    text += curve.bias_depth.empty() ? "curve.bias_depth = auto\n"
                                     : fmt::format("curve.bias_depth = [{}]\n", fmt::join(curve.bias_depth, ", "));
  }
  return text;
}

// The lines of a part, each named after it.
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
  return text + fmt::format("pictures = {}\n", experiment.pictures);
}

std::string scene_digest(const Scene& scene) {
  Digest digest;
  digest.value(scene.positions.size());
  for (const glm::vec3& p : scene.positions)
    for (int axis = 0; axis < 3; ++axis) digest.value(p[axis]);
  digest.value(scene.triangles.size());
  for (const glm::uvec3& t : scene.triangles)
    for (int corner = 0; corner < 3; ++corner) digest.value(t[corner]);
  const Camera& camera = scene.camera;
  digest.value(camera.projection);
  for (const glm::dvec3& p : {camera.eye_m, camera.target_m, camera.up}) digest.point(p);
  for (double v : {camera.fov_y_deg, camera.height_m}) digest.value(v);
  for (const std::optional<double>& v : {camera.near_m, camera.far_m}) {
    digest.value(v.has_value());
    digest.value(v.value_or(0));
  }
  digest.value(scene.light.kind);
  digest.point(scene.light.position_m);
  digest.point(scene.light.target_m);
  digest.value(scene.light.angular_diameter_deg);
  digest.value(scene.map.has_value());
  if (scene.map)
    for (double v : {scene.map->extent_m, scene.map->near_m, scene.map->far_m}) digest.value(v);
  return digest.text();
}

}  // namespace noonmark
