#include "app/pictures/png_encoder.h"

#include <png.h>
#include <zlib.h>

#include <csetjmp>
#include <cstdint>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>

namespace noonmark {
namespace {

// Measured with the 14 pictures that `render` writes of cube-room (1280 x 720): all filters at level 6 take 520 ms, this
// takes 110 ms and twice the bytes (0.5 MB in all).
constexpr int compression_level = 3;
constexpr int row_filter = PNG_FILTER_UP;

// libpng reports an error by a long jump, which passes no destructor: what it needs lives here, outside of the function
// that is jumped out of.
struct Encoding {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string file, why;
  std::exception_ptr failure;  // of the memory for `file`

  Encoding() = default;
  ~Encoding() { png_destroy_write_struct(&png, &info); }
  Encoding(const Encoding&) = delete;
  Encoding& operator=(const Encoding&) = delete;
};

void take_bytes(png_structp png, png_bytep bytes, size_t count) {
  Encoding& to = *static_cast<Encoding*>(png_get_io_ptr(png));
  try {
    to.file.append(reinterpret_cast<const char*>(bytes), count);
  } catch (...) {
    to.failure = std::current_exception();
  }
  if (to.failure) png_error(png, "no memory");
}

void flush_nothing(png_structp) {}

[[noreturn]] void fail(png_structp png, png_const_charp why) {
  Encoding& to = *static_cast<Encoding*>(png_get_error_ptr(png));
  try {
    to.why = why;
  } catch (...) {
    to.failure = std::current_exception();
  }
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

// False if libpng jumped out. No object here has a destructor.
bool encode(Encoding& to, const Image<Color>& picture) {
  if (setjmp(png_jmpbuf(to.png))) return false;
  png_set_write_fn(to.png, &to, take_bytes, flush_nothing);
  png_set_IHDR(to.png, to.info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(to.png, to.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_level(to.png, compression_level);
  png_set_filter(to.png, PNG_FILTER_TYPE_BASE, row_filter);
  png_write_info(to.png, to.info);
  for (int y = 0; y < picture.height; ++y) png_write_row(to.png, reinterpret_cast<png_const_bytep>(&picture.at(0, y)));
  png_write_end(to.png, to.info);
  return true;
}

}  // namespace

std::string encoded_png(const Image<Color>& picture) {
  static_assert(sizeof(Color) == 3, "rows of pixels are rows of bytes");
  Encoding to;
  to.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &to, fail, ignore);
  to.info = to.png ? png_create_info_struct(to.png) : nullptr;
  if (!to.info) throw std::bad_alloc();
  if (encode(to, picture)) return std::move(to.file);
  if (to.failure) std::rethrow_exception(to.failure);
  throw std::runtime_error(to.why);
}

namespace {

constexpr size_t signature_bytes = 8;

std::string big_endian(uint32_t value, int bytes) {
  std::string text;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xff);
  return text;
}

struct Chunk {
  std::string_view type, data;
};

// type: 4 letters.
std::string chunk(std::string_view type, const std::string& data) {
  const std::string checked = std::string(type) + data;
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return big_endian(static_cast<uint32_t>(data.size()), 4) + checked + big_endian(static_cast<uint32_t>(crc), 4);
}

// The chunks of a whole PNG file, which was just encoded.
std::vector<Chunk> chunks_of(std::string_view png) {
  constexpr size_t head = 8, check = 4;  // length and type; the CRC
  std::vector<Chunk> chunks;
  for (size_t at = signature_bytes; at < png.size();) {
    if (png.size() - at < head + check) throw std::invalid_argument("a frame is no whole PNG file");
    size_t length = 0;
    for (size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<uint8_t>(png[at + i]);
    if (length > png.size() - at - head - check) throw std::invalid_argument("a frame is no whole PNG file");
    chunks.push_back({png.substr(at + 4, 4), png.substr(at + head, length)});
    at += head + length + check;
  }
  if (chunks.empty() || chunks.front().type != "IHDR") throw std::invalid_argument("a frame is no PNG file");
  return chunks;
}

}  // namespace

std::string animated_png(const std::vector<std::string>& frames, int frame_ms) {
  if (frames.empty() || frame_ms < 1 || frame_ms > 65535) throw std::invalid_argument("no frames, or no time for each");
  const std::vector<Chunk> first = chunks_of(frames.front());
  const std::string_view header = first.front().data;
  std::string out = frames.front().substr(0, signature_bytes) + chunk("IHDR", std::string(header)) +
                    chunk("acTL", big_endian(static_cast<uint32_t>(frames.size()), 4) + big_endian(0, 4));
  for (size_t i = 1; i < first.size() && first[i].type != "IDAT"; ++i)
    out += chunk(first[i].type, std::string(first[i].data));
  uint32_t number = 0;  // of the chunks that an animation adds to each frame
  for (size_t f = 0; f < frames.size(); ++f) {
    const std::vector<Chunk> chunks = f == 0 ? first : chunks_of(frames[f]);
    if (chunks.front().data != header) throw std::invalid_argument("the frames differ in size or in colour type");
    // sequence_number, width and height, x_offset, y_offset, delay_num, delay_den, dispose_op (none) and blend_op
    // (source).
    out +=
        chunk("fcTL", big_endian(number++, 4) + std::string(header.substr(0, 8)) + big_endian(0, 4) + big_endian(0, 4) +
                          big_endian(static_cast<uint32_t>(frame_ms), 2) + big_endian(1000, 2) + big_endian(0, 2));
    for (const Chunk& each : chunks)
      if (each.type == "IDAT")
        out += f == 0 ? chunk("IDAT", std::string(each.data))
                      : chunk("fdAT", big_endian(number++, 4) + std::string(each.data));
  }
  return out + chunk("IEND", "");
}

}  // namespace noonmark
