#include "app/pictures/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <stdexcept>
#include <utility>

#include "app/pictures/picture_files.h"
#include "app/pictures/point_files.h"
#include "app/pictures/view_colors.h"
#include "app/pictures/view_frustum.h"
#include "app/pictures/view_map.h"
#include "compare/report/cause_colors.h"
#include "compare/results/quantities.h"
#include "measure/texel_footprint.h"
#include "measure/view_shading.h"

namespace noonmark {
namespace {

// The receivers as grey clay under the light: ambient 0.15, the rest from the cosine and the visibility.
double clay(const Measurement& m, size_t i, double visibility) {
  return 0.15 + 0.75 * std::max(0.0f, m.map().probe.n_dot_l[i]) * visibility;
}

Image<Color> paint(const Measurement& m, const auto& facing_color) {
  Image<Color> picture(m.receivers.width(), m.receivers.height(), named_color("background"));
  for (size_t i = 0; i < picture.size(); ++i) {
    if (m.receivers.primitive[i] == no_primitive) continue;
    picture[i] = facing_color(i);
  }
  return picture;
}

Image<Color> shaded(const Measurement& m, const Image<float>& visibility) {
  return paint(m, [&](size_t i) {
    const bool facing = m.ladder.flags[i] & flag_facing;
    return grey(clay(m, i, facing ? visibility[i] : 0));
  });
}

// How strongly an error shows. A lookup that compares no depths is a little off nearly everywhere in a shadow: what is less than a
// step of a picture is fainter. The arguments of std::min have this order so that NaN gets the full strength.
float strength_of(float wrong, bool of_comparisons) {
  constexpr float faint = 1.0f / 64;
  return 0.25f * (of_comparisons ? 1.0f : std::min(1.0f, wrong / faint)) + 0.75f * std::min(1.0f, wrong);
}

// Each wrong pixel in the colour of its cause, over the grey of right pixels. The strength of the colour is the size of
// the error.
Image<Color> classes(const Measurement& m) {
  const PixelColors color;
  const std::vector<Color> of_cause = colors_of_causes(m.ladder);
  return paint(m, [&](size_t i) {
    if (!(m.ladder.flags[i] & flag_facing)) return color.attached;
    if (m.ladder.flags[i] & flag_ambiguous) return color.ambiguous;
    // A little shading makes the shapes visible.
    const float shade = 0.72f + 0.28f * m.map().probe.n_dot_l[i];
    const glm::vec3 right = shade * glm::vec3(m.ladder.truth()[i] != 0 ? color.lit : color.shadowed);
    if (m.ladder.cause[i] == static_cast<uint8_t>(Cause::none)) return Color(right + 0.5f);
    const float wrong = std::abs(m.ladder.shown()[i] - m.ladder.truth()[i]);
    return Color(
        glm::mix(right, glm::vec3(of_cause[m.ladder.cause[i]]), strength_of(wrong, m.ladder.of_comparisons())) + 0.5f);
  });
}

// Too dark in the colour of acne, too light in the colour of Peter Panning, grey where right.
Image<Color> difference(const Measurement& m) {
  const PixelColors color;
  const glm::vec3 dark(color.too_dark), light(color.too_light), right(color.lit);
  return paint(m, [&](size_t i) {
    if (!(m.ladder.flags[i] & flag_facing)) return color.attached;
    const float signed_error = m.ladder.shown()[i] - m.ladder.truth()[i];
    return Color(glm::mix(right, signed_error < 0 ? dark : light, std::min(1.0f, std::abs(signed_error))) + 0.5f);
  });
}

// Of cascades, near ones first: neighbours are apart for people with colour-vision deficiencies (Okabe and Ito 2008).
struct CascadeColor {
  const char* name;
  Color color;
};
constexpr CascadeColor cascade_colors[] = {
    {"vermilion", {213, 94, 0}}, {"sky blue", {86, 180, 233}}, {"yellow", {240, 228, 66}}, {"blue", {0, 114, 178}},
    {"orange", {230, 159, 0}},   {"green", {0, 158, 115}},     {"pink", {204, 121, 167}},  {"grey", {120, 120, 120}}};
static_assert(std::size(cascade_colors) == most_cascades);

// The truth in light greys, so that lines are visible on it.
Image<Color> frustum(const Measurement& m, const CameraFrame& camera) {
  Image<Color> picture = paint(m, [&](size_t i) {
    const bool facing = m.ladder.flags[i] & flag_facing;
    return grey(0.35 + 0.5 * clay(m, i, facing ? m.ladder.truth()[i] : 0));
  });
  if (m.maps.size() == 1)
    draw_frustum(picture, m.technique.frame, camera, m.receivers);
  else
    for (size_t k = 0; k < m.maps.size(); ++k)
      draw_frustum(picture, m.maps[k].technique.frame, camera, m.receivers, cascade_colors[k].color);
  return picture;
}

Image<Color> tinted(const Measurement& m) {
  return paint(m, [&](size_t i) {
    const bool facing = m.ladder.flags[i] & flag_facing;
    const glm::vec3 clay_there(grey(clay(m, i, facing ? m.ladder.shown()[i] : 0)));
    if (m.choice.of[i] >= m.maps.size()) return Color(clay_there);
    glm::vec3 tint(0);
    for (size_t k = 0; k < m.maps.size(); ++k)
      tint += static_cast<float>(m.choice.share(i, static_cast<int>(k))) * glm::vec3(cascade_colors[k].color) / 255.0f;
    return Color(glm::mix(clay_there, clay_there * tint, 0.75f) + 0.5f);
  });
}

// "vermilion to 5 m, sky blue to 15 m, yellow to 80 m"
std::string cascade_ranges(const Measurement& m) {
  std::string text;
  for (size_t k = 0; k < m.maps.size(); ++k)
    text += fmt::format("{}{} to {:.3g} m", k == 0 ? "" : ", ", cascade_colors[k].name, m.record.cascades[k].end_m);
  return text;
}

std::vector<StoredMap> stored_maps(const Measurement& m) {
  std::vector<StoredMap> maps;
  for (const MeasuredMap& map : m.maps) maps.push_back({map.stored_rows, map.technique.frame});
  return maps;
}

// What changes from this frame of a motion to the next although the truth does not. A pixel without flicker is grey, one
// that is not counted is dark.
Image<Color> changes(const Measurement& m) {
  const Flicker& flicker = *m.flicker;
  const PixelColors usual;
  return paint(m, [&](size_t i) {
    if (!flicker.points.counted[i]) return usual.attached;
    glm::vec3 color(0.72f * glm::vec3(flicker.now[i] > 0.5f ? usual.lit : usual.shadowed));
    const float change = std::abs(flicker.next[i] - flicker.now[i]);
    if (change == 0) return Color(color + 0.5f);
    glm::vec3 mixed(0);
    for (size_t c = 0; c < flicker_classes; ++c)
      mixed += flicker.parts[c][i] / change * glm::vec3(flicker_colors[c].r, flicker_colors[c].g, flicker_colors[c].b);
    return Color(glm::clamp(glm::mix(color, mixed, 0.4f + 0.6f * std::min(1.0f, change)), 0.0f, 255.0f));
  });
}

// Pictures of one size beside each other.
Image<Color> beside(std::initializer_list<Image<Color>> pictures) {
  const int width = pictures.begin()->width, height = pictures.begin()->height,
            count = static_cast<int>(pictures.size());
  Image<Color> row(count * width + (count - 1) * crop_gap, height, Color(255));
  int left = 0;
  for (const Image<Color>& picture : pictures) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) row.at(left + x, y) = picture.at(x, y);
    left += width + crop_gap;
  }
  return row;
}

