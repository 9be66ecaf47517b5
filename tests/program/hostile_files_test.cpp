// Files that are made to harm who reads them: pictures that say to be larger than they are, and pipes and devices in the place of
// files. Each is refused with the exit code of its kind, in time, and within the memory that the program takes anyway.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <zlib.h>

#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

template <class T>
std::string little(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
std::string big(uint32_t value) { return little(__builtin_bswap32(value)); }

std::string chunk(const std::string& type, const std::string& data) {
  const std::string whole = type + data;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(whole.data()), static_cast<uInt>(whole.size()));
  return big(static_cast<uint32_t>(data.size())) + whole + big(static_cast<uint32_t>(sum));
}

// A PNG that says to have this size, with `bytes` zeros as its pixels. type: 0 grey, 6 red, green, blue and alpha.
std::string png(uint32_t width, uint32_t height, char depth, char type, size_t bytes, bool interlaced = false) {
  const std::string zeros(bytes, '\0');
  std::string packed(compressBound(bytes), '\0');
  uLongf size = packed.size();
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(zeros.data()), bytes, 9);
  packed.resize(size);
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big(width) + big(height) + depth + type + '\0' + '\0' + static_cast<char>(interlaced)) +
         chunk("IDAT", packed) + chunk("IEND", "");
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + little(static_cast<int32_t>(value.size())) + value;
}

struct Exr {
  int32_t width = 16, height = 16;
  char compression = 3;  // ZIP
  int channels = 1;
  uint32_t tile = 0;           // 0: rows
  uint32_t of_attribute = 0;   // says so many bytes of an attribute that has none
  bool several_parts = false;  // the part twice
};

std::string exr(const Exr& of) {
  std::string list;
  for (int i = 0; i < of.channels; ++i)
    list += fmt::format("c{}", i) + '\0' + little(int32_t{2}) + little(int32_t{0}) + little(int32_t{1}) +
            little(int32_t{1});
  const std::string window = little(int64_t{0}) + little(of.width - 1) + little(of.height - 1);
  std::string part = attribute("channels", "chlist", list + '\0') +
                     attribute("compression", "compression", std::string(1, of.compression)) +
                     attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) +
                     attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                     attribute("pixelAspectRatio", "float", little(1.0f)) +
                     attribute("screenWindowCenter", "v2f", little(0.0f) + little(0.0f)) +
                     attribute("screenWindowWidth", "float", little(1.0f));
  if (of.tile) part += attribute("tiles", "tiledesc", little(of.tile) + little(of.tile) + '\0');
  if (of.of_attribute) part += std::string("x\0string\0", 9) + little(of.of_attribute);
  part += '\0';
  const uint32_t flags = 2 | (of.tile ? 0x200u : 0) | (of.several_parts ? 0x1000u : 0);
  return std::string("\x76\x2f\x31\x01") + little(flags) + part + (of.several_parts ? part + '\0' : "") +
         std::string(64, '\0');
}

class HostileFiles : public Program {
 protected:
  struct Outcome {
    int code;
    double peak_bytes;
  };
  Outcome judge(const std::string& file, rlim_t address_space = RLIM_INFINITY) {
    const pid_t child = start({"judge", "cube-room", "--picture", file, "--out", "out"}, [&] {
      alarm(60);
      const rlimit most{address_space, address_space};
      setrlimit(RLIMIT_AS, &most);
      unsetenv("GLIBC_TUNABLES");  // scripts/test asks for huge pages, which are resident as a whole
    });
    int status = 0;
    struct rusage usage {};
    wait4(child, &status, 0, &usage);
    output_ = read_file((folder_ / "output.txt").string());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), 1024.0 * static_cast<double>(usage.ru_maxrss)};
  }
};

