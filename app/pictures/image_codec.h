// The interface between the program and its module noonmark_images, which reads the pictures of other programs. Only this
// module needs OpenImageIO, whose 250 shared libraries take 0.4 s to load. app/pictures/image_file.cpp opens it before it
// reads the first picture. Both are built together, so this is not an interface for other programs.
#pragma once
#include <cstddef>
#include <cstdint>

namespace noonmark {

struct ImageToDecode {
  const char* format;  // "png" or "exr"
  const void* bytes;   // of the whole file
  size_t count;
  uint64_t most_bytes;  // that the pixels may take while they are decoded
};
inline constexpr const char* too_large_to_decode = "takes more memory to decode than there is";

// How the file stores its values. Others become floats.
enum class StoredAs { uint8, uint16, half, float32 };

struct DecodedPixels {
  int width, height;
  int channels;                      // interleaved
  const char* const* channel_names;  // as the file names them; a PNG's are "R", "G", "B", "A" or "Y"
  int alpha_channel;                 // -1: none
  StoredAs stored_as;
  const float* values;  // row 0 on top; integers become [0,1], without sRGB's transfer function
};

// Calls done once: with the pixels, or with null and the reason why there are none, as the end of a sentence that begins
// with the file's name. Throws nothing.
using DecodeImage = void(const ImageToDecode& file, void* context,
                         void (*done)(void* context, const DecodedPixels* pixels, const char* why));

inline constexpr const char* image_module_file = "noonmark_images.so";
inline constexpr const char* image_module_decoder = "noonmark_decode_image";  // a DecodeImage

}  // namespace noonmark
