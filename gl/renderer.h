// gl/: the technique as OpenGL runs it. May include base, scenes and technique; raytrace and gl do not know each other, so
// that an error in one cannot hide in the other. OpenGL's types stay inside this folder. This is its only public header.
//
// The OpenGL side of the measurement: it draws shadow maps and looks them up as an engine does.
//
//   gl::Renderer renderer(gl::DebugMode::fatal);
//   renderer.load_scene(scene);
//   ReceiverImage receivers = resolve_receivers(scene, camera, renderer.render_primitives(camera, 1280, 720));
//   renderer.load_receivers(receivers, camera.eye_m);
//   gl::ShadowMap map = renderer.render_map(technique);
//   Image<float> r5 = renderer.lookup(map, technique);
//
// Conventions: scenes/scene.h. One Renderer owns one EGL context, which is current on the thread that made it. All
// calls must come from that thread. Throws Error(device) for drivers and shaders, with the shader's file and line.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/image.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"
#include "technique/evidence.h"
#include "technique/light_frame.h"
#include "technique/map_depths.h"
#include "technique/point_maps.h"
#include "technique/settings.h"
#include "technique/technique.h"

namespace noonmark::gl {

enum class DebugMode {
  off,
  log,    // driver messages of medium and high severity go to the log
  fatal,  // an error message from the driver throws Error(defect) at the next call; for tests
};

// Whole texts to use instead of GLSL files of the program, by file name ("shaders/compare.glsl"). With them a user can
// measure a variant of a shader, and a test can show that a defect in a shader is found. A replaced file must keep its
// interface, or it does not compile.
using ShaderReplacements = std::map<std::string, std::string>;

// The program's own text of a GLSL file, as the start of a variant. Throws Error(usage) if there is no such file.
std::string shader_file(const std::string& name);

// Where the times of passes come from.
enum class TimeSource {
  timer_query,  // the GPU's own clock
  process_cpu,  // CPU time of all threads of the process, with glFinish: a software renderer draws on these threads, and
                // its timer queries are wrong by orders of magnitude. Other programs do not lengthen it
  steady_clock,  // time of the wall with glFinish: a GPU without timer queries
};
const char* text_of(TimeSource source);  // "GPU timer queries"

struct DeviceInfo {
  std::string vendor, renderer, version, egl_platform;
  bool software = false;  // llvmpipe and other software renderers
  TimeSource times = TimeSource::steady_clock;
  int max_map_resolution = 0;
  int subpixel_bits = 0;  // a vertex moves to whole 1 / 2^bits of a texel before its triangle is drawn
};

// The taps whose texels a probe holds. The texel of the middle tap is always known.
enum class ProbeTaps { all, none };

// The shadow maps of a point on the device, counted from 0. Flat maps of one size are the layers of an
// array. Move-only.
class ShadowMap {
 public:
  ShadowMap(ShadowMap&&) noexcept;
  ShadowMap& operator=(ShadowMap&&) noexcept;
  ~ShadowMap();
  int count() const;
  glm::ivec2 size(int map = 0) const;  // texels of one of its faces
  size_t texels(int map = 0) const;    // of all its faces

