// The OpenGL context: its errors, and how long it lives.
#include <epoxy/gl.h>

#include <cstdlib>
#include <thread>

#include "base/error.h"
#include "gl/egl_context.h"
#include "scenes/receivers.h"
#include "tests/gl/fixture.h"

namespace noonmark::gl {
namespace {

TEST_F(GlTest, InfoNamesAUsableDevice) {
  const DeviceInfo& info = renderer.info();
  EXPECT_FALSE(info.vendor.empty());
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_GE(info.version.substr(0, 3), "4.5");
  EXPECT_TRUE(info.egl_platform == "surfaceless" || info.egl_platform.starts_with("device"));
  EXPECT_GE(info.max_map_resolution, 8192);  // OpenGL 4.5 asks for 16384; the tool's own default is far below both
  EXPECT_EQ(info.software, info.renderer.find("llvmpipe") != std::string::npos);
  EXPECT_EQ(info.software, info.times == TimeSource::process_cpu)
      << "the timer queries of a software renderer are wrong";
}

// Two renderers at once, and one after the other. EGL gives every context of a device the same display.
TEST(GlLife, RenderersComeAndGo) {
  Scene scene;
  add_floor(scene, 0, 1);
  auto first = std::make_unique<Renderer>(DebugMode::fatal);
  auto second = std::make_unique<Renderer>(DebugMode::fatal);
  first->load_scene(scene);
  EXPECT_EQ(second->render_primitives(camera_from_above(1), 4, 4).at(2, 2), no_primitive)
      << "no scene was loaded into this renderer";
  EXPECT_NE(first->render_primitives(camera_from_above(1), 4, 4).at(2, 2), no_primitive);
  first.reset();
  second->load_scene(scene);
  EXPECT_NE(second->render_primitives(camera_from_above(1), 4, 4).at(2, 2), no_primitive);
  second.reset();
  Renderer third(DebugMode::fatal);
  third.load_scene(scene);
  EXPECT_NE(third.render_primitives(camera_from_above(1), 4, 4).at(2, 2), no_primitive);
}

TEST(GlLife, AMapMayOutliveItsRenderer) {
  Settings settings;
  settings.map.resolution = 4;
  auto owner = std::make_unique<Renderer>(DebugMode::fatal);
  ShadowMap map = owner->upload_map(Image<float>(4, 4, 0.5f), settings.map);
  owner.reset();
  Renderer other(DebugMode::fatal);
  ShadowMap kept = other.upload_map(Image<float>(4, 4, 0.25f), settings.map);
  { ShadowMap gone = std::move(map); }  // must not delete the second context's texture of the same number
  EXPECT_EQ(other.read_map(kept).at(0, 0), 0.25f);
}

TEST(GlLife, AnotherThreadIsRefused) {
  Renderer renderer(DebugMode::fatal);
  int kind = 0;
  std::thread([&] { kind = kind_thrown([&] { renderer.load_scene(Scene{}); }); }).join();
  EXPECT_EQ(kind, static_cast<int>(ErrorKind::defect));
}

// The number of live objects in the current context. Drivers number objects from 1, without large gaps.
int live_objects() {
  int live = 0;
  for (GLuint id = 1; id < 4096; ++id)
    live += glIsTexture(id) + glIsBuffer(id) + glIsFramebuffer(id) + glIsVertexArray(id) + glIsProgram(id) +
            glIsShader(id) + glIsQuery(id);
  return live;
}

TEST(GlLife, CallsLeaveNothingBehind) {
  Renderer renderer(DebugMode::fatal);
  Scene scene;
  scene.light = light_from_above();
  scene.camera = camera_from_above(4);
  add_floor(scene, 0, 4);
  Settings settings;
  settings.map.resolution = 16;
  settings.filter.kind = "box";
  const LightFrame frame = make_light_frame(scene, settings);
  const auto everything = [&](int width) {
    renderer.load_scene(scene);
    const auto primitives = renderer.render_primitives(scene.camera, width, 8);
    renderer.load_receivers(resolve_receivers(scene, scene.camera, primitives), frame.direction_to_light());
    double ms = 0;
    const ShadowMap map = renderer.render_map({settings, frame}, &ms);
    const ShadowMap copy = renderer.upload_map(renderer.read_map(map), settings.map);
    renderer.lookup(copy, {settings, frame}, &ms);
    renderer.probe({settings, frame});
  };
  everything(8);
  const int before = live_objects();
  EXPECT_GT(before, 10) << "there must be textures, buffers and programs";
  for (int k = 0; k < 50; ++k) everything(8 + k % 3);
  EXPECT_EQ(live_objects(), before);
}

// The debug callback only stores an error; the next check throws it.
TEST(GlErrors, AreFatalInTests) {
  EglContext context(DebugMode::fatal);
  EXPECT_EQ(kind_thrown([&] { context.check("nothing"); }), 0);
  glEnable(GL_TEXTURE_2D + 12345);
  std::string message;
  EXPECT_EQ(kind_thrown([&] { context.check("a test"); }, &message), static_cast<int>(ErrorKind::defect));
  EXPECT_NE(message.find("a test"), std::string::npos) << message;
  EXPECT_EQ(kind_thrown([&] { context.check("later"); }), 0) << "an error is thrown only once";
}

TEST(GlErrors, AreSeenWithoutTheDebugCallback) {
  EglContext context(DebugMode::off);
  glEnable(GL_TEXTURE_2D + 12345);
  std::string message;
  EXPECT_EQ(kind_thrown([&] { context.check("a test"); }, &message), static_cast<int>(ErrorKind::device));
  EXPECT_NE(message.find("GL_INVALID_ENUM"), std::string::npos) << message;
}

void make_renderer_and_report() {
  std::string message;
  const int kind = kind_thrown([] { Renderer renderer(DebugMode::off); }, &message);
  fputs(message.c_str(), stderr);
  std::exit(kind);
}

// In a separate process, because EGL chooses its vendors once per process.
TEST(GlErrorsDeathTest, NoDriverSaysWhatToInstall) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
  EXPECT_EXIT(make_renderer_and_report(), testing::ExitedWithCode(static_cast<int>(ErrorKind::device)),
              "apt install .*libegl-mesa0");
  unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
}

}  // namespace
}  // namespace noonmark::gl
