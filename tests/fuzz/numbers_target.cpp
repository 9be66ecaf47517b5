// The input is lines "name = value" for settings, in one of a few small scenes. A value is refused with the setting's name, or
// it is the value with which a sound measurement is made. The seeds are every number of every setting with every odd number,
// and with both ends of its range; a new row of the table has its seeds by itself.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "scenes/library.h"
#include "technique/chosen_light.h"
#include "technique/setting_rules.h"
#include "technique/settings.h"
#include "tests/fuzz/odd_numbers.h"
#include "tests/fuzz/sound_measurement.h"
#include "tests/fuzz/targets.h"

namespace noonmark::fuzz {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

// Between them they read every setting. The first line of an input may name one: "base = 3".
const std::vector<Lines>& bases() {
  static const std::vector<Lines> made = {
      {{"scene.name", "cube-room"}},
      {{"scene.name", "cube-room"}, {"light.kind", "spot"}, {"light.radius_m", "0.1"}, {"filter.kind", "poisson"}},
      {{"scene.name", "cube-room"}, {"light.kind", "point"}, {"filter.kind", "cube_disk"}},
      {{"scene.name", "crease"},
       {"light.angular_diameter_deg", "1"},
       {"bias.reference", "receiver_plane"},
       {"filter.kind", "box"}},
      {{"scene.name", "cube-room"},
       {"map.fit", "sphere"},
       {"cascades.count", "2"},
       {"cascades.blend", "0.2"},
       {"cascades.splits", "practical"},
       {"map.snap", "true"}},
      {{"scene.name", "cube-room"},
       {"map.fit", "corner_box"},
       {"cascades.count", "2"},
       {"cascades.splits", "manual"},
       {"cascades.bounds_m", "4"}},
      {{"scene.name", "cube-room"}, {"map.fit", "view"}, {"cascades.count", "2"}, {"cascades.splits", "exponent"}},
      {{"scene.name", "cube-room"}, {"map.fit", "sphere"}, {"cascades.count", "2"}, {"cascades.splits", "first_bound"}},
      {{"scene.name", "plate"}, {"lookup.kind", "vsm"}, {"filter.kind", "gaussian"}},
      {{"scene.name", "plate"}, {"lookup.kind", "evsm4"}, {"filter.kind", "box"}},
      {{"scene.name", "plate"}, {"lookup.kind", "msm"}, {"filter.kind", "box"}},
      {{"scene.name", "plate"}, {"lookup.kind", "three_vsm"}},
      {{"scene.name", "layers"},
       {"motion.frame", "2"},
       {"motion.move_m", "0.1,0,0"},
       {"motion.light_turn_deg", "0,5,0"},
       {"motion.light_period", "7"}},
      {{"scene.name", "wall"},
       {"view.projection", "orthographic"},
       {"bias.slope", "0.001"},
       {"bias.tan", "0.001"},
       {"bias.polygon_units", "1"}},
      {{"scene.name", "plane"}, {"light.azimuth_deg", "20"}, {"light.elevation_deg", "50"}},
  };
  return made;
}

// So that one execution takes milliseconds.
void make_small(Settings& settings) {
  settings.view.width_px = 16;
  settings.view.height_px = 12;
  settings.map.resolution = 32;
  settings.truth.standard_error = 0.1;
}
double most_of(const Setting& row) {
  if (row.name == "view.width_px") return 24;
  if (row.name == "view.height_px") return 18;
  if (row.name == "map.resolution" || row.name == "cascades.resolutions") return 96;
  if (row.name == "map.placements") return 2;
  if (row.name == "filter.size") return 7;
  return row.max;
}
bool takes_too_long(const Setting& row, std::string_view value) {
  if (row.name == "truth.standard_error") return value != "0.5";
  return false;
}

std::optional<double> number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == 0 ? std::optional(value) : std::nullopt;
}

std::vector<std::string> parts_of(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream in(list);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

// Sets the value, unless it is refused. What is taken is the value that was given.
bool take(Settings& settings, const std::string& name, const std::string& value) {
  const Setting& row = find_setting(name);
  try {
    row.set(settings, value);
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::usage, "an error of another kind: " + std::string(error.what()));
    require(std::string(error.what()).find(name) != std::string::npos,
            "a message without the setting's name: " + std::string(error.what()));
    return false;
  }
  if (row.type != ValueType::integer && row.type != ValueType::real && !row.is_of_numbers()) return true;
  const std::vector<std::string> given = parts_of(value), kept = parts_of(row.get(settings));
  require(given.size() == kept.size(), fmt::format("{} = {} became {}", name, value, row.get(settings)));
  for (size_t i = 0; i < given.size(); ++i) {
    if (given[i] == "auto") continue;
    const std::optional<double> a = number_of(given[i]), b = number_of(kept[i]);
    require(a && b && *a == *b && std::isfinite(*a), fmt::format("{} = {} became {}", name, value, row.get(settings)));
  }
  return true;
}

