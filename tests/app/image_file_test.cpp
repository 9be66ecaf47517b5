// Image files, read back with OpenImageIO as another program would read them.
#include "app/pictures/image_file.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/resource.h>
#include <unistd.h>
#include <zlib.h>

#include <bit>
#include <csignal>
#include <random>
#include <set>

#include "base/digest.h"
#include "base/error.h"
#include "base/file.h"
#include "tests/app/read_image.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

class ImageFile : public testing::Test {
 protected:
  // Returns the message of the Error that writing throws. The files in the folder must be the same as before.
  template <class Write>
  std::string failure(const Write& write) {
    const std::set<std::string> before = files_in(folder.path());
    try {
      write();
      ADD_FAILURE() << "the file was written without an error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::file);
      EXPECT_EQ(files_in(folder.path()), before) << "the failed write left a file or removed one";
      return error.what();
    }
    return "";
  }
  TemporaryFolder folder;
};

const std::vector<Channel> one_channel = {{"R0", Image<float>(64, 64, 0.5f)}};

RC_GTEST_FIXTURE_PROP(ImageFile, ExrKeepsEveryBit, ()) {
  const int width = *rc::gen::inRange(1, 20), height = *rc::gen::inRange(1, 20);
  std::vector<Channel> channels;
  for (const char* name : {"R1", "P.X", "zebra", "P.Y", "A", "depth.stored", "P.Z", "R0"}) {
    Image<float> values(width, height);
    // Any bit patterns: NaNs with a payload, infinities, denormals, -0.
    for (float& v : values.pixels) v = std::bit_cast<float>(*rc::gen::arbitrary<uint32_t>());
    channels.push_back({name, values});
  }
  const std::string path = folder.file("a.exr");
  write_exr(path, channels);
  const ReadImage image = read_exr(path);
  RC_ASSERT(image.spec.width == width);
  RC_ASSERT(image.spec.height == height);
  RC_ASSERT(image.spec.format == OIIO::TypeDesc::FLOAT);
  RC_ASSERT(image.channels.size() == channels.size());
  for (const Channel& channel : channels)
    RC_ASSERT(bits(image.channels.at(channel.name)) == bits(channel.values.pixels));
  RC_ASSERT(files_in(folder.path()) == std::set<std::string>{"a.exr"});
}

// A frame of an animated PNG as a PNG of its own: the chunks of the file, with the data of this frame alone.
std::string frame_as_png(const std::string& animated, size_t wanted) {
  std::string png = animated.substr(0, 8);
  size_t frame = 0;
  uint32_t number = 0;
  bool begun = false;
  for (size_t at = 8; at < animated.size();) {
    const auto number_at = [&](size_t place) {
      uint32_t value = 0;
      for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<uint8_t>(animated.at(place + i));
      return value;
    };
    const size_t length = number_at(at);
    const std::string type = animated.substr(at + 4, 4);
    std::string data = animated.substr(at + 8, length);
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(&animated[at + 4]), static_cast<uInt>(length + 4));
    EXPECT_EQ(number_at(at + 8 + length), sum) << type;
    if (type == "fcTL") {
      frame += begun;
      begun = true;
    }
    if (type == "fcTL" || type == "fdAT") {
      EXPECT_EQ(number_at(at + 8), number++) << "the order of the chunks";
    }
    if (type == "fdAT") data.erase(0, 4);
    const bool picture = type == "IDAT" || type == "fdAT";
    if (type != "fcTL" && type != "acTL" && (!picture || frame == wanted)) {
      const std::string kept = (picture ? "IDAT" : type) + data;
      const auto check = crc32(0, reinterpret_cast<const Bytef*>(kept.data()), static_cast<uInt>(kept.size()));
      const auto add = [&](uint64_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) png += static_cast<char>(value >> shift & 0xff);
      };
      add(data.size());
      png += kept;
      add(check);
    }
    at += length + 12;
  }
  return png;
}

TEST_F(ImageFile, AnAnimatedPngHasEveryFrameBitForBit) {
  std::mt19937 random(7);
  std::vector<Image<Color>> frames;
  for (int f = 0; f < 3; ++f) {
    Image<Color>& frame = frames.emplace_back(301, 173);  // noise: the data of a frame are several chunks
    for (Color& color : frame.pixels)
      color = Color(static_cast<uint8_t>(random()), static_cast<uint8_t>(random()), static_cast<uint8_t>(random()));
  }
  const std::string path = folder.file("a.png");
  const std::string digest = write_animated_png(path, frames, 200);
  EXPECT_EQ(digest, digest_of(read_file(path, 1 << 24)));
  EXPECT_EQ(read_png(path).pixels, frames[0].pixels) << "what a program shows that does not know animations";
  const std::string animated = read_file(path, 1 << 24);
  for (size_t f = 0; f < frames.size(); ++f) {
    write_file_atomically(folder.file("frame.png"), frame_as_png(animated, f));
    EXPECT_EQ(read_png(folder.file("frame.png")).pixels, frames[f].pixels) << f;
  }
}