// Each pixel of the result is the mean of `by` x `by` pixels; what is left over at the right and below is cut off.
Image<Color> reduced(const Image<Color>& picture, int by) {
  Image<Color> small(picture.width / by, picture.height / by);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      glm::ivec3 sum(by * by / 2);
      for (int v = 0; v < by; ++v)
        for (int u = 0; u < by; ++u) sum += glm::ivec3(picture.at(x * by + u, y * by + v));
      small.at(x, y) = Color(sum / (by * by));
    }
  return small;
}

// The map in the lower left corner, on a rectangle of a third of the picture's height, framed. Each pixel is the map's
// nearest one.
Image<Color> with_corner(Image<Color> picture, const Image<Color>& map) {
  const int height = std::max(1, picture.height / 3),
            width = std::clamp(height * map.width / std::max(1, map.height), 1, picture.width);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool edge = x == width - 1 || y == 0;
      picture.at(x, picture.height - height + y) =
          edge ? Color(255) : map.at(x * map.width / width, y * map.height / height);
    }
  return picture;
}

// Pictures of one list of names.
class ListedPictures : public PictureFiles {
 public:
  ListedPictures(const std::string& folder, const std::string& relative, const std::string& stem,
                 std::span<const std::string_view> names)
      : PictureFiles(folder, relative, stem), names_(names) {}

