// The input is a frame.json for a picture of 32 x 18 pixels. It is judged, or refused with one Error(file). The seeds are frames
// that have every number that the format knows, and each number in them replaced by each odd number.
#include <fmt/format.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "app/pictures/given_frame.h"
#include "app/sweep/frame_map.h"
#include "base/error.h"
#include "frames/frame_file.h"
#include "frames/frame_keys.h"
#include "frames/judge.h"
#include "raytrace/tracer.h"
#include "scenes/library.h"
#include "tests/fuzz/json_mutator.h"
#include "tests/fuzz/odd_numbers.h"
#include "tests/fuzz/targets.h"

namespace noonmark::fuzz {
namespace {

using Json = nlohmann::json;

constexpr int width = 32, height = 18, texels = 16;

// NumPy's format, version 1.
std::string npy(const std::string& shape, size_t count, float value) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + shape + "), }";
  header.resize((10 + header.size() + 64) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  std::string bytes = std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size() % 256) +
                      static_cast<char>(header.size() / 256) + header;
  for (size_t i = 0; i < count; ++i) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof raw);
  }
  return bytes;
}

struct Shots {
  Folder folder;
  Scene scene = make_scene({.name = "plate"});
  raytrace::Tracer tracer{scene};
  FrameMap map{scene, tracer};
  Shots() {
    folder.write("visibility.npy", npy(fmt::format("{}, {}", height, width), width * height, 1));
    folder.write("depth.npy", npy(fmt::format("{}, {}", height, width), width * height, 0.5f));
    folder.write("positions.npy", npy(fmt::format("{}, {}, 3", height, width), width * height * 3, 0.5f));
    folder.write("map.npy", npy(fmt::format("{0}, {0}", texels), texels * texels, 0.5f));
  }
};

void run(const std::string& bytes) {
  static const Shots shots;
  try {
    const FrameFile file = parse_frame_file(shots.folder.file("frame.json"), bytes);
    const GivenFrame frame = given_frame(file, shots.scene);
    JudgeRules rules = rules_of(file);
    for (const FrameCheck& check : frame_checks()) rules.accepted.insert(std::string(check.name));
    FrameVerdict verdict = judge_frame(shots.scene, shots.tracer, frame, rules);
    double sum = 0;
    for (const FrameClassRow& row : frame_classes) sum += verdict.metrics.at(std::string(row.metric));
    const double error = verdict.metrics.at("frame_error"), counted = verdict.metrics.at("counted");
    constexpr double rounding = 1e-9;  // of sums of 576 numbers in double
    require(counted == 0 || (error >= 0 && error <= 1 && std::abs(sum - error) <= rounding),
            fmt::format("an error of {}, and classes of {}", error, sum));
    if (frame.map) const_cast<FrameMap&>(shots.map).climb(frame, true, verdict);
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::file, std::string("an error of another kind: ") + error.what());
    require(*error.what() != '\0', "an error without a message");
  }
}

const Json& column_matrices() {
  static const Json made = {{"order", "column"}, {"depth_range", "-1..1"}, {"reversed", false}};
  return made;
}

