#include "app/pictures/frame_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "app/pictures/picture_files.h"
#include "app/pictures/pictures.h"
#include "app/pictures/view_colors.h"

namespace noonmark {
namespace {

class FramePainter {
 public:
  FramePainter(const FrameVerdict& verdict, const GivenFrame& frame) : v_(verdict), frame_(frame) {}

  // Grey clay: ambient 0.15, the rest from the cosine and the visibility.
  Image<Color> shaded(const auto& visibility) const {
    return paint([&](size_t i) {
      if (!v_.truth.facing[i]) return facing_away;
      const float value = visibility(i);
      return std::isnan(value) ? color_.background : grey(0.15 + 0.75 * cosine(i) * value);
    });
  }

  // Each wrong pixel in the colour of its class, by the size of its error, over the grey of right ones.
  Image<Color> classes() const {
    return named([&](size_t i) {
      for (const FrameClassRow& row : frame_classes)
        if (row.what == v_.classes[i]) return std::optional(Color(row.color[0], row.color[1], row.color[2]));
      return std::optional<Color>();
    });
  }

  // The same by the cause of the ladder.
  Image<Color> causes(const Ladder& ladder) const {
    const std::vector<Color> colors = colors_of_causes(ladder);
    return named([&](size_t i) {
      return ladder.cause[i] == static_cast<uint8_t>(Cause::none) ? std::nullopt
                                                                  : std::optional(colors[ladder.cause[i]]);
    });
  }

  // Too dark in the colour of acne, too light in the colour of Peter Panning, grey where right.
  Image<Color> difference() const {
    const glm::vec3 dark(color_.too_dark), light(color_.too_light), right(color_.lit);
    return paint([&](size_t i) {
      if (!v_.counted[i]) return color_.attached;
      const bool too_dark = frame_.visibility[i] < v_.truth_at(i);
      return Color(glm::mix(right, too_dark ? dark : light, std::min(1.0f, v_.error[i])) + 0.5f);
    });
  }

 private:
  Image<Color> paint(const auto& color) const {
    Image<Color> picture(v_.error.width, v_.error.height, color_.background);
    for (size_t i = 0; i < picture.size(); ++i)
      if (v_.receivers.primitive[i] != no_primitive) picture[i] = color(i);
    return picture;
  }
  // color: of a wrong pixel; empty: it has none.
  Image<Color> named(const auto& color) const {
    return paint([&](size_t i) {
      if (!v_.truth.facing[i]) return color_.attached;
      if (!v_.counted[i]) return color_.ambiguous;
      const float shade = 0.72f + 0.28f * static_cast<float>(cosine(i));
      const glm::vec3 right = shade * glm::vec3(v_.truth.lit[i] ? color_.lit : color_.shadowed);
      const auto found = color(i);
      if (!found) return Color(right + 0.5f);
      return Color(glm::mix(right, glm::vec3(*found), 0.25f + 0.75f * std::min(1.0f, v_.error[i])) + 0.5f);
    });
  }
  double cosine(size_t i) const {
    const glm::dvec3 p = v_.receivers.position[i], normal = v_.receivers.normal[i];
    return std::max(0.0, glm::dot(normal, v_.light.direction_to_light(p)));
  }

  const FrameVerdict& v_;
  const GivenFrame& frame_;
  const PixelColors color_;
};

template <class T>
Channel channel(std::string name, const Image<T>& source, const auto& value) {
  Channel made{std::move(name), Image<float>(source.width, source.height)};
  for (size_t i = 0; i < source.size(); ++i) made.values[i] = static_cast<float>(value(source[i], i));
  return made;
}

}  // namespace

std::vector<PictureRecord> write_frame_pictures(const FrameVerdict& verdict, const GivenFrame& frame,
                                                const Ladder* ladder, const std::string& folder,
                                                const std::string& relative, const std::string& stem) {
  const FramePainter painter(verdict, frame);
  PictureFiles files(folder, relative, stem);
  files.add("truth", "The true shadow, by rays; what faces away from the light is blue.",
            [&] { return painter.shaded([&](size_t i) { return verdict.truth_at(i); }); });
  files.add("frame", "The frame's own visibility, shaded in the same way.",
            [&] { return painter.shaded([&](size_t i) { return frame.visibility[i]; }); });
  files.add("classes", "Why pixels differ, by their place; the colour's strength is the error's size.",
            [&] { return painter.classes(); });
  if (ladder)
    files.add("causes", "Why pixels differ, by the rungs of the frame's own map.",
              [&] { return painter.causes(*ladder); });
  files.add("difference", "Too dark in orange-red, too light in blue.", [&] { return painter.difference(); });
  return files.write();
}

std::vector<Image<Color>> frame_pixel_pictures(const FrameVerdict& verdict, const GivenFrame& frame,
                                               const Ladder* ladder, std::span<const PointRecord::WorstOf> pixels) {
  const FramePainter painter(verdict, frame);
  const std::array<Image<Color>, 3> pictures = {painter.shaded([&](size_t i) { return verdict.truth_at(i); }),
                                                painter.shaded([&](size_t i) { return frame.visibility[i]; }),
                                                ladder ? painter.causes(*ladder) : painter.classes()};
  std::vector<Image<Color>> made;
  for (const PointRecord::WorstOf& pixel : pixels) made.push_back(pixel_picture(pictures, pixel.x, pixel.y));
  return made;
}

ImageRecord write_frame_exr(const FrameVerdict& v, const GivenFrame& frame, const Ladder* ladder,
                            const std::string& path, const std::string& relative_path) {
  const auto same = [](auto value, size_t) { return value; };
  std::vector<Channel> channels{{"V", frame.visibility}};
  channels.push_back(channel("R1", v.truth.lit, same));
  channels.push_back({"R0", v.truth.soft});
  channels.push_back({"error", v.error});
  channels.push_back(channel("class", v.classes, [](FrameClass what, size_t) { return static_cast<int>(what); }));
  channels.push_back(channel("flags", v.truth.facing, [&](uint8_t facing, size_t i) {
    return facing + 2 * v.counted[i] + (facing ? 4 * v.truth.ambiguous[i] : 0);
  }));
  channels.push_back(channel("primitive", v.receivers.primitive,
                             [](uint32_t p, size_t) { return p == no_primitive ? -1.0 : static_cast<double>(p); }));
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = [axis](const glm::vec3& at, size_t) { return at[axis]; };
    channels.push_back(channel(fmt::format("P.{}", "XYZ"[axis]), v.receivers.position, along));
    channels.push_back(channel(fmt::format("N.{}", "XYZ"[axis]), v.receivers.normal, along));
  }
  if (ladder) {
    for (const Rung rung : {Rung::filtered, Rung::snapped, Rung::on_exact_map, Rung::shown})
      channels.push_back({std::string(rung_names[static_cast<size_t>(rung)]), (*ladder)[rung]});
    for (size_t c = 1; c < ladder->causes.size(); ++c)
      channels.push_back({"step." + ladder->causes[c].name, ladder->causes[c].step});
  }
  return {relative_path, write_exr(path, channels)};
}

}  // namespace noonmark
