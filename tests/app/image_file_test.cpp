// Image files, read back with OpenImageIO as another program would read them.
#include "app/image_file.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <bit>
#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "app/pictures.h"
#include "app/point_files.h"
#include "compare/report/cause_colors.h"
#include "compare/store/metrics.h"
#include "scenes/error.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

struct ReadImage {
  OIIO::ImageSpec spec;
  std::map<std::string, std::vector<float>> channels;
};

ReadImage read_exr(const std::string& path) {
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

Image<Color> read_png(const std::string& path) {
  const auto input = OIIO::ImageInput::open(path);
  if (!input) throw std::runtime_error(OIIO::geterror());
  EXPECT_EQ(input->spec().nchannels, 3);
  EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT8);
  Image<Color> picture(input->spec().width, input->spec().height);
  if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, picture.pixels.data()))
    throw std::runtime_error(input->geterror());
  return picture;
}

std::vector<uint32_t> bits(const std::vector<float>& values) {
  std::vector<uint32_t> result;
  for (float v : values) result.push_back(std::bit_cast<uint32_t>(v));
  return result;
}

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

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

TEST_F(ImageFile, ExrKeepsWhatIsNoNumber) {
  using Float = std::numeric_limits<float>;
  Image<float> values(5, 1);
  values.pixels = {Float::quiet_NaN(), Float::infinity(), -Float::infinity(), -0.0f, Float::denorm_min()};
  write_exr(folder.file("a.exr"), {{"v", values}});
  EXPECT_EQ(bits(read_exr(folder.file("a.exr")).channels.at("v")), bits(values.pixels));
}