// Between them they have every key with a number.
std::vector<Json> frames() {
  const Json least = {{"noonmark_frame", 1}, {"scene", "plate"}, {"visibility", {{"file", "visibility.npy"}}}};
  const Json top = {2 / 12., 0, 0, 0, 0, 0, -2 / 20., 0, 0, -2 / 6.75, 0, 0, 0, 0, -0.4, 1};
  const Json one = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const auto with = [&](std::initializer_list<std::pair<const char*, Json>> members) {
    Json frame = least;
    for (const auto& [name, value] : members) frame[name] = value;
    return frame;
  };
  const auto matrices = [&](Json object) {
    object.update(column_matrices());
    return object;
  };
  const Json sun = {{"kind", "directional"}, {"direction", {0.5, -1, 0}}, {"angular_diameter_deg", 1}};
  const Json lamp = {
      {"kind", "spot"}, {"position", {0, 5, 0}}, {"target", {0.5, 0, 0.5}}, {"cone_deg", 60}, {"radius", 0.1}};
  const Json bulb = {{"kind", "point"}, {"position", {0, 5, 0}}, {"radius", 0.1}, {"shape", "disc"}};
  return {
      with({{"metres_per_unit", 1},
            {"visibility", {{"file", "visibility.npy"}, {"step", 0.004}}},
            {"camera",
             {{"eye", {0, 8, 0.1}},
              {"target", {0, 0, 0}},
              {"up", {0, 0, -1}},
              {"fov_y_deg", 60},
              {"near", 0.1},
              {"far", 100}}},
            {"light", sun},
            {"edge", {{"pixels", 2}}},
            {"contact", {{"distance", 0.1}}}}),
      with({{"metres_per_unit", 0.01},
            {"camera", {{"eye", {0, 800, 10}}, {"target", {0, 0, 0}}, {"height", 700}, {"near", 1}, {"far", 10000}}},
            {"light",
             {{"kind", "spot"},
              {"position", {0, 500, 0}},
              {"direction", {0, -1, 0.1}},
              {"cone_deg", 60},
              {"radius", 0.1}}},
            {"edge", {{"texels", 2}, {"texel", 1}}},
            {"depth", {{"file", "depth.npy"}}}}),
      with({{"camera", matrices({{"clip_from_world", top}})}, {"light", lamp}, {"edge", {{"distance", 0.1}}}}),
      with({{"camera", matrices({{"view", one}, {"projection", top}})},
            {"light", bulb},
            {"positions", {{"file", "positions.npy"}}}}),
      with({{"camera", matrices({{"clip_from_world", top}})},
            {"light", {{"kind", "directional"}, {"direction", {0, -1, 0}}}},
            {"map", matrices({{"file", "map.npy"},
                              {"first_row", "bottom"},
                              {"view", one},
                              {"projection", {0.2, 0, 0, 0, 0, 0, -0.1, 0, 0, -0.2, 0, 0, 0, 0, -0.4, 1}},
                              {"technique", {{"bias.constant", 0.001}, {"filter.kind", "box"}}}})}}),
      with({{"light", {{"kind", "directional"}, {"direction", {0, -1, 0}}}},
            {"map", matrices({{"file", "map.npy"},
                              {"first_row", "top"},
                              {"clip_from_world", {0.2, 0, 0, 0, 0, 0, -0.1, 0, 0, -0.2, 0, 0, 0, 0, -0.4, 1}}})}})};
}

std::vector<std::string> seeds() {
  std::vector<std::string> all;
  std::set<std::string> reached;
  for (const Json& frame : frames()) {
    all.push_back(frame.dump());
    const Json flat = frame.flatten();
    for (const auto& [pointer, value] : flat.items()) {
      if (!value.is_number() || pointer == "/noonmark_frame") continue;
      reached.insert(pointer);
      for (const std::string_view number : odd_numbers) {
        // Not every one is a number of JSON, so it is written into the text.
        Json changed = frame;
        changed[Json::json_pointer(pointer)] = "@";
        std::string text = changed.dump();
        text.replace(text.find("\"@\""), 3, number);
        all.push_back(std::move(text));
      }
    }
  }
  for (const FrameKey& key : frame_keys()) {
    if (key.kind != FrameKeyKind::number && key.kind != FrameKeyKind::vector3 && key.kind != FrameKeyKind::matrix)
      continue;
    const std::string pointer = (key.object.empty() ? "" : "/" + std::string(key.object)) + "/" +
                                std::string(key.name) + (key.kind == FrameKeyKind::number ? "" : "/0");
    require(reached.contains(pointer), "no seed has the key " + key.full_name());
  }
  return all;
}

std::vector<std::string> words() {
  std::vector<std::string> all;
  for (const FrameKey& key : frame_keys()) all.emplace_back(key.name);
  return all;
}

std::string mutate(const std::string& bytes, Random& random, const EditBytes& edit) {
  static const std::vector<std::string> known = words();
  Json document = Json::parse(bytes, nullptr, false);
  if (document.is_discarded()) return edit(bytes, random);
  mutate_json(document, random, known, edit);
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

const Target frame_target = {"frame", run, seeds, words, mutate};

}  // namespace noonmark::fuzz