 private:
  friend class Renderer;
  struct Impl;
  explicit ShadowMap(std::unique_ptr<Impl>);
  std::unique_ptr<Impl> impl_;
};

class Renderer {
 public:
  // Throws Error(usage) if a replaced file is not a file of the program.
  explicit Renderer(DebugMode debug, ShaderReplacements shaders = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  const DeviceInfo& info() const;

  // Uploads the scene's triangles. They replace those of the scene before.
  void load_scene(const Scene& scene);

  // For each pixel the index of the visible triangle, or no_primitive. unseen: the triangles that this camera does not
  // see, from unseen_backs() (scenes/receivers.h). The pixel shows what lies behind them. All other triangles are seen
  // from both sides.
  Image<uint32_t> render_primitives(const Camera& camera, int width, int height, std::span<const uint32_t> unseen = {});

  // Uploads P and N. eye_m is the position of the camera, for filters that grow with the view distance.
  // pixels: the pixel that each receiver has on the screen (row * width + column), for filters that are rotated by it;
  // null: its own, the place in the image.
  void load_receivers(const ReceiverImage& receivers, glm::dvec3 eye_m, const Image<uint32_t>* pixels = nullptr);

  // Frees what the passes over a picture keep on the device, some 45 bytes for each pixel: the receivers, and the images
  // that the passes draw into. load_receivers() comes again before the next lookup or probe.
  void release_receivers();

  // Renders the scene's depth from the light. Reads settings.map and the polygon offset of settings.bias; parts that
  // move the casters' vertices act through `casters_of` alone. time_ms, if given, receives the time of the pass alone
  // (DeviceInfo::times); the pass then runs twice, first without the clock, so that its shader is compiled, its memory is
  // in use and the caches hold what it reads. casters_of: the scene's vertices as they are drawn in a map
  // (technique/casters.h); empty: the vertices of load_scene().
  using CastersOf = std::function<std::vector<glm::vec3>(const Technique&)>;
  ShadowMap render_map(const Technique& technique, double* time_ms = nullptr, const CastersOf& casters_of = {});
  // The maps of a point, or some of them, each drawn by a pass of its own, bit for bit as render_map() draws it. time_ms: of all
  // passes.
  ShadowMap render_maps(std::span<const Technique> techniques, double* time_ms = nullptr,
                        const CastersOf& casters_of = {});

  // Uploads a map that was made elsewhere, such as the exact map of R4. Its format is 32-bit float depth, whatever
  // settings.format is; its wrap mode is the one of the settings. depth has the size LightFrame::map_size(), and
  // shape is LightFrame::map_shape(). Throws Error(defect) if the size is not that of the shape, and for NaN and depths
  // outside [0, 1], because OpenGL may clamp them.
  ShadowMap upload_map(const Image<float>& depth, const MapSettings& settings, MapShape shape = MapShape::flat);
  ShadowMap upload_map(const MapDepths& depths, const MapSettings& settings, MapShape shape = MapShape::flat);
  // The maps of these techniques, which are as of render_maps().
  ShadowMap upload_maps(std::span<const MapDepths* const> depths, std::span<const Technique> techniques);

  // The depths that the lookup's sampler returns, bit for bit, in the layout of LightFrame::map_size(): of all texels,
  // of those of a set, or of some rows. which: of the maps.
  Image<float> read_map(const ShadowMap& map, int which = 0);
  MapDepths read_map(const ShadowMap& map, const std::shared_ptr<const TexelSet>& texels, int which = 0);
  Image<float> read_rows(const ShadowMap& map, int first_row, int count, int which = 0);

  // How many texels of all its maps hold anything, that is a depth below 1. Counted on the device.
  int64_t used_texels(const ShadowMap& map);

  // Gives the memory of deleted maps back. Drivers keep a texture that was bound until the next draw, and until what
  // was drawn with it is done. The texture of a map that is gone may be spare, for the next one of its size and format:
  // release_spares() deletes these too.
  void release_deleted();
  void release_spares();

  // One unit of glPolygonOffset on this device, in window depth. It is measured by drawing with it. For 32-bit float it
  // is NaN, because the unit depends on the depth of the primitive.
  double polygon_offset_unit(DepthFormat format);

  // The technique's result: the visibility of every receiver, in [0, 1]. Background pixels and receivers at or behind
  // the light have 0. Of a lookup in a map of moments it makes that map first, if the last lookup was another one, and the
  // result is reduced already (lookup.reduction). time_ms: as in render_map, without the passes over the map. For filters that compare in hardware, OpenGL clamps the biased reference to [0, 1] if the format
  // of the map is fixed-point. So even with lit_beyond_far off, a receiver beyond far is lit where the map is empty.
  // Of one of several maps: 0 for receivers that are not looked up in it.
  Image<float> lookup(const ShadowMap& map, const Technique& technique, double* time_ms = nullptr);
  // The same in all maps of a point, in one pass: the shader chooses each receiver's map, and looks up the next one too
  // if it is blended in (or compared: MapChoice::seam). Of maps of different sizes, in one pass for each size.
  // techniques: those of the map, in its order. Throws Error(defect) if their frames are not of these sizes.
  MapResults lookup_maps(const ShadowMap& map, std::span<const Technique> techniques, double* time_ms = nullptr);

  // Of a lookup in a map of moments: what OpenGL made of this map, stage by stage. The texels are in the order of the set; the
  // channels that the lookup does not store are not defined.
  // techniques: as of lookup_maps(); which: of the maps.
  MomentEvidence read_moments(const ShadowMap& map, std::span<const Technique> techniques, const TexelSet& texels,
                              size_t which = 0);
  // The time of the passes that filter a map, as time_ms in render_map; empty if the lookup compares its depths. Of several
  // maps those of all; technique: any of them.
  std::optional<double> time_prefilter(const ShadowMap& map, const Technique& technique);

  // What the lookup chooses for each receiver. technique: of any of the maps.
  MapChoice choose_maps(const Technique& technique);

  // The numbers that lookup computes before it compares. They do not depend on the contents of the map. Of the bias,
  // they depend only on the parts that move the lookup.
  LookupProbe probe(const Technique& technique, ProbeTaps taps = ProbeTaps::all);
  // Of a flat map: the map_texels of probe() alone.
  Image<glm::vec2> map_positions(const Technique& technique);

  // Replaces the taps that the probe holds by those of these pixels, which are whole rows of the picture. This is
  // needed for a cube only, because there the sampler chooses the texel of each tap. For a flat map every tap is known,
  // and this function does nothing.
  void probe_strip(LookupProbe& probe, const Technique& technique, PixelRange strip);

  // Frees what the probes of a cube keep on the device: 4 bytes for each texel of the cube. The next probe makes it
  // again.
  void forget_cube_index();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Bytes of a map of so many texels on the device, of depths: the texture, and while it comes and goes its bands. kept: it stays
// for the next lookup; then the exact map and the tie map are beside it, and of a cube the texture with which it is probed. The
// measured bytes of a texel (VmHWM of runs of which the map takes most, Debian 12 with llvmpipe) stand in renderer_map_data.cpp.
double map_bytes(double texels, bool kept, bool cube);
// The same of the two textures of moments of a map, with all mip levels, and of what is read back of the texels that taps read
// and of each pixel. settings: of a lookup that reads moments.
double moment_bytes(const Settings& settings, double texels, double asked, double pixels);

}  // namespace noonmark::gl
