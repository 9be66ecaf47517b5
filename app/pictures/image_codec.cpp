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

// Hands on what the library writes, because OpenImageIO 2.4 itself does not notice a full disk and leaves incomplete
// files. After a failure the library is told that all is well: it may write again while it closes the file.
class Output : public OIIO::Filesystem::IOProxy {
 public:
  explicit Output(const ImageToEncode& image) : IOProxy("", Write), image_(image) {}
  const char* proxytype() const override { return "noonmark"; }
  size_t size() const override { return size_; }
  size_t write(const void* bytes, size_t count) override {
    take(bytes, count, m_pos);
    m_pos += static_cast<int64_t>(count);
    return count;
  }
  size_t pwrite(const void* bytes, size_t count, int64_t offset) override {
    take(bytes, count, offset);
    return count;
  }
  bool failed() const { return failed_; }

 private:
  void take(const void* bytes, size_t count, int64_t offset) {
    const auto at = static_cast<uint64_t>(offset);
    failed_ = failed_ || !image_.write(image_.context, at, static_cast<const char*>(bytes), count);
    size_ = std::max(size_, static_cast<size_t>(at) + count);
  }
  const ImageToEncode& image_;
  size_t size_ = 0;
  bool failed_ = false;
};

// At most 16 MiB of rows at a time. EXR compresses 16 rows together.
int rows_at_a_time(size_t row_bytes) {
  return static_cast<int>(std::clamp<size_t>((size_t{1} << 24) / row_bytes / 16, 1, 4096)) * 16;
}

void encode(const ImageToEncode& image, Output& bytes) {
  const OIIO::TypeDesc type = image.channel_names ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8;
  OIIO::ImageSpec spec(image.width, image.height, image.channels, type);
  if (image.channel_names) {
    spec.attribute("compression", "zip:1");
    // Without it OpenImageIO writes the time, so that equal pictures would be files of different bytes.
    spec.attribute("DateTime", "");
    spec.channelnames.assign(image.channel_names, image.channel_names + image.channels);
  } else {
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("png:compressionLevel", 6);
  }
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(image.path, &bytes);
  if (!output) throw std::runtime_error(OIIO::geterror());
  if (!output->open(image.path, spec)) throw std::runtime_error(output->geterror());
  const size_t row_bytes = spec.scanline_bytes();
  const int most = std::min(rows_at_a_time(row_bytes), image.height);
  std::vector<char> rows(row_bytes * static_cast<size_t>(most));
  for (int first = 0; first < image.height; first += most) {
    const int count = std::min(most, image.height - first);
    if (!image.rows(image.context, first, count, rows.data()) || bytes.failed()) return;
    if (!output->write_scanlines(first, first + count, 0, type, rows.data()))
      throw std::runtime_error(output->geterror());
  }
  if (!output->close()) throw std::runtime_error(output->geterror());
}

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

extern "C" void noonmark_encode_image(const noonmark::ImageToEncode& image) {
  try {
    noonmark::Output bytes(image);  // outlives the library's output, which writes to it
    noonmark::encode(image, bytes);
  } catch (const std::exception& thrown) {
    image.fail(image.context, *thrown.what() ? thrown.what() : "OpenImageIO gives no reason");
  }
}

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
