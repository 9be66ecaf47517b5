#include "app/pictures/given_frame.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

#include "app/pictures/image_file.h"
#include "base/error.h"
#include "base/file.h"
#include "frames/frame.h"
#include "frames/map_frame.h"
#include "frames/value_curve.h"
#include "scenes/camera_fit.h"
#include "scenes/library.h"
#include "technique/depth_format.h"
#include "technique/light_frame.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr uint64_t most_json_bytes = 1 << 20;

[[noreturn]] void refuse_picture(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::file, fmt::format("{}: {}", path, why));
}

// Alpha says whether there is a surface.
bool has_surface(const DecodedImage& image, size_t pixel) {
  if (!image.alpha) return true;
  const float alpha = image.at(pixel, *image.alpha);
  if (alpha != 0 && alpha != 1)
    refuse_picture(
        image.path,
        fmt::format("its alpha is {:g} at x = {}, y = {}, but a pixel has a surface (1) or none (0): write one "
                    "sample at each pixel's centre, without multisampling",
                    alpha, pixel % static_cast<size_t>(image.width), pixel / static_cast<size_t>(image.width)));
  return alpha == 1;
}

// How far two values near 1 lie apart, by the order of StoredAs. A value that is cut off lies by up to as much beside what was drawn.
constexpr double steps[] = {1.0 / 255, 1.0 / 65535, 0x1p-11, 0};

// With its step.
std::pair<Image<float>, double> read_visibility(const std::string& path, ValueEncoding encoding) {
  const DecodedImage image = read_image(path, [&](const DecodedImage& head) {
    require_grey_channels(head);
    require_frame_memory(path, head.width, head.height);
  });
  Image<float> visibility(image.width, image.height);
  visibility.pixels = grey_values(image);
  for (size_t i = 0; i < visibility.size(); ++i) {
    float& value = visibility[i];
    if (!has_surface(image, i))
      value = std::numeric_limits<float>::quiet_NaN();
    else if (encoding == ValueEncoding::srgb && value > 0)  // not the marks
      value = static_cast<float>(linear_of_srgb(value));
  }
  const double step = steps[static_cast<size_t>(image.stored_as)];
  return {std::move(visibility), encoding == ValueEncoding::srgb ? 1 - linear_of_srgb(1 - step) : step};
}

// Positions and depths have the pixels of the visibility.
void require_size(const DecodedImage& image, const Image<float>& visibility) {
  if (image.width != visibility.width || image.height != visibility.height)
    refuse_picture(image.path, fmt::format("has {} x {} pixels, but the visibility has {} x {}; write both in one size",
                                           image.width, image.height, visibility.width, visibility.height));
}

// What the channels beside alpha hold, in the renderer's coordinates. Alpha says where there is a surface.
Image<glm::dvec3> read_positions(const std::string& path, const Image<float>& visibility) {
  std::vector<size_t> axes;
  const DecodedImage image = read_image(path, [&](const DecodedImage& head) {
    for (size_t c = 0; c < head.channels.size(); ++c)
      if (c != head.alpha) axes.push_back(c);
    if (axes.size() != 3)
      refuse_picture(path, fmt::format("has {} channels; write world positions as three channels (x, y, z)",
                                       head.channels.size()));
    if (head.stored_as == StoredAs::uint8 || head.stored_as == StoredAs::uint16)
      refuse_picture(path, "has whole numbers; write world positions as 32-bit floats");
    require_size(head, visibility);
  });
  Image<glm::dvec3> positions(image.width, image.height, glm::dvec3(none));
  for (size_t i = 0; i < positions.size(); ++i)
    if (has_surface(image, i)) positions[i] = {image.at(i, axes[0]), image.at(i, axes[1]), image.at(i, axes[2])};
  return positions;
}

Image<glm::dvec3> positions_of_depths(const FrameFile& file, const std::string& path, const ViewMatrix& view,
                                      const Image<float>& visibility) {
  const DecodedImage image = read_image(path, [&](const DecodedImage& head) {
    if (head.stored_as != StoredAs::float32) refuse_picture(path, "write depths as 32-bit floats");
    require_grey_channels(head);
    require_size(head, visibility);
  });
  const std::vector<float> depths = grey_values(image);
  Image<glm::dvec3> positions(image.width, image.height, glm::dvec3(none));
  const glm::dmat4& m = view.clip_from_world();
  const glm::dvec3 w_grows(m[0][3], m[1][3], m[2][3]);
  if (file.depth_measure == DepthMeasure::view_z && !(glm::length(w_grows) > 0))
    refuse_picture(path, "view_z is a measure of perspective cameras; give window depth, or positions");
  const double far = file.convention.reversed ? 0 : 1;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double depth = depths[positions.index(x, y)];
      if (std::isnan(depth)) continue;
      if (file.depth_measure == DepthMeasure::window) {
        if (depth == far) continue;
        const double clip = file.convention.reversed ? 1 - 2 * depth : 2 * depth - 1;
        positions.at(x, y) = view.world_at(x, y, clip, image.width, image.height);
      } else if (depth > 0 && std::isfinite(depth)) {
        // w of clip space is the depth along the view, except for a factor of the projection.
        const Ray ray = view.pixel_ray(x, y, image.width, image.height);
        const double at_start = glm::dot(w_grows, ray.origin) + m[3][3], wanted = depth * glm::length(w_grows);
        positions.at(x, y) = ray.origin + (wanted - at_start) / glm::dot(w_grows, ray.direction) * ray.direction;
      }
    }
  return positions;
}

