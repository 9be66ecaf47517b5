// Writes pictures and images with OpenImageIO: PNG for people, 32-bit float EXR for programs. A file is written under
// another name beside its place and then renamed. Also reads grey pictures of other programs. Throws Error(file) if a
// file cannot be written or read, Error(device) if OpenImageIO cannot be loaded.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "base/image.h"

namespace noonmark {

// Loads OpenImageIO; otherwise the first picture loads it. Throws Error(device) if that fails. A run that will write
// pictures calls this before it measures.
void require_image_files();

using Color = glm::u8vec3;  // sRGB

// All of them return the digest of the file (digest_of, base/digest.h).
std::string write_png(const std::string& path, const Image<Color>& picture);

// An animated PNG (app/pictures/animated_png.h). The frames are of one size.
std::string write_animated_png(const std::string& path, const std::vector<Image<Color>>& frames, int frame_ms);

// One named channel of an EXR. Values are stored as 32-bit floats, row 0 on top.
struct Channel {
  std::string name;
  Image<float> values;
};
std::string write_exr(const std::string& path, const std::vector<Channel>& channels);

// The same of an image that is made row by row while it is written. rows(first, count, pixels) writes `count` rows from
// row `first` on to `pixels`, channels interleaved.
struct LargeImage {
  std::vector<std::string> channels;
  int width, height;
  std::function<void(int first, int count, float* pixels)> rows;
};
std::string write_exr(const std::string& path, const LargeImage& image);

// Reads a PNG or EXR file with one grey channel, or three equal ones, of this size. Row 0 is on top. Values are taken as
// they are (linear); the whole numbers of a PNG become [0,1]. Throws Error(file) if the file is something else.
Image<float> read_grey(const std::string& path, int width, int height);

}  // namespace noonmark
