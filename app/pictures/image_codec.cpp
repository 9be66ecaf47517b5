// The module noonmark_images (app/pictures/image_codec.h).
#include "app/pictures/image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace noonmark {
namespace {

// Thrown with the reason, as DecodeImage gives it.
struct Refused : std::runtime_error {
  using runtime_error::runtime_error;
};

// The name under which OpenImageIO knows the bytes: its ending selects the decoder.
std::string name_inside(const char* format) { return std::string("picture.") + format; }

// why: OpenImageIO's text, one line for each level of the libraries below it. Some of them name the file, but they know
// only the name inside.
Refused undecodable(const std::string& why, const char* format) {
  std::string line = why.substr(0, why.find('\n'));
  for (const std::string& name : {"image file \"" + name_inside(format) + "\"", "file \"" + name_inside(format) + "\"",
                                  "\"" + name_inside(format) + "\""})
    for (size_t at = line.find(name); at != line.npos; at = line.find(name)) line.replace(at, name.size(), "the file");
  while (line.ends_with('.') || line.ends_with(' ')) line.pop_back();
  return Refused("cannot be decoded: " + line + "; write it again");
}

// Integers are divided in double and rounded once: 85 of 255 is the float that is nearest to 1/3, as in the lookup.
template <class T>
std::vector<float> read_as(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const char* format,
                           OIIO::TypeDesc type, double whole) {
  std::vector<T> values(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height) *
                        static_cast<size_t>(spec.nchannels));
  if (!input.read_image(0, 0, 0, spec.nchannels, type, values.data())) throw undecodable(input.geterror(), format);
  std::vector<float> result(values.size());
  for (size_t i = 0; i < values.size(); ++i) result[i] = static_cast<float>(static_cast<double>(values[i]) / whole);
  return result;
}

// The file's pixels, and what DecodedPixels refers to.
struct Decoded {
  OIIO::ImageSpec spec;
  std::vector<float> values;
  StoredAs stored_as = StoredAs::float32;
};

Decoded decode(const ImageToDecode& file) {
  OIIO::Filesystem::IOMemReader bytes(const_cast<void*>(file.bytes), file.count);
  OIIO::Filesystem::IOProxy* const source = &bytes;
  OIIO::ImageSpec as_they_are;
  as_they_are.attribute("oiio:UnassociatedAlpha", 1);  // colours are not multiplied by alpha
  // OpenImageIO 2.4 forgets the bytes if there is a configuration that does not name them.
  as_they_are.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &source);
  const std::unique_ptr<OIIO::ImageInput> input =
      OIIO::ImageInput::open(name_inside(file.format), &as_they_are, &bytes);
  if (!input) throw undecodable(OIIO::geterror(), file.format);
  Decoded result;
  const OIIO::ImageSpec& spec = result.spec = input->spec();
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
      spec.height != spec.full_height)
    throw Refused("has a data window that is not its display window; write the whole picture");
  if (spec.deep || spec.depth > 1) throw Refused("has deep pixels; write a flat picture");
  // As stored and as floats, and the floats again where the program takes them over.
  const double values = static_cast<double>(spec.width) * spec.height * spec.nchannels;
  if (values * 3 * sizeof(float) > static_cast<double>(file.most_bytes)) throw Refused(too_large_to_decode);
  if (spec.format == OIIO::TypeDesc::UINT8) {
    result.stored_as = StoredAs::uint8;
    result.values = read_as<uint8_t>(*input, spec, file.format, OIIO::TypeDesc::UINT8, 255);
  } else if (spec.format == OIIO::TypeDesc::UINT16) {
    result.stored_as = StoredAs::uint16;
    result.values = read_as<uint16_t>(*input, spec, file.format, OIIO::TypeDesc::UINT16, 65535);
  } else {
    if (spec.format == OIIO::TypeDesc::HALF) result.stored_as = StoredAs::half;
    result.values = read_as<float>(*input, spec, file.format, OIIO::TypeDesc::FLOAT, 1);
  }
  return result;
}

}  // namespace
}  // namespace noonmark

extern "C" void noonmark_decode_image(const noonmark::ImageToDecode& file, void* context,
                                      void (*done)(void*, const noonmark::DecodedPixels*, const char*)) {
  noonmark::Decoded decoded;
  std::vector<const char*> names;
  std::string why;
  try {
    decoded = noonmark::decode(file);
    for (const std::string& name : decoded.spec.channelnames) names.push_back(name.c_str());
  } catch (const std::exception& thrown) {
    why = thrown.what();
    if (why.empty()) why = "cannot be decoded; write it again";
  }
  const noonmark::DecodedPixels pixels{decoded.spec.width,   decoded.spec.height,        decoded.spec.nchannels,
                                       names.data(),         decoded.spec.alpha_channel, decoded.stored_as,
                                       decoded.values.data()};
  done(context, why.empty() ? &pixels : nullptr, why.c_str());
}
