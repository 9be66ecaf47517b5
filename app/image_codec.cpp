// The module noonmark_images (app/image_codec.h).
#include "app/image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace noonmark {
namespace {

// Encodes into memory, because OpenImageIO 2.4 does not notice a full disk and leaves incomplete files.
void encode(const ImageToEncode& image, OIIO::Filesystem::IOVecOutput& bytes) {
  const OIIO::TypeDesc type = image.channel_names ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8;
  OIIO::ImageSpec spec(image.width, image.height, image.channels, type);
  if (image.channel_names) {
    spec.attribute("compression", "zip");
    spec.channelnames.assign(image.channel_names, image.channel_names + image.channels);
  } else {
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("png:compressionLevel", 6);
  }
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(image.path, &bytes);
  if (!output) throw std::runtime_error(OIIO::geterror());
  if (!output->open(image.path, spec) || !output->write_image(type, image.pixels) || !output->close())
    throw std::runtime_error(output->geterror());
}

// Thrown with the reason, as DecodeGrey gives it.
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

std::string text_of(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

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

std::vector<float> decode(const GreyToDecode& file) {
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
  if (spec.width != file.width || spec.height != file.height)
    throw Refused("has " + text_of(spec.width, spec.height) + " pixels, but the point's picture has " +
                  text_of(file.width, file.height) +
                  "; write it in that size, or set view.width_px and view.height_px to its size");
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
      spec.height != spec.full_height)
    throw Refused("has a data window that is not its display window; write the whole picture");
  const int channels = spec.nchannels;
  const bool has_alpha = channels > 1 && spec.alpha_channel == channels - 1;
  const int colours = has_alpha ? channels - 1 : channels;
  if (spec.deep || spec.depth > 1 || (colours != 1 && colours != 3))
    throw Refused("has " + std::to_string(channels) + (spec.deep ? " deep" : "") +
                  " channels; write visibility as one grey channel (or three equal ones)");
  const std::vector<float> values = spec.format == OIIO::TypeDesc::UINT8
                                        ? read_as<uint8_t>(*input, spec, file.format, OIIO::TypeDesc::UINT8, 255)
                                    : spec.format == OIIO::TypeDesc::UINT16
                                        ? read_as<uint16_t>(*input, spec, file.format, OIIO::TypeDesc::UINT16, 65535)
                                        : read_as<float>(*input, spec, file.format, OIIO::TypeDesc::FLOAT, 1);
  if (channels == 1) return values;
  std::vector<float> grey(values.size() / static_cast<size_t>(channels));
  for (size_t i = 0; i < grey.size(); ++i) {
    const float* const rgb = &values[i * static_cast<size_t>(channels)];
    if (has_alpha && rgb[colours] != 1)
      throw Refused("has an alpha channel that is not 1 everywhere; remove the alpha channel");
    const bool equal =
        colours == 1 || (rgb[0] == rgb[1] && rgb[0] == rgb[2]) || (rgb[0] != rgb[0] && rgb[1] != rgb[1]);  // both NaN
    if (!equal) throw Refused("has colours; write visibility as one grey channel (or three equal ones)");
    grey[i] = rgb[0];
  }
  return grey;
}

}  // namespace
}  // namespace noonmark

extern "C" void noonmark_encode_image(const noonmark::ImageToEncode& image, void* context,
                                      void (*done)(void*, bool, const char*, size_t)) {
  OIIO::Filesystem::IOVecOutput bytes;  // outlives the output that writes to it
  std::string error;
  try {
    noonmark::encode(image, bytes);
  } catch (const std::exception& thrown) {
    error = thrown.what();
    if (error.empty()) error = "OpenImageIO gives no reason";
  }
  if (error.empty())
    done(context, true, reinterpret_cast<const char*>(bytes.buffer().data()), bytes.buffer().size());
  else
    done(context, false, error.data(), error.size());
}

extern "C" void noonmark_decode_grey(const noonmark::GreyToDecode& file, void* context,
                                     void (*done)(void*, const float*, const char*)) {
  std::vector<float> pixels;
  std::string why;
  try {
    pixels = noonmark::decode(file);
  } catch (const std::exception& thrown) {
    why = thrown.what();
    if (why.empty()) why = "cannot be decoded; write it again";
  }
  done(context, why.empty() ? pixels.data() : nullptr, why.c_str());
}