TEST_F(ImageFile, AnimatedFramesHaveOneSize) {
  const std::vector<Image<Color>> frames = {Image<Color>(4, 3), Image<Color>(3, 4)};
  EXPECT_THROW(write_animated_png(folder.file("a.png"), frames, 200), std::invalid_argument);
  EXPECT_THROW(write_animated_png(folder.file("a.png"), {}, 200), std::invalid_argument);
  EXPECT_THROW(write_animated_png(folder.file("a.png"), {frames[0]}, 0), std::invalid_argument);
  EXPECT_TRUE(files_in(folder.path()).empty());
}

TEST_F(ImageFile, ExrRefusesChannelsOfDifferentSizes) {
  EXPECT_THROW(write_exr(folder.file("a.exr"), {{"a", Image<float>(2, 2)}, {"b", Image<float>(4, 1)}}),
               std::logic_error);
  EXPECT_TRUE(files_in(folder.path()).empty());
}

RC_GTEST_FIXTURE_PROP(ImageFile, PngKeepsEveryColour, ()) {
  Image<Color> picture(*rc::gen::inRange(1, 30), *rc::gen::inRange(1, 30));
  for (Color& color : picture.pixels) {
    const uint32_t value = *rc::gen::arbitrary<uint32_t>();
    color = {value & 255, value >> 8 & 255, value >> 16 & 255};
  }
  write_png(folder.file("a.png"), picture);
  const Image<Color> back = read_png(folder.file("a.png"));
  RC_ASSERT(back.width == picture.width);
  RC_ASSERT(back.height == picture.height);
  RC_ASSERT(back.pixels == picture.pixels);
  RC_ASSERT(files_in(folder.path()) == std::set<std::string>{"a.png"});
}

TEST_F(ImageFile, ReplacesWhatWasThere) {
  write_png(folder.file("a.png"), Image<Color>(3, 3, {1, 2, 3}));
  write_png(folder.file("a.png"), Image<Color>(2, 1, {4, 5, 6}));
  EXPECT_EQ(read_png(folder.file("a.png")).pixels, std::vector<Color>(2, {4, 5, 6}));
  EXPECT_EQ(files_in(folder.path()).size(), 1);
}

TEST_F(ImageFile, FailsWithoutItsFolder) {
  const std::string message = failure([&] { write_exr(folder.file("no/such/a.exr"), one_channel); });
  EXPECT_NE(message.find("no/such/a.exr"), std::string::npos) << message;
  failure([&] { write_png(folder.file("no/a.png"), Image<Color>(2, 2)); });
}

TEST_F(ImageFile, FailsWhereAFolderIsInTheWay) {
  for (const char* name : {"a.exr", "a.png"}) {
    fs::create_directories(folder.path() / name / "inner");
    failure([&] {
      if (std::string_view(name) == "a.exr")
        write_exr(folder.file(name), one_channel);
      else
        write_png(folder.file(name), Image<Color>(2, 2));
    });
    EXPECT_TRUE(fs::is_directory(folder.path() / name / "inner"));
  }
}

TEST_F(ImageFile, FailsWhereItMayNotWrite) {
  failure([&] { write_exr("/proc/self/a.exr", one_channel); });  // not even root may write there
  if (::geteuid() == 0) GTEST_SKIP() << "root may write into every folder on a disk";
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  failure([&] { write_exr(folder.file("a.exr"), one_channel); });
  failure([&] { write_png(folder.file("a.png"), Image<Color>(2, 2)); });
  fs::permissions(folder.path(), fs::perms::owner_all);
}

// Simulates a full disk for this process: no file may grow beyond a number of bytes.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(ImageFile, FailsOnAFullDiskAndKeepsTheOldFile) {
  std::mt19937 random(1);  // noise does not compress, so both files are larger than any buffer
  Image<float> noise(300, 200);
  Image<Color> colors(300, 200);
  for (float& v : noise.pixels) v = std::bit_cast<float>(static_cast<uint32_t>(random()));
  for (Color& color : colors.pixels) color = {random() & 255, random() & 255, random() & 255};
  write_exr(folder.file("a.exr"), {{"v", noise}});
  write_png(folder.file("a.png"), colors);
  const rlim_t exr = fs::file_size(folder.file("a.exr")), png = fs::file_size(folder.file("a.png"));
  write_exr(folder.file("a.exr"), one_channel);
  write_png(folder.file("a.png"), Image<Color>(2, 2, {7, 7, 7}));
  // The missing space goes from the whole file to its last byte, which a writer may keep until it closes the file.
  for (rlim_t missing : {exr, exr - 1000, exr / 2, rlim_t{5000}, rlim_t{1}}) {
    failure([&] {
      const FullDisk full(exr - missing);
      write_exr(folder.file("a.exr"), {{"v", noise}});
    });
  }
  for (rlim_t missing : {png, png - 1000, png / 2, rlim_t{5000}, rlim_t{1}}) {
    failure([&] {
      const FullDisk full(png - missing);
      write_png(folder.file("a.png"), colors);
    });
  }
  EXPECT_EQ(read_exr(folder.file("a.exr")).channels.at("R0"), one_channel[0].values.pixels);
  EXPECT_EQ(read_png(folder.file("a.png")).pixels, std::vector<Color>(4, {7, 7, 7}));
}

}  // namespace
}  // namespace noonmark
