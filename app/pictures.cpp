#include "app/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "compare/cause_colors.h"
#include "scenes/map_address.h"

namespace noonmark {
namespace {

Color named_color(std::string_view name) {
  const CauseColor* color = find_color(name);
  if (!color) throw std::logic_error("no colour for " + std::string(name));
  return {color->r, color->g, color->b};
}

// The sRGB transfer function (IEC 61966-2-1), so that linear shading looks linear.
uint8_t encoded(double linear) {
  const double v = linear > 0 ? std::min(linear, 1.0) : 0;  // NaN is black
  return static_cast<uint8_t>(std::lround(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055)));
}

// The receivers as a grey clay under the light: ambient 0.15, the rest by the cosine and the visibility.
double clay(const Measurement& m, size_t i, double visibility) {
  return 0.15 + 0.75 * std::max(0.0f, m.probe.n_dot_l[i]) * visibility;
}

Image<Color> paint(const Measurement& m, const std::function<Color(size_t)>& facing_color) {
  Image<Color> picture(m.receivers.width(), m.receivers.height(), named_color("background"));
  for (size_t i = 0; i < picture.size(); ++i) {
    if (m.receivers.primitive[i] == no_primitive) continue;
    picture[i] = facing_color(i);
  }
  return picture;
}

Image<Color> shaded(const Measurement& m, int rung) {
  return paint(m, [&](size_t i) {
    const bool facing = m.ladder.flags[i] & flag_facing;
    return Color(encoded(clay(m, i, facing ? m.ladder.rung[static_cast<size_t>(rung)][i] : 0)));
  });
}

// Each wrong pixel in the colour of its cause, as strong as it is wrong (std::min in this order: NaN as wrong as can
// be), over what is right.
Image<Color> classes(const Measurement& m) {
  return paint(m, [&](size_t i) {
    if (!(m.ladder.flags[i] & flag_facing)) return named_color("attached");
    if (m.ladder.flags[i] & flag_ambiguous) return named_color("ambiguous");
    // A little shading, so that the shapes can be told apart.
    const float shade = 0.72f + 0.28f * m.probe.n_dot_l[i];
    const glm::vec3 right = shade * glm::vec3(named_color(m.ladder.rung[1][i] != 0 ? "lit" : "shadowed"));
    const Cause cause = static_cast<Cause>(m.ladder.cause[i]);
    if (cause == Cause::none) return Color(right + 0.5f);
    const float wrong = std::abs(m.ladder.rung[5][i] - m.ladder.rung[1][i]);
    return Color(glm::mix(right, glm::vec3(named_color(cause_name(cause))), 0.25f + 0.75f * std::min(1.0f, wrong)) +
                 0.5f);
  });
}

// Too dark in the colour of acne's family, too light in Peter Panning's; grey where right.
Image<Color> difference(const Measurement& m) {
  const glm::vec3 dark(named_color("acne")), light(named_color("peter_panning")), right(named_color("lit"));
  return paint(m, [&](size_t i) {
    if (!(m.ladder.flags[i] & flag_facing)) return named_color("attached");
    const float signed_error = m.ladder.rung[5][i] - m.ladder.rung[1][i];
    return Color(glm::mix(right, signed_error < 0 ? dark : light, std::min(1.0f, std::abs(signed_error))) + 0.5f);
  });
}

// The map as a picture: near is bright, cleared texels black. Shrunk to at most 1024 on a side by keeping the nearest
// depth of each block; row 0 of the picture is the highest v.
Image<Color> map_picture(const Image<float>& depth) {
  const int block = (depth.width + 1023) / 1024, size = depth.width / std::max(block, 1);
  float least = 1, most = 0;
  for (float d : depth.pixels) {
    if (d >= 1) continue;
    least = std::min(least, d);
    most = std::max(most, d);
  }
  const float span = most > least ? most - least : 1;
  Image<Color> picture(size, size, named_color("background"));
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      float nearest = 1;
      for (int j = 0; j < block; ++j)
        for (int i = 0; i < block; ++i) nearest = std::min(nearest, depth.at(x * block + i, y * block + j));
      if (nearest < 1) picture.at(x, size - 1 - y) = Color(encoded(0.95 - 0.85 * (nearest - least) / span));
    }
  }
  return picture;
}

}  // namespace

std::vector<PictureRecord> write_pictures(const Measurement& m, const std::string& folder, const std::string& relative,
                                          const std::string& stem) {
  std::vector<PictureRecord> records;
  const auto add = [&](const std::string& name, const std::string& caption, const Image<Color>& picture) {
    const std::string file = fmt::format("{}-{}.png", stem, name);
    write_png(folder + "/" + file, picture);
    records.push_back({name, relative + "/" + file, caption});
  };
  const bool sized = effective_light(m.scene, m.settings).angular_diameter_deg > 0;
  add("truth", "The truth: one exact shadow ray for each pixel (R1).", shaded(m, 1));
  if (sized) add("soft-truth", "The truth of the light with its size (R0).", shaded(m, 0));
  add("map", "What the shadow map showed (R5).", shaded(m, 5));
  add("classes", "Why each wrong pixel is wrong.", classes(m));
  add("difference", "Map minus truth: too dark is orange, too light is blue.", difference(m));
  add("depth", "The shadow map itself as the light sees it: bright is near, black is empty.",
      map_picture(m.stored_map));
  return records;
}

}  // namespace noonmark
