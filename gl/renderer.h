// The OpenGL side of the measurement: shadow maps and lookups as an engine would make them.
//
//   gl::Renderer renderer(gl::DebugMode::fatal);
//   renderer.load_scene(scene);
//   ReceiverImage receivers = resolve_receivers(scene, camera, renderer.render_primitives(camera, 1280, 720));
//   renderer.load_receivers(receivers, camera.eye_m);
//   gl::ShadowMap map = renderer.render_map(frame, settings);
//   Image<float> r5 = renderer.lookup(map, frame, settings);
//
// Conventions: scenes/scene.h. One Renderer owns one EGL context, current on the thread that made it; all calls come
// from that thread. Throws Error(device) for drivers and shaders (with the shader's file and line).
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "scenes/image.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"
#include "technique/evidence.h"
#include "technique/light_frame.h"
#include "technique/settings.h"

namespace noonmark::gl {

enum class DebugMode {
  off,
  log,    // driver messages of medium and high severity go to the log
  fatal,  // an error message from the driver throws Error(defect) at the next call; for tests
};

// Whole texts that stand in for GLSL files of the program, by name ("shaders/compare.glsl"): to measure one's own
// variant of a shader, and to prove that a defect in one shows. What is replaced keeps its interface, or does not
// compile.
using ShaderReplacements = std::map<std::string, std::string>;

// The program's own text of a GLSL file, to make a variant from. Throws Error(usage) where there is no such file.
std::string shader_file(const std::string& name);

struct DeviceInfo {
  std::string vendor, renderer, version, egl_platform;
  bool software = false;       // llvmpipe and its kin
  bool timer_queries = false;  // whether times come from GPU timer queries, or from glFinish and a steady clock
  int max_map_resolution = 0;
};

// Which taps a probe knows the texels of; the middle one always.
enum class ProbeTaps { all, none };

// A shadow map on the device. Move-only.
class ShadowMap {
 public:
  ShadowMap(ShadowMap&&) noexcept;
  ShadowMap& operator=(ShadowMap&&) noexcept;
  ~ShadowMap();
  int resolution() const;

 private:
  friend class Renderer;
  struct Impl;
  explicit ShadowMap(std::unique_ptr<Impl>);
  std::unique_ptr<Impl> impl_;
};

class Renderer {
 public:
  // Throws Error(usage) when a replaced file is none of the program's.
  explicit Renderer(DebugMode debug, ShaderReplacements shaders = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  const DeviceInfo& info() const;

  // Uploads the scene's triangles; replaces any scene before it.
  void load_scene(const Scene& scene);

  // For each pixel the index of the visible triangle, or no_primitive. unseen: the triangles that this camera looks
  // through, as unseen_backs() has them (scenes/receivers.h); the others are seen from both sides.
  Image<uint32_t> render_primitives(const Camera& camera, int width, int height, std::span<const uint32_t> unseen = {});

  // Uploads P and N. eye_m: the camera, for filters that grow with the view distance.
  void load_receivers(const ReceiverImage& receivers, glm::dvec3 eye_m);

  // Renders the scene's depth from the light. Reads settings.map and the polygon offset of settings.bias; parts that move
  // the casters' vertices act through `casters` alone.
  // time_ms, when given, gets the pass's own time (device or glFinish clock).
  // casters: the scene's vertices as they are drawn (technique/casters.h); empty: as load_scene() has them.
  ShadowMap render_map(const LightFrame& frame, const Settings& settings, double* time_ms = nullptr,
                       std::span<const glm::vec3> casters = {});

  // A map made elsewhere (R4's exact one): 32-bit float depth whatever settings.format says, wrap as settings has it.
  // depth: of LightFrame::map_size(); six times as high as wide it is a cube.
  // Throws Error(defect) for depths outside [0,1] and for NaN: OpenGL may clamp them.
  ShadowMap upload_map(const Image<float>& depth, const MapSettings& settings);

  // The depths as the lookup's sampler returns them, bit for bit; laid out as LightFrame::map_size() says.
  Image<float> read_map(const ShadowMap& map);

  // What one unit of glPolygonOffset is on this device, in window depth, measured by drawing with it; of 32-bit float,
  // whose unit depends on the primitive's depth, NaN.
  double polygon_offset_unit(DepthFormat format);

  // The technique: for every receiver its visibility in [0,1]. Background pixels, and those at or behind the light: 0.
  // Of filters that compare in hardware OpenGL clamps the biased reference to [0,1] where the map's format is a fixed-
  // point one: with lit_beyond_far off, what lies beyond far is still lit where the map is empty.
  Image<float> lookup(const ShadowMap& map, const LightFrame& frame, const Settings& settings,
                      double* time_ms = nullptr);

  // What lookup computes before it compares. Independent of the map's contents and of the bias, but for parts that move
  // the lookup.
  LookupProbe probe(const LightFrame& frame, const Settings& settings, ProbeTaps taps = ProbeTaps::all);

  // Puts these pixels' taps, whole rows of the picture, in the place of those that the probe holds. Only a cube's
  // sampler chooses the texel of each tap: of a flat map every tap is known, and this does nothing.
  void probe_strip(LookupProbe& probe, const LightFrame& frame, const Settings& settings, PixelRange strip);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace noonmark::gl
