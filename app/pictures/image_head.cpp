#include "app/pictures/image_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "app/pictures/image_file.h"
#include "base/error.h"

namespace noonmark {
namespace {

// Bytes that one byte of a file is unpacked to, at most. Deflate: 258 bytes take at least two bits (RFC 1951, section 3.2).
constexpr double most_deflated = 1032;
// Run lengths of OpenEXR: 128 bytes from two.
constexpr double most_run = 64;
// PXR24 deflates three of a float's four bytes; what PIZ and B44 make is less.
constexpr double most_pxr24 = most_deflated * 4 / 3;
// DWA writes a block of 8 x 8 half floats without any frequency as one number of two bytes, and deflates these.
constexpr double most_dwa = 64 * most_deflated;

// The bytes of a file, read one after the other. What the file does not have is an error.
class Head {
 public:
  Head(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  [[noreturn]] void refuse(const std::string& why) const {
    throw Error(ErrorKind::file, fmt::format("{}: {}", path_, why));
  }
  std::string_view take(uint64_t count) {
    if (count > bytes_.size() - at_) refuse("cannot be decoded: its header is cut off; write it again");
    const std::string_view taken = bytes_.substr(at_, count);
    at_ += count;
    return taken;
  }
  template <class T>
  T number() {  // the program runs on little-endian machines only (Embree)
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  uint32_t big_endian() { return __builtin_bswap32(number<uint32_t>()); }
  std::string_view name() {
    const size_t end = bytes_.find('\0', at_);
    if (end == bytes_.npos) refuse("cannot be decoded: its header is cut off; write it again");
    const std::string_view text = take(end - at_);
    take(1);
    return text;
  }
  bool at_end() {  // of a list: a zero stands there
    if (bytes_.substr(at_, 1) != std::string_view("\0", 1)) return false;
    take(1);
    return true;
  }

  void require_pixels(int64_t width, int64_t height) const {
    if (width < 1 || height < 1 || static_cast<uint64_t>(width) > most_image_pixels ||
        static_cast<uint64_t>(height) > most_image_pixels / static_cast<uint64_t>(width))
      refuse(fmt::format("has {} x {} pixels; write at least one, and at most {}", width, height, most_image_pixels));
  }
  void require_unpacked(double unpacked, double most_of_a_byte) const {
    if (unpacked > most_of_a_byte * static_cast<double>(bytes_.size()))
      refuse(fmt::format("cannot be decoded: it has {} bytes, too few for its pixels; write it again", bytes_.size()));
  }

 private:
  const std::string& path_;
  std::string_view bytes_;
  size_t at_ = 0;
};

// PNG (third edition), section 11.2.1.
void check_png(Head& head) {
  head.take(16);  // signature, length and name of the first chunk
  const uint32_t width = head.big_endian(), height = head.big_endian();
  const auto depth = head.number<uint8_t>(), type = head.number<uint8_t>();
  head.require_pixels(width, height);
  const int samples = type == 2 ? 3 : type == 4 ? 2 : type == 6 ? 4 : 1;
  head.require_unpacked(static_cast<double>(width) * height * samples * depth / 8, most_deflated);
}

struct ExrPart {
  double pixels = 0, of_a_tile = 0, bytes_of_a_pixel = 0, most_of_a_byte = most_dwa;
};

// A list of channels: name, type (0: unsigned, 1: half, 2: float), flags, and of how many pixels it has one value.
double bytes_of_a_pixel(Head& list) {
  constexpr int most_channels = 64;
  double bytes = 0;
  for (int channels = 0; !list.at_end(); ++channels) {
    if (channels == most_channels)
      list.refuse(fmt::format("has more than {} channels; write those that are needed", most_channels));
    list.name();
    const auto type = list.number<int32_t>();
    list.take(4);
    const auto along_x = list.number<int32_t>(), along_y = list.number<int32_t>();
    if (along_x < 1 || along_y < 1) list.refuse("cannot be decoded: its header is damaged; write it again");
    bytes += (type == 1 ? 2.0 : 4.0) / along_x / along_y;
  }
  return bytes;
}

// Attributes: name, type, length, value.
ExrPart read_part(const std::string& path, Head& head) {
  ExrPart part;
  do {
    const std::string_view name = head.name();
    head.name();
    Head value(path, head.take(head.number<uint32_t>()));
    if (name == "dataWindow") {
      const int64_t left = value.number<int32_t>(), top = value.number<int32_t>(), right = value.number<int32_t>(),
                    bottom = value.number<int32_t>();
      value.require_pixels(right - left + 1, bottom - top + 1);
      part.pixels = static_cast<double>(right - left + 1) * static_cast<double>(bottom - top + 1);
    } else if (name == "tiles") {
      const double width = value.number<uint32_t>(), height = value.number<uint32_t>();
      part.of_a_tile = width * height;
    } else if (name == "compression") {
      const auto kind = value.number<uint8_t>();
      part.most_of_a_byte = kind == 0 ? 1 : kind == 1 ? most_run : kind >= 8 ? most_dwa : most_pxr24;
    } else if (name == "channels") {
      part.bytes_of_a_pixel = bytes_of_a_pixel(value);
    }
  } while (!head.at_end());
  // A decoder makes room for a whole tile, also where the picture ends within it.
  constexpr double usual_tile = 1024 * 1024;
  if (part.of_a_tile > std::max(part.pixels, usual_tile))
    head.refuse("has tiles that are larger than the picture; write it in rows");
  return part;
}

// The layout of OpenEXR files (openexr.com), "header".
void check_exr(const std::string& path, Head& head) {
  head.take(4);
  constexpr uint32_t several_parts = 0x1000;
  const bool several = (head.number<uint32_t>() & several_parts) != 0;
  do {
    const ExrPart part = read_part(path, head);
    head.require_unpacked(part.pixels * part.bytes_of_a_pixel, part.most_of_a_byte);
  } while (several && !head.at_end());
}

}  // namespace

void require_possible_head(const std::string& path, std::string_view format, std::string_view bytes) {
  Head head(path, bytes);
  if (format == "png")
    check_png(head);
  else
    check_exr(path, head);
}

}  // namespace noonmark