TEST_F(ImageFile, ExrHasTheTopRowFirst) {
  Image<float> values(1, 3);
  values.pixels = {10, 20, 30};
  write_exr(folder.file("a.exr"), {{"v", values}});
  EXPECT_EQ(read_exr(folder.file("a.exr")).channels.at("v"), values.pixels);
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

TEST_F(ImageFile, FailsOnAnUnknownFormat) {
  failure([&] { write_exr(folder.file("a.no-such-format"), one_channel); });
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

// A point of 3 x 2 pixels over a map of 2 x 2 texels, in which all numbers are different.
class Pictures : public ImageFile {
 protected:
  Pictures() {
    const auto fill = [](auto& image, int width, int height, const auto& value) {
      image = std::remove_reference_t<decltype(image)>(width, height);
      for (size_t i = 0; i < image.size(); ++i) image[i] = value(i);
    };
    const auto numbered = [](float first) { return [=](size_t i) { return first + static_cast<float>(i) / 8; }; };
    fill(receivers.position, 3, 2, [](size_t i) {
      const float f = static_cast<float>(i);
      return glm::vec3(f, f + 0.25f, -f);
    });
    fill(receivers.normal, 3, 2, [](size_t i) {
      const float f = static_cast<float>(i);
      return glm::vec3(-f, 1, f * 2);
    });
    fill(receivers.primitive, 3, 2, [](size_t i) { return i == 5 ? no_primitive : static_cast<uint32_t>(1000 + i); });
    fill(probe.reference, 3, 2, numbered(0.125f));
    fill(probe.n_dot_l, 3, 2, [](size_t) { return 0.5f; });
    // In order: inside the map, on the repetition of (1, 1), at two corners, outside, and no receiver.
    probe.map_texels = Image<glm::vec2>(3, 2);
    probe.map_texels.pixels = {{0.5f, 0}, {-1, 3.5f}, {1, 0.9f}, {0, 1}, {2, 0}, {0, 0}};
    probe.pattern = tap_pattern({});
    fill(stored, 2, 2, numbered(0.1f));
    fill(exact, 2, 2, numbered(0.2f));
    for (size_t n = 0; n < 6; ++n)
      fill(ladder.rungs[n].lit, 3, 2, [n](size_t i) { return static_cast<float>((n + i) % 2); });
    for (size_t c = 0; c < cause_count; ++c) fill(ladder.causes[c].step, 3, 2, numbered(static_cast<float>(c)));
    ladder.cause = ladder.flags = Image<uint8_t>(3, 2);
    ladder.cause.pixels = {0, 5, 6, 9, 3, 0};
    ladder.flags.pixels = {1, 3, 5, 7, 1, 0};
    scene.light.angular_diameter_deg = 0;
    settings.map.wrap = Wrap::repeat;
    frame.resolution = 2;
  }
  Measurement measurement() const {
    const Camera camera{.near_m = 0.1, .far_m = 100};
    return {{}, settings, ladder, frame, camera, scene, receivers, probe, stored, exact};
  }

  Settings settings;
  Ladder ladder = empty_ladder(3, 2);
  LightFrame frame;
  Scene scene;
  ReceiverImage receivers;
  LookupProbe probe;
  Image<float> stored, exact;
};

TEST_F(Pictures, LadderHoldsEveryRungAndWhatItWasMadeOf) {
  write_images(measurement(), folder.path().string(), "images", "p-");
  EXPECT_EQ(files_in(folder.path()), (std::set<std::string>{"p-ladder.exr", "p-map.exr"}));
  const ReadImage image = read_exr(folder.file("p-ladder.exr"));
  const auto expect = [&](const std::string& name, const std::vector<float>& values) {
    ASSERT_TRUE(image.channels.contains(name)) << name;
    EXPECT_EQ(bits(image.channels.at(name)), bits(values)) << name;
  };
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> p, n;
    for (size_t i = 0; i < 6; ++i) {
      p.push_back(receivers.position[i][axis]);
      n.push_back(receivers.normal[i][axis]);
    }
    expect(std::string("P.") + "XYZ"[axis], p);
    expect(std::string("N.") + "XYZ"[axis], n);
  }
  expect("primitive", {1000, 1001, 1002, 1003, 1004, -1});
  for (size_t n = 0; n < 6; ++n) expect("R" + std::to_string(n), ladder.rungs[n].lit.pixels);
  expect("depth.reference", probe.reference.pixels);
  expect("cause", {0, 5, 6, 9, 3, 0});
  expect("flags", {1, 3, 5, 7, 1, 0});
  for (int c = 1; c < cause_count; ++c)
    expect("step." + std::string(cause_name(static_cast<Cause>(c))), ladder.causes[static_cast<size_t>(c)].step.pixels);
  EXPECT_EQ(image.channels.size(), 6 + 1 + 6 + 3 + 2 + cause_count - 1);
  EXPECT_EQ(image.spec.format, OIIO::TypeDesc::FLOAT);

  // The depths that the wrap mode gives for the texels above. The last pixel has no receiver.
  const auto expect_depths = [&](std::vector<int> texels) {
    write_images(measurement(), folder.path().string(), "images", "q-");
    const ReadImage read = read_exr(folder.file("q-ladder.exr"));
    for (const auto& [name, map] : {std::pair("depth.stored", &stored), std::pair("depth.exact", &exact)}) {
      for (size_t i = 0; i < 5; ++i)
        EXPECT_EQ(read.channels.at(name)[i], texels[i] < 0 ? 1.0f : (*map)[static_cast<size_t>(texels[i])])
            << name << " of pixel " << i;
      EXPECT_TRUE(std::isnan(read.channels.at(name)[5]));
    }
  };
  expect_depths({0, 3, 1, 2, 0});
  settings.map.wrap = Wrap::clamp_to_edge;
  expect_depths({0, 2, 1, 2, 1});
  settings.map.wrap = Wrap::clamp_to_border;
  expect_depths({0, -1, 1, 2, -1});
}

TEST_F(Pictures, MapHasItsHighestRowOnTop) {
  write_images(measurement(), folder.path().string(), ".", "");
  const ReadImage map = read_exr(folder.file("map.exr"));
  EXPECT_EQ(map.channels.size(), 2);
  EXPECT_EQ(map.channels.at("depth.stored"), (std::vector<float>{stored[2], stored[3], stored[0], stored[1]}));
  EXPECT_EQ(map.channels.at("depth.exact"), (std::vector<float>{exact[2], exact[3], exact[0], exact[1]}));
}

TEST_F(Pictures, AreNamedInTheirRecords) {
  const auto names_of = [&] {
    std::set<std::string> names;
    for (const PictureRecord& record : write_pictures(measurement(), folder.path().string(), "images", "p0003")) {
      EXPECT_EQ(record.path, "images/p0003-" + record.name + ".png");
      EXPECT_TRUE(record.caption.ends_with('.'));
      const Image<Color> picture = read_png(folder.file("p0003-" + record.name + ".png"));
      EXPECT_EQ(picture.width, record.name == "depth" ? 2 : 3) << record.name;
      EXPECT_EQ(picture.height, 2) << record.name;
      names.insert(record.name);
    }
    return names;
  };
  std::set<std::string> names = {"truth",   "map",          "classes",    "difference",       "depth",
                                 "frustum", "shaded-truth", "shaded-map", "shaded-difference"};
  EXPECT_EQ(names_of(), names);
  settings.light.angular_diameter_deg = 0.5;
  names.insert({"soft-truth", "shaded-soft-truth"});
  EXPECT_EQ(names_of(), names);
}

Color named(std::string_view name) {
  const CauseColor* color = find_color(name);
  if (!color) throw std::logic_error(std::string(name));
  return {color->r, color->g, color->b};
}

TEST_F(Pictures, ClassesShowTheColoursOfTheLegend) {
  for (float& cosine : probe.n_dot_l.pixels)
    cosine = 1;  // full light, so that shading does not change the colours of the legend
  // In order: completely wrong (full colour), right and lit, right and dark, ambiguous, facing away, no surface.
  ladder.flags.pixels = {1, 1, 1, 5, 0, 0};
  ladder.cause.pixels = {static_cast<uint8_t>(Cause::acne), 0, 0, 0, 0, 0};
  ladder[Rung::truth].pixels = {1, 1, 0, 1, 0, 0};
  ladder[Rung::shown].pixels = {0, 1, 0, 0, 0, 0};
  write_pictures(measurement(), folder.path().string(), "images", "p");
  EXPECT_EQ(read_png(folder.file("p-classes.png")).pixels,
            (std::vector<Color>{named("acne"), named("lit"), named("shadowed"), named("ambiguous"), named("attached"),
                                named("background")}));
  const Image<Color> difference = read_png(folder.file("p-difference.png"));
  EXPECT_EQ(difference[0], named("acne"));
  EXPECT_EQ(difference[1], named("lit"));
  EXPECT_EQ(difference[5], named("background"));
  const Image<Color> truth = read_png(folder.file("p-truth.png")), map = read_png(folder.file("p-map.png"));
  EXPECT_GT(truth[0].r, map[0].r);  // lit, and falsely dark in the map
  EXPECT_EQ(truth[1], map[1]);
}

// A rung on top of R5 brings its cause: its colour in the picture of the classes, its numbers and its description in
// point.json, its name in the captions.
TEST_F(Pictures, ShowARungOnTopAndItsCause) {
  for (float& cosine : probe.n_dot_l.pixels) cosine = 1;
  ladder.flags.pixels = {1, 1, 1, 5, 0, 0};
  ladder[Rung::truth].pixels = ladder[Rung::shown].pixels = {1, 1, 0, 1, 0, 0};
  for (Ladder::CauseImage& cause : ladder.causes) cause.step = Image<float>(3, 2, 0);
  Image<float> picture = ladder.shown();
  picture[0] = 0;
  const std::array<uint8_t, 3> leak{1, 2, 3};
  add_rung(ladder, {"R6", picture, "leak", "Leak", "Light that leaks."});
  picture[2] = 1;
  add_rung(ladder, {"R7", picture, "penumbra", "Penumbra", "Its width.", leak});
  std::map<std::string, std::string> captions;
  for (const PictureRecord& record : write_pictures(measurement(), folder.path().string(), "images", "p"))
    captions[record.name] = record.caption;
  const Image<Color> classes = read_png(folder.file("p-classes.png"));
  EXPECT_EQ(classes[0], Color(spare_colors[0][0], spare_colors[0][1], spare_colors[0][2]));
  EXPECT_EQ(classes[1], named("lit"));
  EXPECT_EQ(classes[2], Color(1, 2, 3));
  EXPECT_EQ(captions.at("map"), "What the given picture showed (R7).");
  EXPECT_EQ(captions.at("truth"), "The truth: one exact shadow ray for each pixel (R1).");
  EXPECT_TRUE(captions.at("difference").starts_with("Given picture minus truth")) << captions.at("difference");
  EXPECT_NE(captions.at("shaded-map").find("given picture's shadow (R7)"), std::string::npos);

  Measurement m = measurement();
  m.record.causes = ladder.brought;
  m.record.metrics = {{"error", 0.5}, {"leak", 0.25}, {"penumbra", nan_value}};
  const nlohmann::json json = nlohmann::json::parse(point_json(m, ""));
  EXPECT_EQ(json.at("metrics"), nlohmann::json({{"error", 0.5}, {"leak", 0.25}, {"penumbra", "nan"}}));
  EXPECT_EQ(json.at("rungs"), nlohmann::json({"R0", "R1", "R2", "R3", "R4", "R5", "R6", "R7"}));
  EXPECT_EQ(json.at("rungs_on_top").at(1), nlohmann::json({{"name", "R7"},
                                                           {"cause", "penumbra"},
                                                           {"label", "Penumbra"},
                                                           {"help", "Its width."},
                                                           {"color", {1, 2, 3}}}));
  write_images(m, folder.path().string(), ".", "");
  const ReadImage file = read_exr(folder.file("ladder.exr"));
  EXPECT_EQ(file.channels.at("R7"), picture.pixels);
  EXPECT_EQ(file.channels.at("step.penumbra"), (std::vector<float>{0, 0, 1, 0, 0, 0}));
}

TEST_F(Pictures, ShowWhatIsNoNumberAsWrong) {
  ladder.flags.pixels[0] = flag_facing;
  ladder.cause.pixels[0] = static_cast<uint8_t>(Cause::precision);
  ladder[Rung::truth].pixels[0] = 1;
  ladder[Rung::shown].pixels[0] = std::numeric_limits<float>::quiet_NaN();
  write_pictures(measurement(), folder.path().string(), "images", "p");
  EXPECT_EQ(read_png(folder.file("p-classes.png"))[0], named("precision"));
  EXPECT_EQ(read_png(folder.file("p-difference.png"))[0], named("peter_panning"));
  EXPECT_EQ(read_png(folder.file("p-map.png"))[0], Color(0, 0, 0));
}

TEST_F(Pictures, PointHoldsEverySettingAndWhatIsNotFinite) {
  Measurement m = measurement();
  for (const Metric& metric : metrics_table()) m.record.metrics[std::string(metric.name)] = 0.25;
  m.record.metrics["error"] = nan_value;
  m.record.metrics["acne"] = inf_value;
  m.record.times["map_ms"] = -inf_value;
  m.record.worst = {3, 4, inf_value, "acne"};
  const nlohmann::json json = nlohmann::json::parse(point_json(m, "noonmark render 'x'"));
  for (const Setting& row : settings_table())
    EXPECT_TRUE(json.at("settings").contains(std::string(row.name))) << row.name;
  for (const Metric& metric : metrics_table())
    EXPECT_TRUE(json.at("metrics").contains(std::string(metric.name))) << metric.name;
  EXPECT_EQ(json.at("metrics").at("error"), "nan");
  EXPECT_EQ(json.at("metrics").at("acne"), "inf");
  EXPECT_EQ(json.at("metrics").at("wrong"), 0.25);
  EXPECT_EQ(json.at("times").at("map_ms"), "-inf");
  EXPECT_EQ(json.at("settings").at("map.resolution"), 1024);
  EXPECT_EQ(json.at("settings").at("map.extent_m"), "auto");
  EXPECT_EQ(json.at("settings").at("bias.constant"), 0);
  EXPECT_EQ(json.at("settings").at("map.lit_beyond_far"), true);
  ASSERT_EQ(json.at("causes").size(), cause_count);
  for (int c = 0; c < cause_count; ++c)
    EXPECT_EQ(json.at("causes")[static_cast<size_t>(c)], std::string(cause_name(static_cast<Cause>(c))));
  EXPECT_EQ(json.at("worst"), nlohmann::json({{"x", 3}, {"y", 4}, {"error", "inf"}, {"cause", "acne"}}));
  EXPECT_FALSE(json.contains("part"));
  EXPECT_EQ(json.at("flags").at("outside"), flag_outside);
  EXPECT_EQ(json.at("command"), "noonmark render 'x'");
}

}  // namespace
}  // namespace noonmark
