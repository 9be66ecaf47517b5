// The interface between the program and its module noonmark_images, which reads the pictures of other programs. Only this
// module needs OpenImageIO, whose 250 shared libraries take 0.4 s to load. app/pictures/image_file.cpp opens it before it
// reads the first picture. Both are built together, so this is not an interface for other programs.
#pragma once
#include <cstddef>
#include <cstdint>

namespace noonmark {

// How the file stores its values. Others become floats.
enum class StoredAs { uint8, uint16, half, float32 };

// What the file says of itself.
struct ImageHead {
  int width, height;
  int channels;                      // interleaved
  const char* const* channel_names;  // as the file names them; a PNG's are "R", "G", "B", "A" or "Y"
  int alpha_channel;                 // -1: none
  StoredAs stored_as;
};

struct ImageToDecode {
  const char* format;  // "png" or "exr"
  const void* bytes;   // of the whole file
  size_t count;
  void* context;
  // Called once, before any pixel is decoded. Returns the place for all values: row 0 on top, integers become [0,1] without
  // sRGB's transfer function. Null: the picture is not wanted, and nothing is decoded.
  float* (*place_for)(void* context, const ImageHead& head);
  // Called if there are no values, with the reason as the end of a sentence that begins with the file's name.
  void (*refused)(void* context, const char* why);
};

using DecodeImage = void(const ImageToDecode& file);  // throws nothing

inline constexpr const char* image_module_file = "noonmark_images.so";
inline constexpr const char* image_module_decoder = "noonmark_decode_image";  // a DecodeImage

}  // namespace noonmark
