// The members of a Renderer, for its own source files: renderer.cpp (construction, scene), renderer_receivers.cpp,
// renderer_map.cpp (maps drawn as engines draw them), renderer_map_data.cpp (maps uploaded and read back),
// renderer_map_tiles.cpp (flat maps, at some of their texels), renderer_prefilter.cpp (maps of moments),
// renderer_lookup.cpp and renderer_probe.cpp.
#pragma once
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gl/egl_context.h"
#include "gl/gl_objects.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gl/renderer.h"
#include "gl/spare_maps.h"
#include "technique/bias.h"

namespace noonmark::gl {

inline constexpr GLfloat lit_border[4] = {1, 1, 1, 1};

GLint gl_wrap(Wrap wrap);

// The textures of an array of maps of moments: what its texels store, blurred along u, and blurred along v too, which the lookup reads.
struct MomentTextures {
  std::string key;  // of the settings that they depend on
  // What the texels store; lookup.level halvings of it; after the first pass of the blur; after both.
  std::vector<Texture> passes;
};

struct ShadowMap::Impl {
  // Keeps the context alive, because the textures belong to it. A map may exist longer than its Renderer.
  std::shared_ptr<EglContext> context;
  Wrap wrap = Wrap::clamp_to_border;
  Texture cube{};  // of a point light; it has no arrays then
  int cube_side = 0;
  std::vector<TiledMaps> arrays{};  // flat maps, by size
  struct Place {
    size_t array = 0;
    int layer = 0;
  };
  std::vector<Place> places{};            // of each flat map
  std::weak_ptr<SpareMaps> spares{};      // where the arrays go in the end
  std::vector<MomentTextures> moments{};  // one for each array: those of the last lookup that read moments

  // Flat maps of these sizes, which are empty yet.
  Impl(std::shared_ptr<EglContext> owner, const std::shared_ptr<SpareMaps>& ends_in, Wrap mode,
       std::span<const glm::ivec2> sizes);
  Impl(std::shared_ptr<EglContext> owner, Texture texture, int side)
      : context(std::move(owner)), cube(std::move(texture)), cube_side(side) {}
  ~Impl();

  TiledMaps& array_of(int map) { return arrays[places[static_cast<size_t>(map)].array]; }
  int layer_of(int map) const { return places[static_cast<size_t>(map)].layer; }
  int faces() const { return cube ? 6 : 1; }
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
  std::shared_ptr<EglContext> context;  // the first member, so that it is destroyed last
  DeviceInfo info;
  std::optional<PassTimer> timer;
  ProgramCache programs;

  VertexArray scene_vertices, no_vertices;
  Buffer positions, triangles;
  GLsizei index_count = 0;
  Box scene_box;  // the box around the positions

  Framebuffer framebuffer;
  Target primitive_colour, primitive_depth;
  Target position_image, normal_image;
  glm::vec3 eye_m{0};
  Target lit, fetched, map_strip, listed_texels, listed_depths;
  // Two uploaded ones: an exact map and a tie map come by turns. Shared, because a map may exist longer.
  std::shared_ptr<SpareMaps> large = std::make_shared<SpareMaps>(1, SpareMaps::no_limit),
                             uploaded = std::make_shared<SpareMaps>(2, SpareMaps::most_small_bytes, large),
                             drawn = std::make_shared<SpareMaps>(1, SpareMaps::most_small_bytes, large);
  Target probe_scalars, probe_texels, probe_radius;
  Buffer tap_rows;
  Sampler comparing;   // for hardware comparison
  Texture cube_index;  // each texel holds its own place in the map's image; for cubes of ...
  int cube_index_resolution = 0;
  std::map<DepthFormat, double> polygon_offset_units;

  Impl(DebugMode debug, ShaderReplacements shaders);
  ~Impl();

  // Gives `target` this format and size, if it does not have them already. Throws Error(device) if memory is short.
  void require(Target& target, GLenum format, int width, int height);
  void check_memory(const char* what, int width, int height);

  // Binds the framebuffer with only these textures (colour i at location i) and sets the viewport. A depth texture of
  // several layers has all of them bound; draw_into_layer() binds one.
  void draw_into(std::initializer_list<GLuint> colours, GLuint depth, int width, int height);
  void draw_into_layer(GLuint depth, int layer, glm::ivec2 size);
  void draw_into_colour_layer(GLuint colour, int layer, glm::ivec2 size);
  // Ends draw_into. It detaches all textures, because an attached texture stays in memory after it is deleted.
  void detach(size_t colours);
  // renderer_probe.cpp has it and its callers.
  template <class Read>
  void each_probed_band(const Technique& technique, const Read& read);