TEST_F(HostileFiles, APictureIsMeasuredByItsHeadBeforeItIsDecoded) {
  write("small.exr", exr({}));  // it has no rows, so it is refused by the decoder
  const Outcome usual = judge("small.exr");
  EXPECT_EQ(usual.code, 3) << output_;
  const std::pair<const char*, std::string> pictures[] = {
      {"truncated.png", png(16384, 16384, 16, 6, 1000)},
      {"interlaced.png", png(16384, 16384, 16, 6, 1000, true)},
      {"beyond-the-limit.png", png(20000, 20000, 8, 0, 50'000'000)},
      {"no-pixels.png", png(0, 16, 8, 0, 100)},
      {"of-two-billion.png", png(0x7fffffff, 0x7fffffff, 1, 0, 100)},
      {"truncated.exr", exr({.width = 16384, .height = 16384})},
      {"stored.exr", exr({.width = 1024, .height = 1024, .compression = 0})},
      {"wide.exr", exr({.width = 2'000'000'000})},
      {"tall.exr", exr({.height = 2'000'000'000})},
      {"negative.exr", exr({.width = -5})},
      {"dwa.exr", exr({.width = 16384, .height = 16384, .compression = 8})},
      {"channels.exr", exr({.channels = 1000})},
      {"one-tile.exr", exr({.width = 16384, .height = 16384, .tile = 16384})},
      {"tile-of-two-billion.exr", exr({.tile = 0x7fffffff})},
      {"attribute.exr", exr({.of_attribute = 2'000'000'000})},
      {"parts.exr", exr({.width = 16384, .height = 16384, .several_parts = true})},
  };
  constexpr double room = 64 << 20;  // for what the decoders themselves take
  for (const auto& [name, bytes] : pictures) {
    SCOPED_TRACE(name);
    write(name, bytes);
    const Outcome outcome = judge(name);
    EXPECT_EQ(outcome.code, 3) << output_;
    EXPECT_TRUE(says(std::string("noonmark: ") + name + ": ")) << output_;
    EXPECT_LT(outcome.peak_bytes, usual.peak_bytes + room);
  }
  // A whole picture, but to judge so many pixels takes more memory than this process may have.
  write("whole.png", png(16000, 16000, 1, 0, 16000 * 2001));
  const Outcome whole = judge("whole.png", rlim_t{8} << 30);
  EXPECT_EQ(whole.code, 3) << output_;
  EXPECT_TRUE(says("to judge 16000 x 16000 pixels takes ")) << output_;
  EXPECT_LT(whole.peak_bytes, usual.peak_bytes + room);
}

// numpy aligns headers with spaces, so a long one can be a right one.
TEST_F(HostileFiles, AHeaderOfNumpyIsReadInConstantStack) {
  const auto npy = [](const std::string& header) {
    return "\x93NUMPY" + std::string("\2\0", 2) + little(static_cast<uint32_t>(header.size())) + header +
           std::string(9 * 16 * sizeof(float), '\0');
  };
  const std::string spaces(60000, ' '), commas(60000, ','), letters(60000, 'a');
  const struct {
    std::string header;
    int code;
  } files[] = {{"{" + spaces + "'descr': '<f4', 'fortran_order': False, 'shape': (9, 16), }", 0},
               {"{'descr':" + spaces + "'<f4', 'fortran_order':" + spaces + "False, 'shape': (9, 16), }", 3},
               {"{'fortran_order':" + spaces + "False, 'descr': '<f4', 'shape': (9, 16), }", 0},
               {"{'shape': (" + spaces + "9 , 16,), 'descr': '<f4', 'fortran_order': False}", 0},
               {"{'shape': (9, 16" + commas + "1), 'descr': '" + letters + "', 'fortran_order': False}", 3},
               {"{'shape': (9, 16), 'descr': '" + letters + "', 'fortran_order': False}", 3},
               {"{'shape': (9, 16), 'descr': '<f4', 'fortran_order': True}", 3},
               {"{'shape': (999999999999999999999, 16), 'descr': '<f4', 'fortran_order': False}", 3},
               {"{'shape': (268435456, 268435456), 'descr': '<f4', 'fortran_order': False}", 3},
               {"{'shape': (9, -16), 'descr': '<f4', 'fortran_order': False}", 3},
               {"{'shape': (9, 16, 1, 1), 'descr': '<f4', 'fortran_order': False}", 3},
               {"{'shape': (9, 16), 'descr': '<f4'}", 3},
               {"'shape'", 3}};
  for (const auto& [header, code] : files) {
    SCOPED_TRACE(header.substr(0, 80));
    write("v.npy", npy(header));
    EXPECT_EQ(judge("v.npy").code, code) << output_;
  }
  write("v.npy", npy("{'descr': '<f4', 'fortran_order': False, 'shape': (9, 16), }" + std::string(3 << 20, ' ')));
  EXPECT_EQ(judge("v.npy").code, 3) << output_;
  EXPECT_FALSE(says("cut off")) << "it is whole: " << output_;
}

// Nothing that is read as a file may be a pipe, which would wait, or a device, which would never end.
TEST_F(HostileFiles, APipeOrADeviceIsNoFile) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder_ / "zero");
  fs::create_directories(folder_ / "dir");
  write("x.toml", one_point + held_bound);
  for (const std::string odd : {"pipe", "zero", "dir"}) {
    SCOPED_TRACE(odd);
    const auto refused = [&](const std::vector<std::string>& words, int code) {
      EXPECT_EQ(run(words, [] { alarm(30); }), code) << output_;
      EXPECT_TRUE(says("not a regular file") || says("is a folder")) << output_;
    };
    const auto as = [&](const std::string& ending) {
      const std::string name = odd + ending;
      fs::remove(folder_ / name);
      fs::create_symlink(odd, folder_ / name);
      return name;
    };
    refused({"judge", "cube-room", "--picture", odd, "--out", "out"}, 3);
    refused({"judge", as(".json"), "--out", "out"}, odd == "dir" ? 2 : 3);
    refused({"run", as(".toml"), "--out", "out"}, 2);
    refused({"check", "x.toml", "--out", "out", "--baseline", odd}, 2);
    refused({"inspect", as(".glb"), "--out", "out"}, 3);
    refused({"inspect", as(".gltf"), "--out", "out"}, 3);
    write("frame.json", R"({"noonmark_frame": 1, "scene": "cube-room", "visibility": {"file": ")" + odd +
                            R"("}, "positions": {"file": ")" + odd + "\"}}");
    refused({"judge", "frame.json", "--out", "out"}, 3);
    fs::create_directories(folder_ / "results");
    fs::remove(folder_ / "results/results.sqlite");
    fs::create_symlink("../" + odd, folder_ / "results/results.sqlite");
    refused({"report", "results"}, 3);
    refused({"merge", "joined", "results"}, 3);
  }
}

}  // namespace
}  // namespace noonmark::acceptance
