// What a Renderer holds, for its own source files: renderer.cpp (life, scene), renderer_receivers.cpp,
// renderer_map.cpp (maps as engines draw them), renderer_map_data.cpp (uploaded and read back), renderer_lookup.cpp and
// renderer_probe.cpp.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "gl/egl_context.h"
#include "gl/gl_objects.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gl/renderer.h"
#include "technique/bias.h"

namespace noonmark::gl {

inline constexpr GLfloat lit_border[4] = {1, 1, 1, 1};

GLint gl_wrap(Wrap wrap);

struct ShadowMap::Impl {
  // Keeps the context, whose texture this is; a map may outlive its Renderer.
  std::shared_ptr<EglContext> context;
  Texture depth;
  int resolution = 0;
  bool cube = false;
  Wrap wrap = Wrap::clamp_to_border;

  Impl(std::shared_ptr<EglContext> owner, Texture texture, int side, bool is_cube, Wrap mode)
      : context(std::move(owner)), depth(std::move(texture)), resolution(side), cube(is_cube), wrap(mode) {}
  ~Impl();
};

// A texture that is kept from call to call while its size stays the same.
struct Target {
  Texture texture;
  GLenum format = 0;
  int width = 0, height = 0;
};

struct Box {
  glm::dvec3 low{0}, high{0};
};

struct Renderer::Impl {
  std::shared_ptr<EglContext> context;  // first, so that it dies last
  DeviceInfo info;
  std::optional<PassTimer> timer;
  ProgramCache programs;
  std::set<std::string> warm;  // passes that have run once, so that no driver's compiler is in their times

  VertexArray scene_vertices, no_vertices;
  Buffer positions, triangles;
  GLsizei index_count = 0;
  Box scene_box;  // of the positions

  Framebuffer framebuffer;
  Target primitive_colour, primitive_depth;
  Target position_image, normal_image;
  glm::vec3 eye_m{0};
  Target lit, map_strip;
  Target probe_scalars, probe_texels, probe_radius;
  Buffer tap_rows;
  Sampler comparing;   // of hardware comparison
  Texture cube_index;  // each texel's own place in the map's image, for cubes of ...
  int cube_index_resolution = 0;
  std::map<DepthFormat, double> polygon_offset_units;

  Impl(DebugMode debug, ShaderReplacements shaders);
  ~Impl();

  // Makes `target` of this format and size, if it is not already. Throws Error(device) when memory is short.
  void require(Target& target, GLenum format, int width, int height);
  void check_memory(const char* what, int width, int height);

  // Binds the framebuffer with these textures alone (colour i at location i) and sets the viewport.
  void draw_into(std::initializer_list<GLuint> colours, GLuint depth, int width, int height);
  // Ends draw_into: nothing stays attached, so that a deleted texture is not kept alive.
  void detach(size_t colours);

  void draw_scene(const Program& program);
  // depth_test: GL_NONE for none.
  void draw_screen(const Program& program, GLenum depth_test = GL_NONE);

  // Runs the pass; when time_ms is given, its time goes there, after one untimed run if `key` is not warm.
  void run(const std::string& key, double* time_ms, const std::function<void()>& pass);

  // Throw Error(usage) when the device, or its memory, has no such map.
  void check_resolution(int resolution, bool cube) const;
  Texture make_map_texture(GLenum format, int resolution, bool cube, Wrap wrap);

  // What light, bias and receiver need of a program that includes shaders/receiver.glsl; binds the receivers.
  void set_receiver_uniforms(Program& program, const LightFrame& frame, const Settings& settings);
  // Uploads and binds the pattern of a program that includes shaders/pattern.glsl.
  void set_pattern(Program& program, const TapPattern& pattern);
  // The texels that these taps of those rows' receivers read in a cube map: LookupProbe::cube_texel.
  struct Rows {
    int begin = 0, end = 0;
  };
  std::vector<uint32_t> cube_texels(const LookupProbe& probe, const LightFrame& frame, const Settings& settings,
                                    Rows rows, int tap_begin, int tap_end);
};

// The whole of level 0, row 0 first.
template <class T>
Image<T> read_back(const Target& target, GLenum format, GLenum type) {
  Image<T> image(target.width, target.height);
  glGetTextureImage(target.texture.id(), 0, format, type, static_cast<GLsizei>(image.size() * sizeof(T)),
                    image.pixels.data());
  return image;
}

}  // namespace noonmark::gl
