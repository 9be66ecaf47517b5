#include "frames/frame_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "base/error.h"
#include "frames/frame_file.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

using Kind = FrameKeyKind;

constexpr double degrees(double radians) { return radians * 180 / std::numbers::pi; }

// Of a camera of a frame, as of one of a scene file.
constexpr NumberRange view_angle_deg{degrees(ranges::view_angle_rad.least), degrees(ranges::view_angle_rad.most)};
// A matrix is the same times any number, so its numbers have no unit; products of two of these are finite.
constexpr NumberRange of_matrix{-1e30, 1e30};
constexpr NumberRange unit_m{1e-9, 1e6};  // from a nanometre on
constexpr NumberRange edge_m{1e-9, ranges::coordinate_m.most};
constexpr NumberRange step{0, 0.5};           // beyond a half any lookup would be the frame's own
constexpr NumberRange edge_count{1e-3, 1e6};  // of pixels or texels: from none to all of a picture

// The key is the same quantity as this setting.
constexpr FrameKey as(FrameKey key, std::string_view setting) {
  key.setting = setting;
  return key;
}
constexpr FrameKey within(FrameKey key, const NumberRange& range, std::string_view unit) {
  key.own = range;
  key.own_unit = unit;
  return key;
}

constexpr FrameKey key_rows[] = {
    {"", "noonmark_frame", Kind::version, "The version of this format: 1. Required."},
    {"", "scene", Kind::text, "A built-in scene, or the path of a .gltf, .glb or .vrm file, from this file's folder."},
    {"", "visibility", Kind::object, "The picture that is judged. Required."},
    {"visibility", "file", Kind::text,
     "EXR (half or float), PNG (8 or 16 bits) or NPY (uint8, uint16, float16, float32, float64): 1 is lit, 0 shadowed; "
     "-1, "
     "NaN or alpha 0 is no surface; -2 (a float) is a surface that is not judged. The top row comes first; a pixel's "
     "sample is at its centre. Required."},
    {"visibility", "encoding", Kind::choice, "Whether the values are linear, or encoded with sRGB's transfer function.",
     "linear|srgb"},
    within(
        {"visibility", "step", Kind::number,
         "How far a value may lie from what was drawn, because the picture that it was read from has steps. The lookup "
         "of a `map` is the frame's own within it. Default: a step of the file's pixels, 0 of 32-bit floats."},
        step, ""),
    {"visibility", "normalised", Kind::flag,
     "Whether the values are the share between the same frame with all lit and with all dark. Then shaded, intensity, "
     "inverted and match refuse nothing: what they find is the renderer's own shadow."},
    {"", "axes", Kind::axes,
     "The scene's x, y and z (right-handed, Y up, as in glTF), each as an axis of the renderer with its sign: [\"x\", "
     "\"z\", "
     "\"-y\"] where the renderer has Z up. Handedness and up axis follow from it. Default: [\"x\", \"y\", \"z\"]."},
    within({"", "metres_per_unit", Kind::number, "The length of the renderer's unit in metres. Default: 1."}, unit_m,
           "m per unit"),
    {"", "camera", Kind::object, "The camera of the picture. Default: the first camera of the scene's file."},
    {"camera", "name", Kind::text, "A camera of the scene's file, by the name of its node. It needs no other key."},
    as({"camera", "eye", Kind::vector3, "Where the camera is."}, "view.eye_m"),
    as({"camera", "target", Kind::vector3, "A point in the middle of the picture."}, "view.target_m"),
    as({"camera", "up", Kind::vector3, "A direction that is up in the picture. Default: the scene's Y."}, "view.up"),
    within({"camera", "fov_y_deg", Kind::number, "Perspective: the whole vertical angle."}, view_angle_deg, "deg"),
    as({"camera", "height", Kind::number, "Orthographic: the height that the picture shows."}, "view.height_m"),
    as({"camera", "near", Kind::number, "The near plane, along the view. Default: fitted to the scene."},
       "view.near_m"),
    as({"camera", "far", Kind::number, "The far plane. Default: fitted to the scene."}, "view.far_m"),
    within({"camera", "view", Kind::matrix, "4 x 4 matrix from the world to the camera's axes, as 16 numbers."},
           of_matrix, ""),
    within({"camera", "projection", Kind::matrix, "4 x 4 matrix from the camera's axes to clip space."}, of_matrix, ""),
    within({"camera", "clip_from_world", Kind::matrix, "The product of both, in place of them."}, of_matrix, ""),
    {"camera", "order", Kind::choice,
     "Of the numbers of each matrix, which is multiplied with a column vector: column by column, or row by row. A "
     "matrix "
     "that is multiplied with a row vector and stands row by row has the same numbers as \"column\". Required with "
     "matrices.",
     "column|row"},
    {"camera", "depth_range", Kind::choice, "Of clip space after the division. Required with matrices.", "0..1|-1..1"},
    {"camera", "reversed", Kind::flag, "Whether the near plane has the largest depth. Required with matrices."},
    {"camera", "y", Kind::choice, "Whether y of clip space grows upwards, or downwards as in Vulkan.", "up|down"},
    {"", "light", Kind::object, "The light of the picture. Default: the light of the scene's file."},
    {"light", "name", Kind::text,
     "A light of the scene's file, by the name of its node or its own. Beside it only a size can be given."},
    {"light", "kind", Kind::choice, "Required, unless the light is the scene's.", "directional|spot|point"},
    within({"light", "direction", Kind::vector3, "Directional, spot: the way the light travels."}, ranges::of_direction,
           ""),
    as({"light", "position", Kind::vector3, "Spot, point: where the light is."}, "light.position_m"),
    as({"light", "target", Kind::vector3,
        "Directional, spot: a point that the light from `position` aims at, in place of the "
        "direction."},
       "light.target_m"),
    within({"light", "cone_deg", Kind::number, "Spot: the whole angle of the cone."}, ranges::cone_deg, "deg"),
    as({"light", "angular_diameter_deg", Kind::number, "Directional: of a sun with a size. Default: 0, a hard shadow."},
       "light.angular_diameter_deg"),
    as({"light", "radius", Kind::number, "Spot, point: of a lamp with a size. Default: 0."}, "light.radius_m"),
    {"light", "shape", Kind::choice, "Of a lamp with a size.", "sphere|disc"},
    {"", "positions", Kind::object,
     "The world position of every receiver: what the renderer itself shaded. The best choice."},
    {"positions", "file", Kind::text,
     "EXR with three 32-bit float channels (x, y, z), or NPY of height x width x 3; NaN where there is no surface, or "
     "in "
     "an EXR's fourth channel an alpha of 0. Required."},
    {"", "depth", Kind::object, "The depth of every receiver, in place of positions."},
    {"depth", "file", Kind::text, "EXR with one 32-bit float channel, or NPY. Required."},
    {"depth", "measure", Kind::choice,
     "window: from 0 to 1, as a depth buffer of this camera has it, the far plane being no surface; view_z: distance "
     "along the "
     "view of a perspective camera.",
     "window|view_z"},
    {"", "map", Kind::object,
     "The shadow map that the frame was drawn with: one map of a directional or a spot light. With it every "
     "cause of "
     "the ladder is known; it needs OpenGL."},
    {"map", "file", Kind::text,
     "EXR with one 32-bit float channel, or NPY of height x width: the depth that the lookup compares, from 0 "
     "to "
     "1. Required."},
    {"map", "first_row", Kind::choice,
     "Which end of the light's clip space the file's first row is: bottom (y = -1), as OpenGL reads pixels, or top (y "
     "= 1). "
     "Required.",
     "bottom|top"},
    within({"map", "view", Kind::matrix, "4 x 4 matrix from the world to the light's axes."}, of_matrix, ""),
    within({"map", "projection", Kind::matrix, "4 x 4 matrix from the light's axes to clip space."}, of_matrix, ""),
    within({"map", "clip_from_world", Kind::matrix, "The product of both, in place of them."}, of_matrix, ""),
    {"map", "order", Kind::choice, "As of the camera. Required.", "column|row"},
    {"map", "depth_range", Kind::choice, "As of the camera. Required.", "0..1|-1..1"},
    {"map", "reversed", Kind::flag, "As of the camera. Required."},
    {"map", "y", Kind::choice, "As of the camera.", "up|down"},
    {"map", "technique", Kind::settings,
     "How the renderer draws the map and looks it up, in Noonmark's settings by name: bias.*, filter.*, map.format, "
     "map.cull, map.wrap, map.lit_beyond_far, map.depth_clamp, map.pancake. What is left out has its default, which is "
     "no bias and one tap; map.format is that which the depths tell, otherwise 32f."},
    {"", "edge", Kind::object, "How near to a true shadow edge an error is an error of the edge. Default: 2 pixels."},
    within({"edge", "pixels", Kind::number, "In pixels of the picture, at the receiver."}, edge_count, "pixels"),
    within({"edge", "texels", Kind::number, "In texels of the renderer's map; needs `texel`."}, edge_count, "texels"),
    within({"edge", "texel", Kind::number, "The width of a texel of a directional light's map: extent / resolution."},
           edge_m, "m"),
    within({"edge", "distance", Kind::number, "As a length, across the light's rays."}, edge_m, "m"),
    {"", "contact", Kind::object, "How near an occluder is to the receiver where light leaks at a contact."},
    within({"contact", "distance", Kind::number, "Along the light's ray. Default: 1% of the scene's diagonal."}, edge_m,
           "m"),
    {"", "not_in_map", Kind::texts,
     "Names of the scene's nodes that cast shadows and that the frame's shadow map does not hold, as if they had been "
     "culled."},
    {"", "notes", Kind::texts, "What `judge` prints about this frame and writes into judge.json."},
};

}  // namespace

