// Writes pictures and images with OpenImageIO: PNG for people, 32-bit float EXR for programs. A file is written under
// another name beside its place and then renamed. Throws Error(file) if a file cannot be written, Error(device) if
// OpenImageIO cannot be loaded.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scenes/image.h"

namespace noonmark {

// Loads OpenImageIO; otherwise the first picture loads it. Throws Error(device) if that fails. A run that will write
// pictures calls this before it measures.
void require_image_files();

using Color = glm::u8vec3;  // sRGB

// Both return the digest of the file (digest_of, scenes/digest.h).
std::string write_png(const std::string& path, const Image<Color>& picture);

// One named channel of an EXR. Values are stored as 32-bit floats, row 0 on top.
struct Channel {
  std::string name;
  Image<float> values;
};
std::string write_exr(const std::string& path, const std::vector<Channel>& channels);

}  // namespace noonmark