void run(const std::string& bytes) {
  size_t base = 0;
  Lines lines;
  std::istringstream in(bytes);
  for (std::string line; std::getline(in, line);) {
    const size_t equals = line.find(" = ");
    if (equals == line.npos) continue;
    const std::string name = line.substr(0, equals), value = line.substr(equals + 3);
    if (name == "base")
      base = static_cast<size_t>(std::abs(std::atoi(value.c_str()))) % bases().size();
    else
      lines.emplace_back(name, value);
  }
  Settings settings;
  make_small(settings);
  for (const auto& [name, value] : bases()[base]) find_setting(name).set(settings, value);
  bool any = false;
  for (const auto& [name, value] : lines) {
    const std::span<const Setting> table = settings_table();
    if (std::none_of(table.begin(), table.end(), [&](const Setting& row) { return row.name == name; })) continue;
    const Setting& row = find_setting(name);
    if (row.type == ValueType::text) continue;
    Settings tried = settings;
    if (!take(tried, name, value)) continue;
    const std::vector<std::string> numbers = parts_of(row.get(tried));
    if (std::any_of(numbers.begin(), numbers.end(),
                    [&](const std::string& n) { return number_of(n).value_or(0) > most_of(row); }) ||
        takes_too_long(row, row.get(tried)))
      continue;
    settings = tried;
    any = any || (row.type != ValueType::choice && row.type != ValueType::flag);
  }
  if (!any) return;
  try {
    measure_soundly(settings, bytes.size() % 3 == 0, false);
  } catch (const Broken& broken) {
    throw Broken(broken.what() + described(settings));
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::usage,
            std::string("an error of another kind: ") + error.what() + described(settings));
    require(std::string(error.what()).find('.') != std::string::npos,
            "an error that names no setting: " + std::string(error.what()));
  }
}

bool reads(const Setting& row, const Lines& lines) {
  Settings settings;
  for (const auto& [name, value] : lines) find_setting(name).set(settings, value);
  const LightKind light = chosen_light(make_scene(settings.scene), settings.light).light.kind;
  return !row.why_idle || row.why_idle(settings, light).empty();
}

// The first lines of an input that reads the row: one of the bases, from this one on, or a filter or a lookup of its own.
std::string first_lines(const Setting& row, size_t from) {
  for (size_t i = 0; i < bases().size(); ++i)
    if (const size_t base = (from + i) % bases().size(); reads(row, bases()[base]))
      return fmt::format("base = {}\n", base);
  for (const char* kind : {"filter.kind", "lookup.kind"})
    for (const std::string_view choice : find_setting(kind).choices) {
      Lines lines = bases()[0];
      lines.emplace_back(kind, choice);
      if (reads(row, lines)) return fmt::format("base = 0\n{} = {}\n", kind, choice);
    }
  return fmt::format("base = {}\n", from % bases().size());  // only in a scene from a file
}

std::vector<std::string> seeds() {
  std::vector<std::string> all;
  size_t next = 0;
  for (const Setting& row : settings_table()) {
    std::vector<std::string> numbers(std::begin(odd_numbers), std::end(odd_numbers));
    const double most = most_of(row);
    for (const double end : {row.min, most}) numbers.push_back(fmt::format("{}", end));
    const auto add = [&](const std::string& value) {
      all.push_back(fmt::format("{}{} = {}\n", first_lines(row, next++), row.name, value));
    };
    switch (row.type) {
      case ValueType::integer:
      case ValueType::real:
        for (const std::string& number : numbers) add(number);
        break;
      case ValueType::point:
        for (const std::string& number : numbers)
          for (int axis = 0; axis < 3; ++axis)
            add(fmt::format("{},{},{}", axis == 0 ? number : "0.25", axis == 1 ? number : "0.5",
                            axis == 2 ? number : "1"));
        break;
      case ValueType::list:
      case ValueType::whole_list:
      case ValueType::real_list:
        for (const std::string& number : numbers)
          for (const char* form : {"{}", "{},2", "2,{}"}) add(fmt::format(fmt::runtime(form), number));
        break;
      default:
        break;
    }
  }
  return all;
}

// Several odd numbers together.
std::string mutate(const std::string& bytes, Random& random, const EditBytes& edit) {
  static const std::vector<std::string> known = seeds();
  if (below(random, 8) == 0) return edit(bytes, random);
  const std::string& other = known[below(random, known.size())];
  return bytes + other.substr(other.find('\n') + 1);
}

std::vector<std::string> words() {
  std::vector<std::string> all;
  for (const Setting& row : settings_table()) all.push_back(std::string(row.name) + " = ");
  for (const std::string_view number : odd_numbers) all.emplace_back(number);
  return all;
}

}  // namespace

const Target numbers_target = {"numbers", run, seeds, words, mutate};

}  // namespace noonmark::fuzz
