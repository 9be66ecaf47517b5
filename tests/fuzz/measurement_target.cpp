// The bytes of the input choose a small scene and legal settings, which are measured as in a sweep. What must hold of every
// input: sound_measurement.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "scenes/builtin.h"
#include "technique/settings.h"
#include "tests/fuzz/choices.h"
#include "tests/fuzz/sound_measurement.h"
#include "tests/fuzz/targets.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark::fuzz {
namespace {

// ---- the scene

struct Triangles {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  uint32_t vertex(const glm::dvec3& p) {
    for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(p[axis]));
    return static_cast<uint32_t>(positions.size() / 3 - 1);
  }
  void quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    const uint32_t first = vertex(a);
    vertex(b), vertex(c), vertex(d);
    for (uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + k);
  }
};

// A parallelepiped. The choices can make it flat or slanted.
void add_block(Triangles& to, Choices& choices) {
  const glm::dvec3 o = any_point(choices, 4), x = any_point(choices, 2), y = any_point(choices, 2);
  const glm::dvec3 z = any_point(choices, 2);
  to.quad(o, o + y, o + x + y, o + x);
  to.quad(o + z, o + x + z, o + x + y + z, o + y + z);
  to.quad(o, o + x, o + x + z, o + z);
  to.quad(o + y, o + y + z, o + x + y + z, o + x + y);
  to.quad(o, o + z, o + y + z, o + y);
  to.quad(o + x, o + x + y, o + x + y + z, o + x + z);
}

void add_floor(Triangles& to, Choices& choices) {
  const double y = choices.between(-2, 2), half = choices.between(0.5, 10);
  // The strips share no vertices, so every seam is a T-junction or an unwelded edge.
  const int strips = 1 + choices.below(4);
  const double tilt = choices.between(-1, 1);
  for (int i = 0; i < strips; ++i) {
    const double a = -half + 2 * half * i / strips, b = -half + 2 * half * (i + 1) / strips;
    to.quad({a, y + tilt * a, half}, {b, y + tilt * b, half}, {b, y + tilt * b, -half}, {a, y + tilt * a, -half});
  }
}

std::string scene_file(Choices& choices) {
  Triangles scene;
  const int objects = 1 + choices.below(6);
  for (int i = 0; i < objects; ++i) {
    switch (choices.below(5)) {
      case 0:
      case 1:
        add_floor(scene, choices);
        break;
      case 2: {  // a single triangle; it has no area if corners coincide
        const uint32_t a = scene.vertex(any_point(choices, 4)), b = scene.vertex(any_point(choices, 4));
        const uint32_t c = choices.below(8) == 0 ? a : scene.vertex(any_point(choices, 4));
        scene.indices.insert(scene.indices.end(), {a, b, c});
        break;
      }
      case 3:  // a triangle over vertices that exist already
        for (int k = 0; k < 3 && !scene.positions.empty(); ++k)
          scene.indices.push_back(static_cast<uint32_t>(choices.below(static_cast<int>(scene.positions.size() / 3))));
        break;
      default:
        add_block(scene, choices);
        break;
    }
  }
  // Far from the origin floats are coarse.
  static constexpr double places_m[] = {0, 0, 0, 30, 1000, 1e5};
  static constexpr double sizes[] = {1, 1, 1, 1e-3, 1e3};
  const double place = places_m[choices.below(6)], size = sizes[choices.below(5)];
  for (float& x : scene.positions) x = static_cast<float>(size * x + place);

  nlohmann::json d = test::square();
  d["buffers"] = nlohmann::json::array();
  d["bufferViews"] = nlohmann::json::array();
  d["accessors"] = nlohmann::json::array();
  test::add_accessor(d, test::raw(scene.positions), 5126, "VEC3", scene.positions.size() / 3);
  test::add_accessor(d, test::raw(scene.indices), 5125, "SCALAR", scene.indices.size());
  return d.dump();
}

// ---- the settings

// Limits of the values, so that one execution takes milliseconds. They are the same in every scene.
double most_of(const Setting& row) {
  if (row.name == "view.width_px") return 24;
  if (row.name == "view.height_px") return 18;
  if (row.name == "map.resolution") return 96;
  if (row.name == "cascades.resolutions") return 200;
  if (row.name == "map.placements") return 3;
  if (row.name == "filter.size") return 7;
  return row.max;
}
double least_of(const Setting& row) { return row.name == "truth.standard_error" ? 0.1 : row.min; }