  // picture: a picture, or what paints it.
  template <class Picture>
  void add(const std::string& name, const std::string& caption, Picture&& picture) {
    if (std::find(names_.begin(), names_.end(), name) == names_.end())
      throw std::logic_error(name + " is not in the list of names");
    PictureFiles::add(name, caption, std::forward<Picture>(picture));
  }

 private:
  std::span<const std::string_view> names_;
};

// Copies the surroundings of (x, y) to `to`, from column `left` on, and frames the pixel.
void enlarge(const Image<Color>& from, int x, int y, Image<Color>& to, int left) {
  constexpr Color frame{255, 255, 255}, outer{0, 0, 0};
  constexpr int middle = crop_px / 2;
  for (int v = 0; v < crop_px * crop_scale; ++v)
    for (int u = 0; u < crop_px * crop_scale; ++u) {
      const int column = x + u / crop_scale - middle, row = y + v / crop_scale - middle;
      const bool inside = column >= 0 && row >= 0 && column < from.width && row < from.height;
      Color color = inside ? from.at(column, row) : Color(0);
      // Two lines around the pixel, white and black, so that they show on any colour.
      const int near = std::max(std::abs(2 * u + 1 - crop_px * crop_scale), std::abs(2 * v + 1 - crop_px * crop_scale));
      if (near > crop_scale && near <= crop_scale + 4) color = frame;
      if (near > crop_scale + 4 && near <= crop_scale + 8) color = outer;
      to.at(left + u, v) = color;
    }
}

}  // namespace

Image<Color> shown_picture(const Measurement& m) { return shaded(m, m.ladder.shown()); }

Image<Color> causes_picture(const Measurement& m) { return classes(m); }

Image<Color> pixel_picture(const Measurement& m, int x, int y) {
  return pixel_picture({shaded(m, m.ladder.truth()), shaded(m, m.ladder.shown()), classes(m)}, x, y);
}

Image<Color> pixel_picture(const std::array<Image<Color>, 3>& pictures, int x, int y) {
  constexpr int side = crop_px * crop_scale;
  Image<Color> picture(3 * side + 2 * crop_gap, side, Color(255));
  for (int i = 0; i < 3; ++i) enlarge(pictures[static_cast<size_t>(i)], x, y, picture, i * (side + crop_gap));
  return picture;
}

Image<Color> motion_frame(const Measurement& m) {
  constexpr int widest = 480;  // 24 frames of both pictures are then a few MB
  const int by = (m.receivers.width() + widest - 1) / widest;
  return beside({reduced(shaded(m, m.ladder.shown()), by), reduced(changes(m), by)});
}