// What the depths of the file say of the format that they were drawn in: it stands in the technique if nothing else does.
void check_format(const std::vector<float>& depths, GivenMap& map) {
  const Setting& format = find_setting("map.format");
  Settings settings;
  for (const auto& [name, value] : map.technique)
    if (name == format.name) {
      format.set(settings, value);
      if (!are_held_by(settings.map.format, depths))
        refuse_picture(map.name,
                       fmt::format("its depths are no multiples of 1 / (2^{} - 1), so they were not drawn in the "
                                   "map.format of the technique; leave that out, or declare 32f",
                                   value));
      return;
    }
  if (const std::optional<DepthFormat> told = told_format(depths)) {
    settings.map.format = *told;
    map.technique.emplace_back(format.name, format.get(settings));
  }
}

GivenMap read_map(const FrameFile& file) {
  const std::string path = path_in(file, file.map->file);
  const DecodedImage image = read_image(path, [&](const DecodedImage& head) {
    if (head.stored_as != StoredAs::float32) refuse_picture(path, "write the map's depths as 32-bit floats");
    require_grey_channels(head);
  });
  const std::vector<float> depths = grey_values(image);
  GivenMap map{path, Image<float>(image.width, image.height), file.map_from_world(), file.map->technique};
  check_format(depths, map);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float depth = depths[map.depth.index(x, y)];
      if (!(depth >= 0 && depth <= 1))
        refuse_picture(path,
                       fmt::format("the texel x = {}, y = {} of the file is {:g}; write the depth that the lookup "
                                   "compares, from 0 to 1",
                                   x, y, depth));
      map.depth.at(x, file.map->top_row_first ? image.height - 1 - y : y) =
          file.map->convention.reversed ? 1 - depth : depth;
    }
  return map;
}

}  // namespace

FrameFile read_frame_file(const std::string& path) { return parse_frame_file(path, read_file(path, most_json_bytes)); }

JudgeRules rules_of(const FrameFile& file) {
  JudgeRules rules;
  rules.edge_m = file.edge_m;
  rules.edge_pixels = file.edge_pixels.value_or(rules.edge_pixels);
  rules.contact_m = file.contact_m;
  return rules;
}

std::string path_in(const FrameFile& file, const std::string& named) {
  return (std::filesystem::path(file.path).parent_path() / named).lexically_normal().string();
}

std::string scene_name_of(const FrameFile& file) {
  if (!file.scene) refuse_picture(file.path, "names no scene; add the key 'scene'");
  return names_file(*file.scene) ? path_in(file, *file.scene) : *file.scene;
}

Scene scene_of(const FrameFile& file) {
  SceneSettings settings;
  settings.name = scene_name_of(file);
  try {
    return make_scene(settings);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::usage) refuse_picture(file.path, fmt::format("'scene': {}", error.what()));
    throw;
  }
}

GivenFrame given_frame(const FrameFile& file, const Scene& scene) {
  const std::string path = path_in(file, file.visibility);
  auto [visibility, step] = read_visibility(path, file.encoding);
  const int width = visibility.width, height = visibility.height;
  require_frame_memory(path, width, height);
  GivenFrame frame{.name = path,
                   .visibility = std::move(visibility),
                   .positions = {},
                   .view = file.view(scene, width, height),
                   .light = file.light_in(scene)};
  if (file.map && frame.light.kind == LightKind::point)
    refuse_picture(file.path, fmt::format("'map': {}", no_map_of_point_light));
  if (file.positions) {
    frame.receivers = GivenReceivers::positions;
    frame.positions = read_positions(path_in(file, *file.positions), frame.visibility);
    for (glm::dvec3& p : frame.positions.pixels) p = glm::dvec3(file.world_from_frame * glm::dvec4(p, 1));
  } else if (file.depth) {
    frame.receivers = GivenReceivers::depth;
    frame.positions = positions_of_depths(file, path_in(file, *file.depth), frame.view, frame.visibility);
  }
  take_marks(frame);
  frame.normalised = file.normalised;
  frame.step = file.step.value_or(step);
  if (frame.receivers != GivenReceivers::none) frame.marks_no_surface = true;
  frame.not_in_map = file.not_in_map;
  frame.notes = file.notes;
  if (file.map) frame.map = read_map(file);
  return frame;
}

GivenFrame given_frame(const std::string& picture, ValueEncoding encoding, const Scene& scene,
                       const Settings& settings) {
  Image<float> visibility =
      read_visibility(picture, encoding).first;  // a step is of a lookup, which is not declared here
  ViewSettings view = settings.view;
  view.width_px = visibility.width;
  view.height_px = visibility.height;
  GivenFrame frame{
      .name = picture,
      .visibility = std::move(visibility),
      .positions = {},
      .view =
          ViewMatrix(make_camera_frame(effective_camera(scene, view), view.width_px, view.height_px).clip_from_world()),
      .light = effective_light(scene, settings)};
  take_marks(frame);
  return frame;
}

}  // namespace noonmark