  void draw_scene(const Program& program);
  // depth_test: GL_NONE means no test.
  void draw_screen(const Program& program, GLenum depth_test = GL_NONE, bool writes_depth = true);

  // Runs the pass. If time_ms is given, the pass runs twice, and time_ms receives the time of the second run.
  void run(double* time_ms, const std::function<void()>& pass);

  Texture draw_cube(const Technique& technique, double* time_ms);
  // Draws a layer of a flat map. apart: the texture in which the cells of a snapped map are drawn, kept from layer to
  // layer.
  void draw_layer(const Technique& technique, const TiledMaps& map, int layer, Texture& apart, double* time_ms);
  void draw_cells(Program& program, const LightFrame& frame, const TiledMaps& map, int layer, Texture& apart);

  // Throw Error(usage) if the device or its memory does not allow such maps. size: texels of a layer, and layers; of a
  // cube 6 faces.
  void check_map_size(glm::ivec2 size, bool cube) const;
  Texture make_map_texture(GLenum format, glm::ivec3 size, bool cube, Wrap wrap);
  // Flat maps of these sizes, in spare textures or new ones. ends_in: null for maps that are no spares afterwards.
  // keep_spares_of: deletes the spare maps of other sizes. A large one that is deleted gives its memory back before a new
  // texture is made (release_deleted), so that never both take memory.
  std::unique_ptr<ShadowMap::Impl> make_flat(const std::shared_ptr<SpareMaps>& ends_in, GLenum format,
                                             std::span<const glm::ivec2> sizes, Wrap wrap);
  void keep_spares_of(glm::ivec2 size);
  void release_deleted();
  // The wrap mode and what else the lookup's sampler needs to know of a map.
  static void set_sampling(const Texture& map, bool cube, Wrap wrap);
  // Writes faces, or a layer of a flat map, of 32-bit floats. copy_row(y, row) writes row y of the map's image.
  void upload_rows(GLuint texture, glm::ivec2 face, int first_layer, int faces,
                   const std::function<void(int, float*)>& copy_row);
  ShadowMap upload_cube(int side, const std::function<void(int, float*)>& copy_row);
  // Writes a layer of a flat map. elsewhere: the depth of the texels that are not in the set, in [0, 1].
  void upload_tiles(const MapDepths& map, float elsewhere, TiledMaps& to, int layer);
  // The same of listed texels alone; places: the column in the low 16 bits, the row in the high ones.
  void write_listed(const TiledMaps& to, int layer, std::span<const uint32_t> places, std::span<const float> depths);
  // The depths of a layer of a flat map at the texels of the set, by TexelSet::index. Throws Error(device).
  void read_listed(GLuint map, int layer, const TexelSet& texels, std::span<float> depth);

  // Sets the uniforms of light, bias and receiver in a program that includes shaders/receiver.glsl, and binds the
  // receivers. maps: those of the layers that are looked up, in their order.
  void set_receiver_uniforms(Program& program, std::span<const Technique* const> maps);
  void set_receiver_uniforms(Program& program, const Technique& technique) {
    const Technique* const one = &technique;
    set_receiver_uniforms(program, std::span(&one, 1));
  }
  // The moments of all maps, as this lookup reads them: those that the map has already, or new ones. time_ms: as of run(); the
  // passes are then done anyway.
  const std::vector<MomentTextures>& moments_of(const ShadowMap& map, const Technique& technique, double* time_ms);
  // Uploads and binds the pattern for a program that includes shaders/pattern.glsl.
  void set_pattern(Program& program, const TapPattern& pattern);
  // The texels in a cube map that these taps of the receivers in those rows read: LookupProbe::cube_texel.
  struct Rows {
    int begin = 0, end = 0;
  };
  std::vector<uint32_t> cube_texels(const LookupProbe& probe, const Technique& technique, Rows rows, int tap_begin,
                                    int tap_end);
};

// Reads all of level 0, beginning with row 0.
template <class T>
Image<T> read_back(const Target& target, GLenum format, GLenum type) {
  Image<T> image(target.width, target.height);
  glGetTextureImage(target.texture.id(), 0, format, type, static_cast<GLsizei>(image.size() * sizeof(T)),
                    image.pixels.data());
  return image;
}

}  // namespace noonmark::gl