std::string FrameKey::full_name() const {
  return object.empty() ? std::string(name) : fmt::format("{}.{}", object, name);
}

std::span<const FrameKey> frame_keys() { return key_rows; }

FrameRange range_of(const FrameKey& key) {
  if (key.setting.empty()) return {key.own, key.own_unit};
  const Setting& same = find_setting(key.setting);
  return {same.range(), same.unit};
}

FrameRange range_of(std::string_view full_name) {
  for (const FrameKey& key : frame_keys())
    if (key.full_name() == full_name) return range_of(key);
  throw std::logic_error("frame.json has no key '" + std::string(full_name) + "'");
}

std::string FrameRange::text() const {
  return fmt::format("{:.6g} ... {:.6g}{}{}", numbers.least, numbers.most, unit.empty() ? "" : " ", unit);
}

void require_in_range(std::string_view full_name, double value) {
  const FrameRange range = range_of(full_name);
  if (!range.numbers.holds(value))
    throw Error(ErrorKind::usage, fmt::format("{} = {} is not allowed; it takes {}", full_name, value, range.text()));
}

std::vector<std::string_view> choices_of(const FrameKey& key) {
  std::vector<std::string_view> choices;
  for (std::string_view rest = key.choices;;) {
    const size_t end = rest.find('|');
    choices.push_back(rest.substr(0, end));
    if (end == rest.npos) return choices;
    rest.remove_prefix(end + 1);
  }
}

