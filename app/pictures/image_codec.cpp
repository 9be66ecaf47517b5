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

// Integers are divided in double and rounded once: 85 of 255 is the float that is nearest to 1/3, as in the lookup. A few rows
// at a time, so that no second copy of the picture is in memory; files with integers of such types have rows, not tiles.
template <class T>
void read_integers(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const char* format, OIIO::TypeDesc type,
                   double whole, float* values) {
  constexpr int rows = 64;
  const size_t of_a_row = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.nchannels);
  std::vector<T> some(of_a_row * static_cast<size_t>(std::min(rows, spec.height)));
  for (int first = 0; first < spec.height; first += rows) {
    const int end = std::min(first + rows, spec.height);
    if (!input.read_scanlines(0, 0, spec.y + first, spec.y + end, 0, 0, spec.nchannels, type, some.data()))
      throw undecodable(input.geterror(), format);
    for (size_t i = 0; i < of_a_row * static_cast<size_t>(end - first); ++i)
      *values++ = static_cast<float>(static_cast<double>(some[i]) / whole);
  }
}

StoredAs stored_as(const OIIO::ImageSpec& spec) {
  if (spec.tile_width == 0 && spec.format == OIIO::TypeDesc::UINT8) return StoredAs::uint8;
  if (spec.tile_width == 0 && spec.format == OIIO::TypeDesc::UINT16) return StoredAs::uint16;
  return spec.format == OIIO::TypeDesc::HALF ? StoredAs::half : StoredAs::float32;
}

void decode(const ImageToDecode& file) {
  OIIO::Filesystem::IOMemReader bytes(const_cast<void*>(file.bytes), file.count);
  OIIO::Filesystem::IOProxy* const source = &bytes;
  OIIO::ImageSpec as_they_are;
  as_they_are.attribute("oiio:UnassociatedAlpha", 1);  // colours are not multiplied by alpha
  // OpenImageIO 2.4 forgets the bytes if there is a configuration that does not name them.
  as_they_are.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &source);
  const std::unique_ptr<OIIO::ImageInput> input =
      OIIO::ImageInput::open(name_inside(file.format), &as_they_are, &bytes);
  if (!input) throw undecodable(OIIO::geterror(), file.format);
  const OIIO::ImageSpec spec = input->spec();
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
      spec.height != spec.full_height)
    throw Refused("has a data window that is not its display window; write the whole picture");
  if (spec.deep || spec.depth > 1) throw Refused("has deep pixels; write a flat picture");
  std::vector<const char*> names;
  for (const std::string& name : spec.channelnames) names.push_back(name.c_str());
  const StoredAs as = stored_as(spec);
  float* const values =
      file.place_for(file.context, {spec.width, spec.height, spec.nchannels, names.data(), spec.alpha_channel, as});
  if (!values) return;
  if (as == StoredAs::uint8)
    read_integers<uint8_t>(*input, spec, file.format, OIIO::TypeDesc::UINT8, 255, values);
  else if (as == StoredAs::uint16)
    read_integers<uint16_t>(*input, spec, file.format, OIIO::TypeDesc::UINT16, 65535, values);
  else if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values))
    throw undecodable(input->geterror(), file.format);
}

}  // namespace
}  // namespace noonmark

extern "C" void noonmark_decode_image(const noonmark::ImageToDecode& file) {
  try {
    noonmark::decode(file);
  } catch (const std::exception& thrown) {
    const std::string why = thrown.what();
    file.refused(file.context, why.empty() ? "cannot be decoded; write it again" : why.c_str());
  }
}
