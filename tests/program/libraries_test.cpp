// Which shared libraries the program loads, and its messages if one is missing.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <regex>
#include <tuple>

#include "tests/program/fixture.h"
#include "tests/support/source_dir.h"

namespace noonmark::acceptance {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

class Libraries : public Program {
 protected:
  // A file that is not a library simulates a missing one: the loader finds it first and does not search further.
  int run_without(const std::vector<std::string>& libraries, const std::vector<std::string>& arguments) {
    const fs::path hiding = folder_ / "hiding";
    fs::remove_all(hiding);
    fs::create_directories(hiding);
    for (const std::string& library : libraries) write("hiding/" + library, "");
    setenv("LD_LIBRARY_PATH", hiding.c_str(), 1);
    const int code = run(arguments);
    unsetenv("LD_LIBRARY_PATH");
    return code;
  }
  // "2.4": of the OpenImageIO that is here.
  std::string image_version() {
    run({"doctor"});
    std::smatch found;
    return std::regex_search(output_, found, std::regex("OpenImageIO ([0-9]+\\.[0-9]+)\\.")) ? found[1].str() : "";
  }
};

const std::vector<std::string> small_picture = {"render", "--set", "view.width_px=16", "--set", "view.height_px=9"};

// The 250 libraries of OpenImageIO would cost 0.4 s, even for `--version`.
TEST_F(Libraries, StartsWithThoseAloneThatEveryMeasurementNeeds) {
  setenv("LD_TRACE_LOADED_OBJECTS", "1", 1);  // the loader lists the libraries and does not run the program
  const int code = run({});
  unsetenv("LD_TRACE_LOADED_OBJECTS");
  ASSERT_EQ(code, 0) << output_;
  EXPECT_TRUE(says("libembree")) << output_;
  for (const char* later : {"OpenImageIO", "libGL.so", "libOpenGL.so", "libEGL.so"})
    EXPECT_FALSE(says(later)) << output_;
  EXPECT_LT(std::count(output_.begin(), output_.end(), '\n'), 30) << output_;
}

// An experiment may lie in a folder that another person fills. The planted files are no libraries, so the program would
// not start with one of them.
TEST_F(Libraries, NoneIsLoadedFromTheCurrentFolder) {
  setenv("LD_TRACE_LOADED_OBJECTS", "1", 1);
  const int code = run({});
  unsetenv("LD_TRACE_LOADED_OBJECTS");
  ASSERT_EQ(code, 0) << output_;
  const std::string listing = output_;
  const std::regex name("(lib\\S+) =>");
  int planted = 0;
  for (std::sregex_iterator one(listing.begin(), listing.end(), name), none; one != none; ++one, ++planted)
    write((*one)[1], "planted");
  EXPECT_GT(planted, 10) << listing;
  for (const char* later : {"libembree3.so.3", "noonmark_images.so", "libOpenImageIO.so.2.4", "libEGL.so.1"})
    write(later, "planted");
  EXPECT_EQ(run({"--version"}), 0) << output_;
  EXPECT_EQ(run(small_picture), 0) << output_;
}

// If one of these libraries is missing, the system's loader prints its own message. So docs/reference/exit-codes.md lists
// them.
TEST_F(Libraries, ReferenceNamesEveryOneThatTheProgramIsLinkedWith) {
  if (sanitized) GTEST_SKIP() << "the sanitizers' libraries are linked as well";
  FILE* const listing = popen("readelf -d '" NOONMARK_PROGRAM "' 2>/dev/null", "r");
  ASSERT_NE(listing, nullptr);
  std::string dynamic;
  for (int c = 0; (c = std::fgetc(listing)) != EOF;) dynamic += static_cast<char>(c);
  if (pclose(listing) != 0) GTEST_SKIP() << "no readelf here";
  const std::string page = read_file(noonmark::test::source_dir() + "/docs/reference/exit-codes.md");
  const size_t begin = page.find("What the program is linked with"), end = page.find("ends with 127", begin);
  ASSERT_NE(end, std::string::npos);
  const auto in_small_letters = [](std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
  };
  const std::string sentence = in_small_letters(page.substr(begin, end - begin));
  // Libraries whose name on the page differs from the file name.
  const std::map<std::string, std::string> words = {{"tbb", "onetbb"},  {"tomlplusplus", "toml++"}, {"stdc++", "c++"},
                                                    {"m", "c and c++"}, {"OpenEXR-3_", "openexr"},  {"c", "c and c++"},
                                                    {"gcc_s", "c++"}};
  const std::regex needed("\\[lib([^\\]]+?)[0-9]*\\.so");
  int count = 0;
  for (std::sregex_iterator one(dynamic.begin(), dynamic.end(), needed), none; one != none; ++one, ++count) {
    const auto other = words.find((*one)[1]);
    const std::string word = other == words.end() ? (*one)[1].str() : other->second;
    EXPECT_NE(sentence.find(in_small_letters(word)), std::string::npos) << word;
  }
  EXPECT_GT(count, 10);
}

TEST_F(Libraries, WithoutOpenGlSaysWhatToInstall) {
  const std::vector<Words> needed = {
      {"libEGL.so.1"}, {"libOpenGL.so.0", "libGL.so.1"}, {"libGLdispatch.so.0"}, {"libEGL_mesa.so.0"}};
  for (const Words& missing : needed) {
    SCOPED_TRACE(missing.back());
    EXPECT_EQ(run_without(missing, {"doctor"}), 4) << output_;
    EXPECT_TRUE(says("OpenGL    NOT USABLE") && says("apt install libegl1")) << output_;
    EXPECT_TRUE(says("Embree    ")) << "the other parts must be reported as well: " << output_;
    EXPECT_EQ(run_without(missing, small_picture), 4) << output_;
    EXPECT_TRUE(says("apt install libegl1")) << output_;
    EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 1) << output_;
    EXPECT_EQ(run_without(missing, {"settings"}), 0) << output_;
  }
  if (!dlopen("libOpenGL.so.0", RTLD_LAZY) || !dlopen("libGL.so.1", RTLD_LAZY))
    return;  // only one of them is installed
  for (const char* one : {"libOpenGL.so.0", "libGL.so.1"})
    EXPECT_EQ(run_without({one}, {"doctor"}), 0) << "one of the two libraries must be enough: " << output_;
}