namespace {

using Json = nlohmann::ordered_json;

// A length has the renderer's unit, and its range is in metres.
Json number_schema(const FrameRange& range) {
  if (!range.is_length())
    return {{"type", "number"}, {"minimum", range.numbers.least}, {"maximum", range.numbers.most}};
  if (range.numbers.least > 0) return {{"type", "number"}, {"exclusiveMinimum", 0}};
  if (range.numbers.least == 0) return {{"type", "number"}, {"minimum", 0}};
  return {{"type", "number"}};
}

Json list_schema(Json items, size_t count) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", count}, {"maxItems", count}};
}

struct Form {
  std::string words;
  Json schema;
};

Form form_of(const FrameKey& key) {
  switch (key.kind) {
    case Kind::object:
      return {"object", {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}}};
    case Kind::text:
      return {"text", {{"type", "string"}, {"minLength", 1}}};
    case Kind::choice: {
      const std::vector<std::string_view> words = choices_of(key);
      return {fmt::format("{}", fmt::join(words, " | ")), {{"enum", words}}};
    }
    case Kind::number:
      return {"number, " + range_of(key).text(), number_schema(range_of(key))};
    case Kind::flag:
      return {"boolean", {{"type", "boolean"}}};
    case Kind::vector3:
      return {"three numbers, each " + range_of(key).text(), list_schema(number_schema(range_of(key)), 3)};
    case Kind::axes:
      return {"three axes", list_schema({{"enum", {"x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"}}}, 3)};
    case Kind::matrix:
      return {"16 numbers, each " + range_of(key).text(), list_schema(number_schema(range_of(key)), 16)};
    case Kind::settings:
      return {"settings by name",
              {{"type", "object"}, {"additionalProperties", {{"type", {"string", "number", "boolean", "array"}}}}}};
    case Kind::version:
      return {"1", {{"const", 1}}};
    case Kind::texts:
      return {"list of texts", {{"type", "array"}, {"items", {{"type", "string"}, {"minLength", 1}}}}};
  }
  return {};
}

}  // namespace

std::string taken_by(const FrameKey& key) { return form_of(key).words; }

std::string frame_schema() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "frame.json of Noonmark: the frame of another renderer"},
              {"type", "object"},
              {"additionalProperties", false},
              {"required", {"noonmark_frame", "visibility"}},
              {"properties", Json::object()}};
  for (const FrameKey& key : frame_keys()) {
    Json& owner = key.object.empty() ? schema : schema["properties"][std::string(key.object)];
    Json one = form_of(key).schema;
    one["description"] = key.help;
    owner["properties"][std::string(key.name)] = std::move(one);
    if (!key.object.empty() && key.name == "file") owner["required"].push_back("file");
  }
  return schema.dump(2) + "\n";
}

}  // namespace noonmark
