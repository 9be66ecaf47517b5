#include "app/image_file.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <filesystem>

#include "scenes/error.h"

namespace noonmark {
namespace {

void write(const std::string& path, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* pixels) {
  // The format is chosen by the extension, so the file beside keeps it.
  const std::filesystem::path target(path);
  const std::string beside = (target.parent_path() / (".writing-" + target.filename().string())).string();
  const auto fail = [&](const std::string& why) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw Error(ErrorKind::scene, fmt::format("cannot write {}: {}; is the folder there, writable, and the disk not full?", path, why));
  };
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(beside);
  if (!output) fail(OIIO::geterror());
  if (!output->open(beside, spec) || !output->write_image(type, pixels) || !output->close()) fail(output->geterror());
  std::error_code error;
  std::filesystem::rename(beside, target, error);
  if (error) fail(error.message());
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