std::string any_value(const Setting& row, Choices& choices) {
  if (row.may_be_auto && choices.below(4) == 0) return "auto";
  const double least = least_of(row), most = most_of(row);
  switch (row.type) {
    case ValueType::integer:
      return fmt::format("{}", static_cast<int>(least) + choices.below(static_cast<int>(most - least) + 1));
    case ValueType::flag:
      return choices.below(2) == 0 ? "false" : "true";
    case ValueType::choice:
      return std::string(row.choices[static_cast<size_t>(choices.below(static_cast<int>(row.choices.size())))]);
    case ValueType::point: {
      const double reach = row.unit == "deg" ? 200 : 8;
      const glm::dvec3 p = any_point(choices, std::min(choices.below(8) == 0 ? 1000.0 : reach, row.max));
      return fmt::format("{},{},{}", p.x, p.y, p.z);
    }
    case ValueType::list: {
      std::string list;
      double number = 0;
      for (int n = choices.below(8); n >= 0; --n) {
        number += std::pow(10.0, choices.between(-2, 2));
        list += fmt::format("{}{}", list.empty() ? "" : ",", number);
      }
      return list;
    }
    case ValueType::real_list: {
      std::string list;
      for (int n = choices.below(most_cascades); n >= 0; --n)
        list += fmt::format("{}{}", list.empty() ? "" : ",", std::pow(10.0, choices.between(-3, 3)));
      return list;
    }
    case ValueType::whole_list: {
      std::string list;
      for (int n = choices.below(most_cascades); n >= 0; --n)
        list += fmt::format("{}{}", list.empty() ? "" : ",", 1 + choices.below(static_cast<int>(most)));
      return list;
    }
    case ValueType::real:
      switch (choices.below(8)) {
        case 0:
          return fmt::format("{}", choices.below(2) == 0 ? least : most);
        case 1:
          return fmt::format("{}", choices.between(least, most));
        case 2:
          return fmt::format("{}", std::clamp(std::round(choices.between(-3, 8)), least, most));
        default:  // any magnitude up to a hundred, the range of useful settings
          return fmt::format("{}", std::clamp(std::pow(10.0, choices.between(-6, 2)), least, most));
      }
    case ValueType::text:
      break;
  }
  throw std::logic_error("no value for " + std::string(row.name));
}

void choose(Settings& settings, int count, Choices& choices) {
  const std::span<const Setting> table = settings_table();
  for (int i = 0; i < count; ++i) {
    const Setting& row = table[static_cast<size_t>(choices.below(static_cast<int>(table.size())))];
    if (row.type == ValueType::text) continue;
    std::string value = any_value(row, choices);
    if (row.name == "filter.size") value = fmt::format("{}", std::stoi(value) | 1);  // an even one is refused at once
    row.set(settings, value);
  }
}

struct Files {
  Folder folder;
  int made = 0;
};

void run(const std::string& bytes) {
  static Files files;
  Choices choices(bytes);
  Settings settings;
  settings.view.width_px = 16;
  settings.view.height_px = 12;
  settings.map.resolution = 32;
  settings.truth.standard_error = 0.1;
  const int kind = choices.below(4);
  if (kind == 0) {
    const std::span<const BuiltinScene> scenes = builtin_scenes();
    settings.scene.name = scenes[static_cast<size_t>(choices.below(static_cast<int>(scenes.size())))].name;
  } else {
    // A new name each time, so that results of the last scene are not used for this one.
    const std::string old = files.folder.file(fmt::format("{}.gltf", files.made));
    std::filesystem::remove(old);
    const std::string name = fmt::format("{}.gltf", ++files.made);
    files.folder.write(name, scene_file(choices));
    settings.scene.name = files.folder.file(name);
  }
  const bool curve = choices.below(2) == 0, compare = choices.below(4) == 3;
  const int points = 1 + choices.below(3);
  for (int i = 0; i < points; ++i) {
    choose(settings, i == 0 ? choices.below(16) : 1 + choices.below(3), choices);
    try {
      measure_soundly(settings, curve, compare);
    } catch (const Broken& broken) {
      throw Broken(broken.what() + described(settings));
    } catch (const Error& error) {  // settings that cannot be combined, or a scene without a triangle
      require(error.kind() == ErrorKind::usage || error.kind() == ErrorKind::file,
              std::string("an error of another kind: ") + error.what());
      require(*error.what() != '\0', "an error without a message");
    }
  }
}

std::string any_choices(size_t size, Random& random) {
  std::string bytes(size, '\0');
  for (char& c : bytes) c = static_cast<char>(random());
  return bytes;
}

std::vector<std::string> seeds() {
  std::vector<std::string> all;
  Random random(7);
  for (size_t i = 0; i < 24; ++i) all.push_back(any_choices(40 + 12 * i, random));
  return all;
}

// Every input is valid, so a new input finds as much as an edited one.
std::string mutate(const std::string& bytes, Random& random, const EditBytes& edit) {
  return below(random, 4) == 0 ? any_choices(20 + below(random, 300), random) : edit(bytes, random);
}

std::vector<std::string> words() { return {}; }

}  // namespace

const Target measurement_target = {"measurement", run, seeds, words, mutate};

}  // namespace noonmark::fuzz
