#include "app/pictures/npy.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <regex>
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

}  // namespace

bool is_npy(std::string_view bytes) { return bytes.starts_with(magic); }

DecodedImage read_npy(const std::string& path, std::string_view bytes) {
  const auto refuse = [&](const std::string& why) { throw Error(ErrorKind::file, fmt::format("{}: {}", path, why)); };
  const size_t length_bytes = bytes.size() > 6 && bytes[6] == 1 ? 2 : 4;
  if (bytes.size() < 8 + length_bytes) refuse("is an NPY file without a header; write it again");
  const size_t header_size = length_bytes == 2 ? little_endian<uint16_t>(bytes, 8) : little_endian<uint32_t>(bytes, 8);
  const size_t begin = 8 + length_bytes + header_size;
  if (begin > bytes.size() || header_size > 65536) refuse("is an NPY file whose header is cut off; write it again");
  const std::string header(bytes.substr(8 + length_bytes, header_size));
  std::smatch found;
  const auto field = [&](const char* pattern) {
    if (!std::regex_search(header, found, std::regex(pattern)))
      refuse("is an NPY file with a header that has no type and shape");
    return found[1].str();
  };
  if (field("'fortran_order': *(True|False)") == "True")
    refuse("is in Fortran's order; save numpy.ascontiguousarray(array)");
  const std::string type = field("'descr': *'([^']*)'");
  const std::string shape = field("'shape': *\\(([0-9, ]*)\\)");
  std::vector<uint64_t> sizes;
  const std::regex number("[0-9]{1,9}");
  for (std::sregex_iterator i(shape.begin(), shape.end(), number); i != std::sregex_iterator(); ++i)
    sizes.push_back(std::stoull(i->str()));
  if (sizes.size() == 2) sizes.push_back(1);
  if (sizes.size() != 3 || sizes[0] == 0 || sizes[1] == 0 || sizes[2] == 0 || sizes[2] > 64 ||
      sizes[0] * sizes[1] > most_image_pixels)
    refuse(fmt::format("has the shape ({}); write height x width, or height x width x channels", shape));
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
    require_image_memory(path, static_cast<double>(count) * sizeof(float));
    image.values.resize(count);
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
                       type));
  return image;
}

}  // namespace noonmark
