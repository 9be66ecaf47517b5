#include "app/pictures/npy.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "base/error.h"

namespace noonmark {
namespace {

constexpr std::string_view magic = "\x93NUMPY";

template <class T>
T little_endian(std::string_view bytes, size_t at) {  // the program runs on little-endian machines only (Embree)
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

// IEEE 754 binary16.
float half_value(uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const float size = exponent == 31
                         ? (fraction ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity())
                     : exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                     : std::ldexp(static_cast<float>(fraction + 1024), exponent - 25);
  return bits >> 15 ? -size : size;
}

// The header is the text of a dictionary in Python (numpy.lib.format), of which the value behind a key is read. Empty: the key,
// or what ends the value, is not there.
std::string_view value_of(std::string_view header, std::string_view key, char begins, char ends) {
  const size_t at = header.find(key);
  if (at == header.npos) return {};
  header.remove_prefix(at + key.size());
  header.remove_prefix(std::min(header.find_first_not_of(' '), header.size()));
  if (!header.starts_with(begins)) return {};
  const size_t end = header.find(ends, 1);
  return end == header.npos ? std::string_view() : header.substr(1, end - 1);
}

// "720, 1280, 3". Empty: something else stands there, or more than four numbers.
std::vector<uint64_t> sizes_in(std::string_view shape) {
  constexpr size_t most = 4;
  const auto skip = [&](const char* what) {
    shape.remove_prefix(std::min(shape.find_first_not_of(what), shape.size()));
  };
  std::vector<uint64_t> sizes;
  for (skip(" "); !shape.empty(); skip(", ")) {
    uint64_t size = 0;
    const auto [end, wrong] = std::from_chars(shape.data(), shape.data() + shape.size(), size);
    if (wrong != std::errc{} || sizes.size() == most) return {};
    sizes.push_back(size);
    shape.remove_prefix(static_cast<size_t>(end - shape.data()));
    skip(" ");
    if (!shape.empty() && shape.front() != ',') return {};
  }
  return sizes;
}

}  // namespace

bool is_npy(std::string_view bytes) { return bytes.starts_with(magic); }

DecodedImage read_npy(const std::string& path, std::string_view bytes, const WantedImage& wanted) {
  const auto refuse = [&](const std::string& why) { throw Error(ErrorKind::file, fmt::format("{}: {}", path, why)); };
  const size_t length_bytes = bytes.size() > 6 && bytes[6] == 1 ? 2 : 4;
  if (bytes.size() < 8 + length_bytes) refuse("is an NPY file without a header; write it again");
  const size_t header_size = length_bytes == 2 ? little_endian<uint16_t>(bytes, 8) : little_endian<uint32_t>(bytes, 8);
  const size_t begin = 8 + length_bytes + header_size;
  constexpr size_t most_header_bytes = 65536;  // NumPy's own have some hundred
  if (begin > bytes.size()) refuse("is an NPY file whose header is cut off; write it again");
  if (header_size > most_header_bytes)
    refuse(fmt::format(
        "is an NPY file with a header of {} bytes, and {} are read; write it again, as one array without fields",
        header_size, most_header_bytes));
  const std::string_view header = bytes.substr(8 + length_bytes, header_size);
  const std::string_view type = value_of(header, "'descr':", '\'', '\''),
                         shape = value_of(header, "'shape':", '(', ')');
  const bool turned = value_of(header, "'fortran_order':", 'T', 'e') == "ru";
  if (type.empty() || shape.empty() || (!turned && value_of(header, "'fortran_order':", 'F', 'e') != "als"))
    refuse("is an NPY file with a header that has no type and shape");
  if (turned) refuse("is in Fortran's order; save numpy.ascontiguousarray(array)");
  std::vector<uint64_t> sizes = sizes_in(shape);
  if (sizes.size() == 2) sizes.push_back(1);
  if (sizes.size() != 3 || sizes[0] == 0 || sizes[1] == 0 || sizes[2] == 0 || sizes[2] > 64 ||
      sizes[0] > most_image_pixels || sizes[1] > most_image_pixels / sizes[0])
    refuse(fmt::format("has the shape ({}); write height x width, or height x width x channels, of at most {} pixels",
                       shape.substr(0, 60), most_image_pixels));
  DecodedImage image;
  image.path = path;
  image.height = static_cast<int>(sizes[0]);
  image.width = static_cast<int>(sizes[1]);
  for (uint64_t c = 0; c < sizes[2]; ++c) image.channels.push_back(std::to_string(c));
  const size_t count = image.pixels() * image.channels.size();
  const auto read = [&]<class T>(T, StoredAs stored_as, const auto& value) {
    if (bytes.size() - begin != count * sizeof(T))
      refuse(fmt::format("has {} bytes of data where its shape needs {}; write it again", bytes.size() - begin,
                         count * sizeof(T)));
    image.stored_as = stored_as;
    make_room(image, wanted);
    for (size_t i = 0; i < count; ++i) image.values[i] = value(little_endian<T>(bytes, begin + i * sizeof(T)));
  };
  if (type == "|u1")
    read(uint8_t{}, StoredAs::uint8, [](uint8_t v) { return static_cast<float>(v / 255.0); });
  else if (type == "<u2")
    read(uint16_t{}, StoredAs::uint16, [](uint16_t v) { return static_cast<float>(v / 65535.0); });
  else if (type == "<f2")
    read(uint16_t{}, StoredAs::half, half_value);
  else if (type == "<f4")
    read(float{}, StoredAs::float32, [](float v) { return v; });
  else if (type == "<f8")
    read(double{}, StoredAs::float32, [](double v) { return static_cast<float>(v); });
  else
    refuse(fmt::format("holds values of type '{}'; write uint8, uint16, float16, float32 or float64, little-endian",
                       type.substr(0, 60)));
  return image;
}

}  // namespace noonmark