Image<Color> lit_picture(const Measurement& m) {
  const CameraFrame camera = make_camera_frame(m.camera, m.receivers.width(), m.receivers.height());
  const Image<float> frame = shaded_frame(m.receivers, m.technique.frame, camera, m.ladder.truth());
  const Color ambiguous = named_color("ambiguous");
  return paint(m, [&](size_t i) {
    if (!(m.ladder.flags[i] & flag_facing)) return facing_away;
    return m.ladder.flags[i] & flag_ambiguous ? ambiguous : grey(frame[i]);
  });
}

std::vector<PictureRecord> write_pictures(const Measurement& m, const std::string& folder, const std::string& relative,
                                          const std::string& stem) {
  ListedPictures files(folder, relative, stem, picture_names);
  const Light light = effective_light(m.scene, m.technique.settings);
  const bool sized = m.technique.frame.light().disc_radius(light) > 0;
  const CameraFrame camera = make_camera_frame(m.camera, m.receivers.width(), m.receivers.height());
  const auto shaded_with = [&](const Image<float>& visibility) {
    return shaded_frame(m.receivers, m.technique.frame, camera, visibility);
  };
  files.add("truth", "The truth: one exact shadow ray for each pixel (R1).",
            [&] { return shaded(m, m.ladder.truth()); });
  if (sized)
    files.add("soft-truth", "The truth of the light with its size (R0).",
              [&] { return shaded(m, m.ladder.soft_truth()); });
  const std::string& judged = m.ladder.rungs.back().name;
  const bool given = !m.ladder.brought.empty();  // the judged picture is not the shadow map's
  files.add("map", fmt::format("What the {} showed ({}).", given ? "given picture" : "shadow map", judged),
            [&] { return shown_picture(m); });
  files.add("classes", "Why each wrong pixel is wrong.", [&] { return causes_picture(m); });
  files.add("difference",
            fmt::format("{} minus truth: too dark is orange, too light is blue.", given ? "Given picture" : "Map"),
            [&] { return difference(m); });
  if (m.flicker)
    files.add(
        "flicker",
        fmt::format("What the shadow map shows at the points of frame {0} (left), what that of frame {1} shows at the "
                    "same points of the world (middle), and what changed although the truth did not (right): the grid "
                    "moved (orange), depths were re-rounded (pink), the kernel turned (blue), "
                    "or the map's edge passed (green){2}.",
                    m.technique.settings.view.motion.frame, m.technique.settings.view.motion.frame + 1,
                    m.maps.size() > 1 ? ", or another cascade is looked up (yellow)" : ""),
        [&] {
          return beside({shaded(m, m.flicker->now), shaded(m, m.flicker->next), changes(m)});
        });
  files.add("depth",
            m.maps.size() > 1
                ? "The maps of the cascades as the light sees them, the nearest cascade on the left: bright is near in "
                  "metres, black is empty."
            : m.technique.frame.map_shape() == MapShape::cube
                ? "The cube map unfolded, as it looks from outside: bright is near in metres, black is empty."
                : "The shadow map itself as the light sees it: bright is near in metres, black is empty.",
            map_picture(stored_maps(m)));  // OpenGL's maps are read here
  if (m.maps.size() > 1)
    files.add("cascades",
              "The map's frame tinted by the cascade that each pixel is looked up in: " + cascade_ranges(m) + ".",
              [&] { return tinted(m); });

  files.add("frustum",
            m.maps.size() == 1 ? std::string(m.technique.frame.light().frustum_caption())
                               : "What the map of each cascade can see: " + cascade_ranges(m) +
                                     "; dashed where the scene is before it.",
            [&] { return frustum(m, camera); });
  const Image<float> truth = shaded_with(m.ladder.truth()), map = shaded_with(m.ladder.shown());
  files.add("shaded-truth", "Grey clay as a renderer shows it (Blinn-Phong), with the true shadow (R1).",
            [&] { return shown_frame(m.receivers, truth); });
  if (sized)
    files.add("shaded-soft-truth", "Grey clay with the true shadow of the light with its size (R0).",
              [&] { return shown_frame(m.receivers, shaded_with(m.ladder.soft_truth())); });
  files.add("shaded-map",
            fmt::format("Grey clay as a renderer shows it, with the {} shadow ({}).",
                        given ? "given picture's" : "map's", judged),
            [&] { return shown_frame(m.receivers, map); });
  const double rmse = shaded_rmse(m.receivers, m.technique.frame, camera, m.ladder.truth(), m.ladder.shown());
  files.add(
      "shaded-difference",
      fmt::format("The absolute difference of the two shaded pictures in linear light, from dark (0) to bright (1). "
                  "Its root mean square over the receivers is {}.",
                  std::isnan(rmse) ? std::string(not_measured) : fmt::format("{:.4g}", rmse)),
      [&] {
        Image<Color> apart(map.width, map.height);
        for (size_t i = 0; i < apart.size(); ++i)
          apart[i] = difference_color(std::abs(static_cast<double>(map[i]) - truth[i]));
        return apart;
      });
  return files.write();
}

