#include "measure/view_shading.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/srgb.h"
#include "compare/ladder/flip.h"

namespace noonmark {

double clay_response(glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_eye) {
  const double cosine = glm::dot(normal, to_light);
  if (!(cosine > 0)) return 0;
  const glm::dvec3 sum = to_light + to_eye;
  const double length = glm::length(sum);  // 0 if the eye looks straight into the light from behind the surface
  const double highlight = length > 0 ? std::max(glm::dot(normal, sum) / length, 0.0) : 0;
  return Clay::albedo * cosine + Clay::specular_strength * std::pow(highlight, Clay::specular_exponent);
}

namespace {

const glm::u8vec3 shown_background(background_srgb[0], background_srgb[1], background_srgb[2]);

// Calls visit(i) for each pixel, from several threads.
void each_pixel(size_t pixels, const auto& visit) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, pixels, 8192), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) visit(i);
  });
}

double response(const ReceiverImage& receivers, const LightFrame& light, const CameraFrame& camera, size_t i) {
  const glm::dvec3 p(receivers.position[i]);
  const bool perspective = camera.camera.projection == Projection::perspective;
  const glm::dvec3 to_eye = perspective ? glm::normalize(camera.eye_m - p) : -camera.forward;
  return clay_response(glm::dvec3(receivers.normal[i]), light.direction_to_light(p), to_eye);
}

// The colour of a pixel with a surface.
float shaded(const ReceiverImage& receivers, const LightFrame& light, const CameraFrame& camera, float visibility,
             size_t i) {
  double color = Clay::ambient * Clay::albedo;
  if (visibility != 0)  // also for NaN
    color += static_cast<double>(visibility) * response(receivers, light, camera, i);
  return static_cast<float>(color);
}

}  // namespace

Image<float> shaded_frame(const ReceiverImage& receivers, const LightFrame& light, const CameraFrame& camera,
                          const Image<float>& visibility) {
  Image<float> frame(receivers.width(), receivers.height(), 0);
  each_pixel(frame.size(), [&](size_t i) {
    if (receivers.primitive[i] != no_primitive) frame[i] = shaded(receivers, light, camera, visibility[i], i);
  });
  return frame;
}

double shaded_rmse(const ReceiverImage& receivers, const LightFrame& light, const CameraFrame& camera,
                   const Image<float>& visibility, const Image<float>& other) {
  double sum = 0;  // in the pixels' order, so that it is the same on every machine
  size_t count = 0;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    if (receivers.primitive[i] == no_primitive) continue;
    ++count;
    if (visibility[i] == other[i]) continue;  // equal visibility gives equal colours; NaN is never equal
    const double d =
        (static_cast<double>(visibility[i]) - static_cast<double>(other[i])) * response(receivers, light, camera, i);
    sum += d * d;
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(sum / static_cast<double>(count));
}

Image<glm::u8vec3> shown_frame(const ReceiverImage& receivers, const Image<float>& frame) {
  Image<glm::u8vec3> shown(frame.width, frame.height, shown_background);
  each_pixel(shown.size(), [&](size_t i) {
    if (receivers.primitive[i] != no_primitive) shown[i] = glm::u8vec3(srgb_encoded(frame[i]));
  });
  return shown;
}

namespace {

// The pixels whose visibility differs between two pictures, by blocks of the picture.
struct Differing {
  static constexpr int side = 8;
  bool any = false, undefined = false;  // any: receivers; undefined: a visibility of one is NaN
  Image<uint8_t> blocks;

  Differing(const ReceiverImage& receivers, const Image<float>& one, const Image<float>& other)
      : blocks((one.width + side - 1) / side, (one.height + side - 1) / side) {
    struct Found {
      bool any = false, undefined = false;
    };
    const Found found = tbb::parallel_reduce(
        tbb::blocked_range<int>(0, blocks.height), Found(),
        [&](const tbb::blocked_range<int>& range, Found all) {
          for (int y = range.begin() * side; y < std::min(range.end() * side, one.height); ++y)
            for (int x = 0; x < one.width; ++x) {
              const size_t i = one.index(x, y);
              if (receivers.primitive[i] == no_primitive) continue;
              all.any = true;
              if (one[i] == other[i]) continue;  // neither is NaN
              all.undefined |= std::isnan(one[i]) || std::isnan(other[i]);
              blocks.at(x / side, y / side) = 1;
            }
          return all;
        },
        [](Found a, Found b) {
          return Found{a.any || b.any, a.undefined || b.undefined};
        });
    any = found.any, undefined = found.undefined;
  }

  // The blocks with a pixel that lies within `reach` of such a pixel.
  Image<uint8_t> within(int reach) const {
    const int steps = (reach + side - 1) / side;
    Image<uint8_t> near(blocks.width, blocks.height);
    for (int y = 0; y < blocks.height; ++y)
      for (int x = 0; x < blocks.width; ++x)
        if (blocks.at(x, y))
          for (int j = std::max(0, y - steps); j <= std::min(blocks.height - 1, y + steps); ++j)
            for (int i = std::max(0, x - steps); i <= std::min(blocks.width - 1, x + steps); ++i) near.at(i, j) = 1;
    return near;
  }
};

}  // namespace

double shaded_flip(const ReceiverImage& receivers, const LightFrame& light, const CameraFrame& camera,
                   const Image<float>& visibility, const Image<float>& other) {
  const Differing differing(receivers, visibility, other);
  if (!differing.any || differing.undefined) return std::numeric_limits<double>::quiet_NaN();
  // A pixel within reach of one that differs has an error, which depends on the colours within reach of it. Where neither is,
  // no colour is needed: both pictures have the same.
  const Image<uint8_t> needed = differing.within(2 * flip_reach());
  Image<glm::u8vec3> one(visibility.width, visibility.height), two = one;
  tbb::parallel_for(tbb::blocked_range<int>(0, needed.height, 2), [&](const tbb::blocked_range<int>& range) {
    for (int y = range.begin() * Differing::side; y < std::min(range.end() * Differing::side, one.height); ++y)
      for (int x = 0; x < one.width; ++x) {
        if (!needed.at(x / Differing::side, y / Differing::side)) continue;
        const size_t i = one.index(x, y);
        const auto shown = [&](const Image<float>& of) {
          if (receivers.primitive[i] == no_primitive) return shown_background;
          return glm::u8vec3(srgb_encoded(shaded(receivers, light, camera, of[i], i)));
        };
        one[i] = shown(visibility);
        two[i] = visibility[i] == other[i] ? one[i] : shown(other);
      }
  });
  return flip(one, two).mean;
}

}  // namespace noonmark
