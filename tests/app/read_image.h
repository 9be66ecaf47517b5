// Reads image files with OpenImageIO, as another program would, and lists folders, for tests.
#pragma once
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/pictures/image_file.h"

namespace noonmark {

struct ReadImage {
  OIIO::ImageSpec spec;
  std::map<std::string, std::vector<float>> channels;
};

inline ReadImage read_exr(const std::string& path) {
  const auto input = OIIO::ImageInput::open(path);
  if (!input) throw std::runtime_error(OIIO::geterror());
  ReadImage image{input->spec(), {}};
  const size_t count = static_cast<size_t>(image.spec.nchannels), size = image.spec.image_pixels();
  std::vector<float> pixels(size * count);
  if (!input->read_image(0, 0, 0, image.spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()))
    throw std::runtime_error(input->geterror());
  for (size_t c = 0; c < count; ++c) {
    std::vector<float>& channel = image.channels[image.spec.channelnames[c]];
    for (size_t i = 0; i < size; ++i) channel.push_back(pixels[i * count + c]);
  }
  return image;
}

inline Image<Color> read_png(const std::string& path) {
  const auto input = OIIO::ImageInput::open(path);
  if (!input) throw std::runtime_error(OIIO::geterror());
  EXPECT_EQ(input->spec().nchannels, 3);
  EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT8);
  Image<Color> picture(input->spec().width, input->spec().height);
  if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, picture.pixels.data()))
    throw std::runtime_error(input->geterror());
  return picture;
}

inline std::vector<uint32_t> bits(const std::vector<float>& values) {
  std::vector<uint32_t> result;
  for (float v : values) result.push_back(std::bit_cast<uint32_t>(v));
  return result;
}

inline std::set<std::string> files_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

}  // namespace noonmark
