// Writes pictures and images: PNG for people, 32-bit float EXR for programs. A file is written under another name beside
// its place and then renamed. Also reads grey pictures of other programs, with OpenImageIO. Throws Error(file) if a file
// cannot be written or read, Error(device) if OpenImageIO cannot be loaded. Files may be written from several threads at once.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/pictures/image_codec.h"
#include "base/image.h"

namespace noonmark {

// Loads OpenImageIO; otherwise the first picture that is read loads it. Throws Error(device) if that fails.
void require_image_reader();

using Color = glm::u8vec3;  // sRGB

// All of them return the digest of the file (digest_of, base/digest.h).
std::string write_png(const std::string& path, const Image<Color>& picture);

// An animated PNG (app/pictures/png_encoder.h). The frames are of one size.
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

// A picture that another program made.
struct DecodedImage {
  std::string path;  // as it was given
  int width = 0, height = 0;
  std::vector<std::string> channels;  // as the file names them
  std::optional<size_t> alpha;        // the channel that is alpha
  StoredAs stored_as = StoredAs::float32;
  std::vector<float>
      values;  // interleaved, row 0 on top, as they are (linear); the whole numbers of a PNG become [0,1]
  float at(size_t pixel, size_t channel) const { return values[pixel * channels.size() + channel]; }
  size_t pixels() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

// Throws Error(file) if the program cannot take so many bytes to read the picture.
void require_image_memory(const std::string& path, double bytes);

// Says whether a picture is wanted, before it is decoded: throws Error if it is not. The picture has no values yet.
using WantedImage = std::function<void(const DecodedImage& head)>;

// Asks whether the picture is wanted, and makes room for its values. Throws Error(file) if there is too little memory.
void make_room(DecodedImage& image, const WantedImage& wanted);

// Reads a PNG or an EXR file, or the array of a NPY file (app/pictures/npy.h). Throws Error(file) if the file is something
// else, has more than most_image_pixels pixels, or takes more memory than there is; and what `wanted` throws. All of this is
// known before pixels are decoded, so a file that is refused for it takes little more memory than its own size.
inline constexpr uint64_t most_image_pixels = uint64_t{1} << 28;
DecodedImage read_image(const std::string& path, const WantedImage& wanted = {});

// Throws Error(file) unless there is one channel beside alpha, or three.
void require_grey_channels(const DecodedImage& image);

// The values of the one channel beside alpha, or of three equal ones. Throws Error(file) if there are others.
std::vector<float> grey_values(const DecodedImage& image);

}  // namespace noonmark
