// The input is the bytes of a picture. What is read before a decoder sees them, the head of a PNG or an EXR file or a whole NPY
// file, must be refused with Error(file) or be within the limits, without memory for what the head only says.

#include "app/pictures/image_file.h"
#include "app/pictures/image_head.h"
#include "app/pictures/npy.h"
#include "base/error.h"
#include "tests/fuzz/targets.h"

namespace noonmark::fuzz {
namespace {

void run(const std::string& bytes) {
  try {
    if (is_npy(bytes)) {
      const DecodedImage image = read_npy("picture", bytes, {});
      require(image.pixels() <= most_image_pixels && image.values.size() == image.pixels() * image.channels.size(),
              "a picture of another size than it says");
      require(image.values.size() <= bytes.size(), "more values than the file has bytes");
    } else {
      require_possible_head("picture", bytes.starts_with("\x89PNG") ? "png" : "exr", bytes);
    }
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::file && *error.what() != '\0', "an error of another kind");
  }
}

template <class T>
std::string little(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + little(static_cast<int32_t>(value.size())) + value;
}

std::vector<std::string> seeds() {
  const std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }";
  const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\2\0\0\0\3\x08\6\0\0\0", 29);
  const std::string box = little(int64_t{0}) + little(int32_t{1}) + little(int32_t{2}),
                    channel = std::string("Y\0", 2) + little(int32_t{1}) + little(int32_t{0}) + little(int32_t{1}) +
                              little(int32_t{1}) + '\0';
  const std::string part = attribute("channels", "chlist", channel) +
                           attribute("compression", "compression", std::string(1, '\3')) +
                           attribute("dataWindow", "box2i", box) +
                           attribute("tiles", "tiledesc", little(uint32_t{32}) + little(uint32_t{32}) + '\0') + '\0';
  const std::string magic = "\x76\x2f\x31\x01";
  return {"\x93NUMPY" + std::string("\1\0", 2) + little(static_cast<uint16_t>(header.size())) + header +
              std::string(24, '\0'),
          png, magic + little(uint32_t{2}) + part, magic + little(uint32_t{0x1002}) + part + part + '\0'};
}

std::vector<std::string> words() {
  return {"'descr':", "'shape':", "(2, 3)", "'<f8'",  "True",        "dataWindow",
          "tiles",    "channels", "box2i",  "chlist", "compression", std::string(4, '\xff')};
}

}  // namespace

const Target image_target = {"image", run, seeds, words, nullptr};

}  // namespace noonmark::fuzz
