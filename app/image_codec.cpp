// The module noonmark_images (app/image_codec.h).
#include "app/image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <stdexcept>
#include <string>

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
