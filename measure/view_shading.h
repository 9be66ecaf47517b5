// Shades the receivers as lit grey clay, so that people can judge the shadow in it. The model is Blinn-Phong (Blinn
// 1977), as in the usual shadow-mapping tutorials,
//
//  colour = ambient + visibility * (diffuse + specular),
//  ambient = 0.15 albedo, diffuse = albedo max(N.L, 0), specular = strength max(N.H, 0)^64,
//
// in linear light. With albedo 0.7 and strength 0.195 the largest value is 1, so nothing is cut off.
#pragma once
#include "base/image.h"
#include "scenes/camera_frame.h"
#include "scenes/receivers.h"
#include "technique/light_frame.h"

namespace noonmark {

struct Clay {
  static constexpr double albedo = 0.7;
  static constexpr double ambient = 0.15;
  static constexpr double specular_strength = 0.195;
  static constexpr int specular_exponent = 64;
};

// The light that an unshadowed receiver reflects to the eye: diffuse + specular. L and the direction to the eye are
// unit vectors away from the surface, N is a unit vector. 0 if N.L <= 0.
double clay_response(glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_eye);

// visibility: a rung of the ladder, 0 where the receiver is not facing. Pixels without a surface are 0.
Image<float> shaded_frame(const ReceiverImage& receivers, const LightFrame& light, const CameraFrame& camera,
                          const Image<float>& visibility);

// Root mean square difference of two such frames over the receivers: the metric shaded_rmse. NaN without receivers, and
// if a visibility is NaN.
double shaded_rmse(const ReceiverImage& receivers, const LightFrame& light, const CameraFrame& camera,
                   const Image<float>& visibility, const Image<float>& other);

// The frame as pictures show it: 8-bit sRGB, and background_srgb where there is no surface. NaN is black.
Image<glm::u8vec3> shown_frame(const ReceiverImage& receivers, const Image<float>& frame);

// The mean FLIP of two such frames as they are shown (compare/ladder/flip.h): the metric flip. NaN without receivers, and
// if a visibility at a receiver is NaN.
double shaded_flip(const ReceiverImage& receivers, const LightFrame& light, const CameraFrame& camera,
                   const Image<float>& visibility, const Image<float>& other);

}  // namespace noonmark