namespace {

// From blue, an eighth of a pixel and less, over light grey, one pixel, to red, eight pixels and more. Each factor of two is
// a third of the way. NaN, where nothing faces the light, has the colour of that.
Color texel_color(float pixels) {
  if (std::isnan(pixels)) return named_color("attached");
  const glm::vec3 small(40, 90, 200), one(225, 225, 220), large(200, 40, 30);
  const float way = std::clamp(std::log2(std::max(pixels, 0x1p-20f)) / 3, -1.0f, 1.0f);
  return Color((way < 0 ? glm::mix(one, small, -way) : glm::mix(one, large, way)) + 0.5f);
}

}  // namespace

std::vector<PictureRecord> write_debug_pictures(const Measurement& m, const std::string& folder,
                                                const std::string& relative, const std::string& stem) {
  ListedPictures files(folder, relative, stem, debug_picture_names);
  const CameraFrame camera = make_camera_frame(m.camera, m.receivers.width(), m.receivers.height());
  files.add("debug-unshadowed", "The frame without shadows: as if every receiver that faces the light were lit.", [&] {
    Image<float> all_lit(m.receivers.width(), m.receivers.height());
    for (size_t i = 0; i < all_lit.size(); ++i) all_lit[i] = m.ladder.flags[i] & flag_facing ? 1.0f : 0.0f;
    return shown_frame(m.receivers, shaded_frame(m.receivers, m.technique.frame, camera, all_lit));
  });
  // OpenGL's map is read here.
  const Image<Color> stored = stored_picture(stored_maps(m));
  const Image<float> read = stored_depths(m);
  files.add("debug-stored", "The shadow map as it is stored: the grey is the window depth, black is 0 and white is 1.",
            [&] { return stored; });
  files.add("debug-painted",
            "The depth that each receiver's lookup reads, painted on the scene with the same grey: the map's texels as "
            "they lie on the surfaces.",
            [&] { return paint(m, [&](size_t i) { return stored_grey(static_cast<double>(read[i])); }); });
  files.add("debug-corner", "The frame as the shadow map shows it, with the stored map in the corner.", [&] {
    return with_corner(shown_frame(m.receivers, shaded_frame(m.receivers, m.technique.frame, camera, m.ladder.shown())),
                       stored);
  });
  files.add("debug-texels",
            "How long a texel of the shadow map is in the picture, in pixels: blue is an eighth and less, light grey "
            "is one, red is eight and more, where the stairs of shadow edges show.",
            [&] {
              Image<uint8_t> facing(m.receivers.width(), m.receivers.height());
              for (size_t i = 0; i < facing.size(); ++i) facing[i] = (m.ladder.flags[i] & flag_facing) != 0;
              std::vector<const LightFrame*> frames;
              for (const MeasuredMap& map : m.maps) frames.push_back(&map.technique.frame);
              const TexelFootprint footprint = texel_footprint(m.receivers, camera, frames, m.choice, facing);
              return paint(m, [&](size_t i) { return texel_color(footprint.pixels[i]); });
            });
  return files.write();
}

}  // namespace noonmark
