#include "measure/view_shading.h"

#include <tbb/parallel_for.h>

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
  Image<glm::u8vec3> shown(frame.width, frame.height, {background_srgb[0], background_srgb[1], background_srgb[2]});
  each_pixel(shown.size(), [&](size_t i) {
    if (receivers.primitive[i] != no_primitive) shown[i] = glm::u8vec3(srgb_encoded(frame[i]));
  });
  return shown;
}

double shaded_flip(const ReceiverImage& receivers, const LightFrame& light, const CameraFrame& camera,
                   const Image<float>& visibility, const Image<float>& other) {
  bool any = false, differ = false;
  for (size_t i = 0; i < receivers.primitive.size(); ++i) {
    if (receivers.primitive[i] == no_primitive) continue;
    any = true;
    if (std::isnan(visibility[i]) || std::isnan(other[i])) return std::numeric_limits<double>::quiet_NaN();
    differ |= visibility[i] != other[i];
  }
  if (!any) return std::numeric_limits<double>::quiet_NaN();
  if (!differ) return 0;
  const Image<glm::u8vec3> one = shown_frame(receivers, shaded_frame(receivers, light, camera, visibility));
  Image<glm::u8vec3> two = one;  // equal visibility gives equal colours
  each_pixel(two.size(), [&](size_t i) {
    if (receivers.primitive[i] != no_primitive && visibility[i] != other[i])
      two[i] = glm::u8vec3(srgb_encoded(shaded(receivers, light, camera, other[i], i)));
  });
  return flip(one, two).mean;
}

}  // namespace noonmark
