#include "app/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <stdexcept>

#include "scenes/error.h"
#include "scenes/file.h"

namespace noonmark {
namespace {

// Encoded in memory: OpenImageIO 2.4 does not notice when a disk fills up under it, and leaves files cut short.
void write(const std::string& path, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* pixels) {
  const auto fail = [&](const std::string& why) {
    throw Error(ErrorKind::scene, fmt::format("cannot write {}: {}", path, why));
  };
  OIIO::Filesystem::IOVecOutput bytes;  // outlives the output that writes to it
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path, &bytes);
  if (!output) fail(OIIO::geterror());
  if (!output->open(path, spec) || !output->write_image(type, pixels) || !output->close()) fail(output->geterror());
  write_file_atomically(path, {reinterpret_cast<const char*>(bytes.buffer().data()), bytes.buffer().size()});
}

}  // namespace

void write_png(const std::string& path, const Image<Color>& picture) {
  OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("png:compressionLevel", 6);
  write(path, spec, OIIO::TypeDesc::UINT8, picture.pixels.data());
}

void write_exr(const std::string& path, const std::vector<Channel>& channels) {
  const int width = channels.at(0).values.width, height = channels.at(0).values.height;
  const size_t count = channels.size();
  OIIO::ImageSpec spec(width, height, static_cast<int>(count), OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  spec.channelnames.clear();
  std::vector<float> pixels(static_cast<size_t>(width) * static_cast<size_t>(height) * count);
  for (size_t c = 0; c < count; ++c) {
    spec.channelnames.push_back(channels[c].name);
    if (channels[c].values.width != width || channels[c].values.height != height)
      throw std::logic_error("channels of one image differ in size");
    for (size_t i = 0; i < channels[c].values.size(); ++i) pixels[i * count + c] = channels[c].values[i];
  }
  write(path, spec, OIIO::TypeDesc::FLOAT, pixels.data());
}

}  // namespace noonmark
