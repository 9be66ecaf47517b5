// Pictures and images on disk, by OpenImageIO: PNG for people, 32-bit float EXR for programs. Written beside and
// renamed. Throws Error(scene) when a file cannot be written, Error(device) when OpenImageIO cannot be loaded.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scenes/image.h"

namespace noonmark {

// Loads OpenImageIO, which the first picture does otherwise. Throws Error(device) where that fails: a run that will
// write pictures asks before it measures.
void require_image_files();

using Color = glm::u8vec3;  // sRGB

// Both return the digest of the file (digest_of, scenes/digest.h).
std::string write_png(const std::string& path, const Image<Color>& picture);

// One named channel of an EXR; values are stored as 32-bit float, row 0 on top.
struct Channel {
  std::string name;
  Image<float> values;
};
std::string write_exr(const std::string& path, const std::vector<Channel>& channels);

}  // namespace noonmark