// OpenImageIO reads the pictures of other programs; what the program writes needs it nowhere.
TEST_F(Libraries, WithoutOpenImageIoMeasuresAndReadsNoPictures) {
  write("pictures.toml", "scene = \"plate\"\nexr = true\n[view]\nwidth_px = 16\nheight_px = 9\n");
  const std::vector<std::string> missing = {"noonmark_images.so", "libOpenImageIO.so." + image_version()};
  EXPECT_EQ(run_without(missing, {"doctor"}), 4) << output_;
  EXPECT_TRUE(says("Pictures  NOT USABLE") && says("noonmark_images.so")) << output_;
  EXPECT_TRUE(says("it belongs in lib/noonmark") && !says("apt install")) << output_;
  EXPECT_EQ(run_without(missing, small_picture + Words{"--out", "rendered"}), 0) << output_;
  EXPECT_TRUE(fs::exists(folder_ / "rendered/ladder.exr") && fs::exists(folder_ / "rendered/point-truth.png"));
  EXPECT_EQ(run_without(missing, {"run", "pictures.toml", "--out", "out"}), 0) << output_;
  for (const char* picture : {"rendered/ladder.exr", "rendered/point-truth.png"}) {
    EXPECT_EQ(run_without(missing, {"judge", "plate", "--picture", picture, "--out", "judged"}), 4) << output_;
    EXPECT_TRUE(says("it belongs in lib/noonmark")) << output_;
    EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 1) << output_;
  }
}

TEST_F(Libraries, AdvisesOnTheOneThatIsMissing) {
  const std::string version = image_version();
  EXPECT_EQ(run_without({"libOpenImageIO.so." + version}, {"doctor"}), 4) << output_;
  EXPECT_TRUE(says("Pictures  NOT USABLE") && says("apt install libopenimageio" + version)) << output_;
  EXPECT_TRUE(says("OpenGL    ") && !says("OpenGL    NOT USABLE")) << output_;
  // A library that OpenImageIO needs and the program itself does not.
  EXPECT_EQ(run_without({"libGLX.so.0"}, {"doctor"}), 4) << output_;
  EXPECT_TRUE(says("libGLX.so.0 is a library that OpenImageIO needs")) << output_;
  EXPECT_FALSE(says("apt install libopenimageio")) << output_;
}

// No library is missing here: the chosen driver offers too old a version, or a variable makes it report one.
TEST_F(Libraries, ADriverOfAnOlderOpenGlSaysWhatItOffersAndWhoChoseIt) {
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"GALLIUM_DRIVER", "softpipe", "(softpipe)"},
      {"MESA_GL_VERSION_OVERRIDE", "3.0", "OpenGL 3.0"},
      {"MESA_GL_VERSION_OVERRIDE", "4.4", "OpenGL 4.4"}};
  for (const auto& [name, value, offers] : cases) {
    SCOPED_TRACE(name + "=" + value);
    const auto chosen = [&name = name, &value = value] {
      setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);  // the variables work only with Mesa, and a GPU may have another driver
      setenv(name.c_str(), value.c_str(), 1);
    };
    EXPECT_EQ(run({"doctor"}, chosen), 4) << output_;
    EXPECT_TRUE(says("its driver offers OpenGL ") && says(offers) && says(" only; what is set can be the reason: "))
        << output_;
    EXPECT_TRUE(says(name + "=" + value)) << output_;
    EXPECT_FALSE(says("apt install")) << output_;
    EXPECT_EQ(run(small_picture, chosen), 4) << output_;
    EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 1) << output_;
  }
}

}  // namespace
}  // namespace noonmark::acceptance
