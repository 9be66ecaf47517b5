// The C interface, as a program that loads the library sees it: no exception, messages for what is wrong, old and new headers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "frames/noonmark.h"

namespace {

constexpr int width = 320, height = 180;

// A camera above the scene that looks down: 12 m x 6.75 m, orthographic.
noonmark_frame frame_of(const std::vector<float>& visibility) {
  noonmark_frame frame;
  noonmark_frame_init(&frame, sizeof frame);
  frame.width = width;
  frame.height = height;
  frame.visibility = visibility.data();
  const double camera[16] = {2 / 12., 0, 0, 0, 0, 0, -2 / 20., 0, 0, -2 / 6.75, 0, 0, 0, 0, -0.4, 1};
  std::memcpy(frame.clip_from_world, camera, sizeof camera);
  frame.light_direction[0] = 0.5;
  frame.light_direction[1] = -1;
  return frame;
}

std::string messages_of(const noonmark_verdict* verdict) {
  std::string all;
  for (size_t i = 0; const char* message = noonmark_message(verdict, i); ++i) all += std::string(message) + "\n";
  return all;
}

class CInterface : public testing::Test {
 protected:
  ~CInterface() override {
    noonmark_verdict_free(verdict_);
    noonmark_scene_free(scene_);
  }
  void judge(const noonmark_frame* frame) {
    noonmark_verdict_free(verdict_);
    verdict_ = noonmark_judge(scene_, frame);
    ASSERT_NE(verdict_, nullptr);
  }
  noonmark_scene* scene_ = noonmark_scene_load("plate");
  noonmark_verdict* verdict_ = nullptr;
};

TEST_F(CInterface, JudgesWhatTheTruthSays) {
  ASSERT_EQ(noonmark_scene_status(scene_), NOONMARK_OK) << noonmark_scene_message(scene_);
  const std::vector<float> black(width * height, 0);
  noonmark_frame frame = frame_of(black);
  frame.accept = "shaded,match,intensity";
  judge(&frame);
  ASSERT_EQ(noonmark_status(verdict_), NOONMARK_OK) << messages_of(verdict_);
  const float* truth = noonmark_truth(verdict_);
  const std::vector<float> exact(truth, truth + width * height);
  EXPECT_GT(noonmark_number(verdict_, "frame_acne"), 0.5) << "a black frame is too dark wherever there is light";
  int classes = 0;
  for (int i = 0; i < width * height; ++i) classes += noonmark_classes(verdict_)[i] == NOONMARK_ACNE;
  EXPECT_GT(classes, 10000);
  int32_t x = -1, y = -1;
  noonmark_worst_pixel(verdict_, &x, &y);
  EXPECT_GE(x, 0);
  EXPECT_GE(y, 0);

  frame = frame_of(exact);
  judge(&frame);
  EXPECT_EQ(noonmark_status(verdict_), NOONMARK_OK) << messages_of(verdict_);
  EXPECT_EQ(noonmark_number(verdict_, "frame_error"), 0);
  EXPECT_TRUE(std::isnan(noonmark_number(verdict_, "no such number")));
}

TEST_F(CInterface, AWrongDeliveryHasNoNumbers) {
  const std::vector<float> grey(width * height, 0.437f);  // no share of taps
  const noonmark_frame frame = frame_of(grey);
  judge(&frame);
  EXPECT_EQ(noonmark_status(verdict_), NOONMARK_BAD_FILE);
  EXPECT_NE(messages_of(verdict_).find("shaded FAILED"), std::string::npos) << messages_of(verdict_);
  EXPECT_TRUE(std::isnan(noonmark_number(verdict_, "frame_error")));
}

TEST_F(CInterface, NormalisedVisibilityIsTheRenderersOwn) {
  const std::vector<float> grey(width * height, 0.437f);
  noonmark_frame frame = frame_of(grey);
  frame.normalised = 1;
  judge(&frame);
  EXPECT_EQ(noonmark_status(verdict_), NOONMARK_OK);
  EXPECT_NE(messages_of(verdict_).find("shaded (accepted)"), std::string::npos) << messages_of(verdict_);
  frame.struct_size = offsetof(noonmark_frame, normalised);
  judge(&frame);
  EXPECT_EQ(noonmark_status(verdict_), NOONMARK_BAD_FILE) << "a program of the older header cannot set it";
}

TEST_F(CInterface, ASurfaceThatIsNotJudgedHasNoClass) {
  std::vector<float> values(width * height, 0);
  noonmark_frame frame = frame_of(values);
  judge(&frame);
  const double counted = noonmark_number(verdict_, "counted");
  values[width * height / 2 + width / 2] = -2;
  judge(&frame);
  EXPECT_EQ(noonmark_status(verdict_), NOONMARK_OK) << messages_of(verdict_);
  EXPECT_EQ(noonmark_number(verdict_, "counted"), counted - 1);
}

TEST_F(CInterface, WrongCallsAreSaid) {
  const std::vector<float> black(width * height, 0);
  judge(nullptr);
  EXPECT_EQ(noonmark_status(verdict_), NOONMARK_WRONG_CALL);
  noonmark_frame frame = frame_of(black);
  frame.visibility = nullptr;
  judge(&frame);
  EXPECT_EQ(noonmark_status(verdict_), NOONMARK_WRONG_CALL);
  frame = frame_of(black);
  frame.light_direction[0] = frame.light_direction[1] = 0;
  judge(&frame);
  EXPECT_NE(messages_of(verdict_).find("light_direction"), std::string::npos) << messages_of(verdict_);
  noonmark_frame unset;
  noonmark_frame_init(&unset, sizeof unset);
  EXPECT_EQ(unset.light_direction[1], 0) << "no light is taken for granted";
  frame = frame_of(black);
  frame.edge_pixels = -1;
  judge(&frame);
  EXPECT_NE(messages_of(verdict_).find("edge.pixels = -1"), std::string::npos) << messages_of(verdict_);
  frame = frame_of(black);
  std::memset(frame.clip_from_world, 0, sizeof frame.clip_from_world);
  judge(&frame);
  EXPECT_NE(messages_of(verdict_).find("no inverse"), std::string::npos) << messages_of(verdict_);
  frame = frame_of(black);
  frame.accept = "everything";
  judge(&frame);
  EXPECT_NE(messages_of(verdict_).find("there is no check 'everything'"), std::string::npos) << messages_of(verdict_);

  noonmark_scene* missing = noonmark_scene_load("missing.glb");
  EXPECT_EQ(noonmark_scene_status(missing), NOONMARK_BAD_FILE);
  EXPECT_NE(std::string(noonmark_scene_message(missing)).find("missing.glb"), std::string::npos);
  noonmark_verdict* verdict = noonmark_judge(missing, &frame);
  EXPECT_EQ(noonmark_status(verdict), NOONMARK_WRONG_CALL);
  noonmark_verdict_free(verdict);
  noonmark_scene_free(missing);
  EXPECT_EQ(noonmark_status(nullptr), NOONMARK_NO_DEVICE);
  EXPECT_EQ(noonmark_message(nullptr, 0), nullptr);
}

// Where the numbers of the struct are. A field that is missing here leaves a gap.
struct Field {
  const char* name;
  size_t offset, count, size;
  bool is_number;  // a double; others are integers that say yes or no, sizes and pointers
};
#define FIELD(name, count, ...) \
  { #name, offsetof(noonmark_frame, name), count, sizeof(noonmark_frame::name) / (count), __VA_ARGS__ }
const Field fields[] = {FIELD(struct_size, 1, false),   FIELD(width, 1, false),
                        FIELD(height, 1, false),        FIELD(visibility, 1, false),
                        FIELD(positions, 1, false),     FIELD(clip_from_world, 16, true),
                        FIELD(depth_0_to_1, 1, false),  FIELD(reversed, 1, false),
                        FIELD(y_down, 1, false),        FIELD(light_kind, 1, false),
                        FIELD(light_position, 3, true), FIELD(light_direction, 3, true),
                        FIELD(light_cone_deg, 1, true), FIELD(light_angular_diameter_deg, 1, true),
                        FIELD(light_radius_m, 1, true), FIELD(edge_pixels, 1, true),
                        FIELD(edge_m, 1, true),         FIELD(contact_m, 1, true),
                        FIELD(accept, 1, false),        FIELD(normalised, 1, false)};
#undef FIELD

// The call returns, whatever the numbers are: what cannot be is a wrong call that says which number it is, and no call is a
// defect of ours.
TEST_F(CInterface, NoNumberEndsTheProgram) {
  size_t known = 0;
  for (const Field& field : fields) {
    EXPECT_EQ(field.offset, known) << "a field before " << field.name << " is not tested";
    known = field.offset + field.count * field.size;
  }
  EXPECT_EQ(known, sizeof(noonmark_frame)) << "a field at the end is not tested";
  const double infinity = std::numeric_limits<double>::infinity();
  constexpr int small = 16;
  const std::vector<float> white(small * small, 1);
  std::map<std::string, int> taken, refused;
  for (const int kind : {NOONMARK_DIRECTIONAL, NOONMARK_SPOT, NOONMARK_POINT})
    for (const Field& field : fields)
      for (size_t i = 0; field.is_number && i < field.count; ++i)
        for (const double number : {0., -0., -1., 0.5, 1e-9, 4.9e-324, 1e9, -1e9, 1e15, 1e20, 1e38, 1e300, infinity,
                                    -infinity, std::nan("")}) {
          noonmark_frame frame = frame_of(white);
          frame.width = frame.height = small;
          frame.light_kind = kind;
          frame.light_position[1] = 5;
          frame.accept = "values,positions,alignment,coverage,inverted,shaded,intensity,match,encoding,levels";
          std::memcpy(reinterpret_cast<char*>(&frame) + field.offset + i * sizeof number, &number, sizeof number);
          judge(&frame);
          const int status = noonmark_status(verdict_);
          const std::string where =
              std::string(field.name) + "[" + std::to_string(i) + "] = " + std::to_string(number) + ": ";
          EXPECT_TRUE(status == NOONMARK_OK || status == NOONMARK_WRONG_CALL || status == NOONMARK_BAD_FILE)
              << where << status << " " << messages_of(verdict_);
          if (!std::isfinite(number) || std::abs(number) > 1e30) {
            EXPECT_EQ(status, NOONMARK_WRONG_CALL) << where << messages_of(verdict_);
          }
          ++(status == NOONMARK_WRONG_CALL ? refused : taken)[field.name];
          if (status == NOONMARK_OK) {
            EXPECT_GE(noonmark_number(verdict_, "frame_error"), 0) << where;
          }
        }
  for (const Field& field : fields) {
    if (!field.is_number) continue;
    EXPECT_GT(taken[field.name], 0) << field.name;
    EXPECT_GT(refused[field.name], 0) << field.name;
  }
}

TEST_F(CInterface, NumbersOutsideTheirRangesAreNamed) {
  const std::vector<float> white(width * height, 1);
  const auto says = [&](const auto& change, int kind = NOONMARK_SPOT) {
    noonmark_frame frame = frame_of(white);
    frame.light_kind = kind;
    change(frame);
    judge(&frame);
    EXPECT_EQ(noonmark_status(verdict_), NOONMARK_WRONG_CALL) << messages_of(verdict_);
    return messages_of(verdict_);
  };
  for (const auto& [message, name] : std::vector<std::pair<std::string, std::string>>{
           {says([](noonmark_frame& f) { f.light_cone_deg = 400; }), "light.cone_deg = 400"},
           {says([](noonmark_frame& f) { f.light_radius_m = -1; }), "light.radius = -1"},
           {says([](noonmark_frame& f) { f.light_radius_m = std::nan(""); }), "light.radius = nan"},
           {says([](noonmark_frame& f) { f.light_angular_diameter_deg = 1e9; }, NOONMARK_DIRECTIONAL),
            "light.angular_diameter_deg"},
           {says([](noonmark_frame& f) { f.light_position[0] = 1e20; }), "light.position"},
           {says([](noonmark_frame& f) { f.edge_m = 1e40; }), "edge.distance"},
           {says([](noonmark_frame& f) { f.contact_m = -1; }), "contact.distance"},
           {says([](noonmark_frame& f) { f.clip_from_world[5] = 1e300; }), "clip_from_world"}})
    EXPECT_NE(message.find(name), std::string::npos) << message << "\nwanted: " << name;
}

// Memory is asked for before the images are made.
TEST_F(CInterface, AFrameLargerThanMemoryIsSaid) {
  const float one = 1;
  noonmark_frame frame = frame_of({});
  frame.visibility = &one;  // never read
  frame.width = frame.height = std::numeric_limits<int32_t>::max();
  judge(&frame);
  EXPECT_EQ(noonmark_status(verdict_), NOONMARK_NO_DEVICE);
  EXPECT_NE(messages_of(verdict_).find("of memory, and"), std::string::npos) << messages_of(verdict_);
}

// A program of a newer header has more fields behind; they stay untouched.
TEST_F(CInterface, KnowsTheSizeOfTheCallersStruct) {
  const std::vector<float> black(width * height, 0);
  struct Newer {
    noonmark_frame frame;
    double more;
  } newer{{}, 7};
  noonmark_frame_init(&newer.frame, sizeof newer);
  EXPECT_EQ(newer.frame.struct_size, sizeof newer);
  EXPECT_EQ(newer.more, 0) << "a field that the library does not know has the default 0";
  EXPECT_EQ(newer.frame.edge_pixels, 2);
  const noonmark_frame plain = frame_of(black);
  const size_t size = newer.frame.struct_size;
  newer.frame = plain;
  newer.frame.struct_size = size;
  newer.frame.accept = "shaded,match,intensity";
  judge(&newer.frame);
  EXPECT_EQ(noonmark_status(verdict_), NOONMARK_OK) << messages_of(verdict_);
}

TEST(CInterfaceScene, OfTrianglesIsChecked) {
  const float positions[] = {-5, 0, -5, 5, 0, -5, 0, 0, 5};
  const uint32_t good[] = {0, 2, 1}, beyond[] = {0, 1, 3};
  noonmark_scene* scene = noonmark_scene_from_triangles(positions, 3, good, 1);
  EXPECT_EQ(noonmark_scene_status(scene), NOONMARK_OK) << noonmark_scene_message(scene);
  noonmark_scene_free(scene);
  scene = noonmark_scene_from_triangles(positions, 3, beyond, 1);
  EXPECT_EQ(noonmark_scene_status(scene), NOONMARK_WRONG_CALL);
  noonmark_scene_free(scene);
  const float infinite[] = {-5, 0, -5, 5, 0, -5, 0, INFINITY, 5};
  scene = noonmark_scene_from_triangles(infinite, 3, good, 1);
  EXPECT_NE(std::string(noonmark_scene_message(scene)).find("position 2"), std::string::npos);
  noonmark_scene_free(scene);
  const float far_away[] = {-5, 0, -5, 5, 0, -5, 0, 2e9f, 5};
  scene = noonmark_scene_from_triangles(far_away, 3, good, 1);
  EXPECT_NE(std::string(noonmark_scene_message(scene)).find("position 2"), std::string::npos);
  noonmark_scene_free(scene);
  const size_t endless = std::numeric_limits<size_t>::max();
  for (const auto& [vertices, triangles] : {std::pair(endless, size_t{1}), std::pair(size_t{3}, endless)}) {
    scene = noonmark_scene_from_triangles(positions, vertices, good, triangles);  // said before anything is read
    EXPECT_EQ(noonmark_scene_status(scene), NOONMARK_WRONG_CALL) << noonmark_scene_message(scene);
    noonmark_scene_free(scene);
  }
  EXPECT_EQ(noonmark_scene_status(nullptr), NOONMARK_WRONG_CALL);
}

}  // namespace
