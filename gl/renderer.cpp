#include "gl/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

#include "base/error.h"
#include "gl/renderer_impl.h"

namespace noonmark::gl {
namespace {

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text ? text : "unknown";
}

GLint gl_integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

bool names_software(std::string renderer) {
  std::transform(renderer.begin(), renderer.end(), renderer.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "swr ", "swiftshader", "software"})
    if (renderer.find(name) != renderer.npos) return true;
  return false;
}

DeviceInfo describe(const EglContext& context) {
  DeviceInfo info;
  info.vendor = gl_string(GL_VENDOR);
  info.renderer = gl_string(GL_RENDERER);
  info.version = gl_string(GL_VERSION);
  info.egl_platform = context.platform();
  info.software = names_software(info.renderer);
  GLint bits = 0;
  glGetQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &bits);
  info.times = info.software ? TimeSource::process_cpu : bits > 0 ? TimeSource::timer_query : TimeSource::steady_clock;
  std::array<GLint, 2> viewport{};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  info.max_map_resolution = std::min({gl_integer(GL_MAX_TEXTURE_SIZE), gl_integer(GL_MAX_FRAMEBUFFER_WIDTH),
                                      gl_integer(GL_MAX_FRAMEBUFFER_HEIGHT), viewport[0], viewport[1]});
  info.subpixel_bits = gl_integer(GL_SUBPIXEL_BITS);
  return info;
}

}  // namespace

Renderer::Impl::Impl(DebugMode debug, ShaderReplacements shaders)
    : context(std::make_shared<EglContext>(debug)), programs(std::move(shaders)) {
  info = describe(*context);
  timer.emplace(info.times);
  scene_vertices = make_vertex_array();
  no_vertices = make_vertex_array();
  framebuffer = make_framebuffer();
  comparing = make_sampler();
  glSamplerParameteri(comparing.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glSamplerParameteri(comparing.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glSamplerParameteri(comparing.id(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glSamplerParameteri(comparing.id(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);  // a tie is lit
  glSamplerParameterfv(comparing.id(), GL_TEXTURE_BORDER_COLOR, lit_border);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glDisable(GL_DITHER);
  context->check("Renderer");
}

// Ends the program if the context is current on another thread, because the deletions would then act on the objects of
// another context.
Renderer::Impl::~Impl() { context->make_current(); }

void Renderer::Impl::check_memory(const char* what, int width, int height) {
  if (glGetError() != GL_OUT_OF_MEMORY) return;
  context->forget_errors();
  throw Error(ErrorKind::device,
              fmt::format("the OpenGL device has no memory for {} of {} x {}; lower map.resolution or "
                          "the picture's size",
                          what, width, height));
}

void Renderer::Impl::require(Target& target, GLenum format, int width, int height) {
  if (target.texture && target.format == format && target.width == width && target.height == height) return;
  target = Target{};  // first, so that memory never holds both
  Texture texture = make_texture(format, width, height);
  check_memory("an image", width, height);
  target = Target{std::move(texture), format, width, height};
}

void Renderer::Impl::draw_into_layer(GLuint depth, int layer, glm::ivec2 size) {
  draw_into({}, depth, size.x, size.y);
  glNamedFramebufferTextureLayer(framebuffer.id(), GL_DEPTH_ATTACHMENT, depth, 0, layer);
}

void Renderer::Impl::draw_into_colour_layer(GLuint colour, int layer, glm::ivec2 size) {
  draw_into({colour}, 0, size.x, size.y);
  glNamedFramebufferTextureLayer(framebuffer.id(), GL_COLOR_ATTACHMENT0, colour, 0, layer);
}

void Renderer::Impl::draw_into(std::initializer_list<GLuint> colours, GLuint depth, int width, int height) {
  std::array<GLenum, 4> buffers{};
  GLsizei count = 0;
  for (GLuint colour : colours) {
    buffers[static_cast<size_t>(count)] = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(count);
    glNamedFramebufferTexture(framebuffer.id(), buffers[static_cast<size_t>(count)], colour, 0);
    ++count;
  }
  glNamedFramebufferTexture(framebuffer.id(), GL_DEPTH_ATTACHMENT, depth, 0);
  if (count)
    glNamedFramebufferDrawBuffers(framebuffer.id(), count, buffers.data());
  else
    glNamedFramebufferDrawBuffer(framebuffer.id(), GL_NONE);
  const GLenum status = glCheckNamedFramebufferStatus(framebuffer.id(), GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw Error(ErrorKind::device,
                fmt::format("the OpenGL driver cannot draw into a framebuffer of {} colour and {} depth "
                            "images (status 0x{:x}); noonmark doctor shows the driver",
                            count, depth ? 1 : 0, status));
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glViewport(0, 0, width, height);
}

void Renderer::Impl::detach(size_t colours) {
  for (size_t i = 0; i < colours; ++i)
    glNamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i), 0, 0);
  glNamedFramebufferTexture(framebuffer.id(), GL_DEPTH_ATTACHMENT, 0, 0);
}

void Renderer::Impl::draw_scene(const Program& program) {
  if (index_count == 0) return;
  glUseProgram(program.id());
  glBindVertexArray(scene_vertices.id());
  glDrawElements(GL_TRIANGLES, index_count, GL_UNSIGNED_INT, nullptr);
  glUseProgram(0);
}

void Renderer::Impl::draw_screen(const Program& program, GLenum depth_test, bool writes_depth) {
  if (depth_test == GL_NONE) {
    glDisable(GL_DEPTH_TEST);
  } else {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(depth_test);
    glDepthMask(writes_depth ? GL_TRUE : GL_FALSE);
  }
  glDisable(GL_CULL_FACE);
  glUseProgram(program.id());
  glBindVertexArray(no_vertices.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);  // clears need it
  // A driver judges the current program with the textures that are bound then, also where only a clear follows.
  glUseProgram(0);
}

const char* text_of(TimeSource source) {
  switch (source) {
    case TimeSource::timer_query:
      return "GPU timer queries";
    case TimeSource::process_cpu:
      return "CPU time of the process";
    case TimeSource::steady_clock:
      break;
  }
  return "a steady clock and glFinish";
}

void Renderer::Impl::run(double* time_ms, const std::function<void()>& pass) {
  pass();
  if (time_ms) *time_ms = timer->measure(pass);
}

Renderer::Renderer(DebugMode debug, ShaderReplacements shaders)
    : impl_(std::make_unique<Impl>(debug, std::move(shaders))) {}
Renderer::~Renderer() = default;

const DeviceInfo& Renderer::info() const { return impl_->info; }

void Renderer::load_scene(const Scene& scene) {
  Impl& r = *impl_;
  r.context->make_current();
  if (scene.triangles.size() > static_cast<size_t>(std::numeric_limits<GLsizei>::max()) / 3)
    throw Error(ErrorKind::file,
                fmt::format("the scene '{}' has {} triangles; OpenGL draws at most {} at once", scene.name,
                            scene.triangles.size(), std::numeric_limits<GLsizei>::max() / 3));
  r.index_count = 0;
  r.positions = {};
  r.triangles = {};
  r.positions = make_buffer(scene.positions.data(), scene.positions.size() * sizeof(glm::vec3));
  r.triangles = make_buffer(scene.triangles.data(), scene.triangles.size() * sizeof(glm::uvec3));
  const GLuint vao = r.scene_vertices.id();
  glVertexArrayVertexBuffer(vao, 0, r.positions.id(), 0, sizeof(glm::vec3));
  glVertexArrayElementBuffer(vao, r.triangles.id());
  glEnableVertexArrayAttrib(vao, 0);
  glVertexArrayAttribFormat(vao, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(vao, 0, 0);
  r.scene_box = {};
  if (!scene.positions.empty()) r.scene_box = {scene.positions.front(), scene.positions.front()};
  for (const glm::dvec3 p : scene.positions) {
    r.scene_box.low = glm::min(r.scene_box.low, p);
    r.scene_box.high = glm::max(r.scene_box.high, p);
  }
  r.context->check("load_scene");
  r.index_count = static_cast<GLsizei>(3 * scene.triangles.size());
}

// The textures themselves are made by Renderer::Impl::make_flat().
ShadowMap::Impl::Impl(std::shared_ptr<EglContext> owner, const std::shared_ptr<SpareMaps>& ends_in, Wrap mode,
                      std::span<const glm::ivec2> sizes)
    : context(std::move(owner)), wrap(mode), spares(ends_in) {
  // Mesa's software renderers make no larger texture, and OpenGL names no limit.
  constexpr size_t most_array_bytes = size_t{1} << 30;
  for (const glm::ivec2 size : sizes) {
    const size_t layer_bytes = static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * sizeof(float);
    const auto has_room = [&](const TiledMaps& array) {
      return glm::ivec2(array.size) == size && static_cast<size_t>(array.size.z + 1) * layer_bytes <= most_array_bytes;
    };
    auto array = std::find_if(arrays.begin(), arrays.end(), has_room);
    if (array == arrays.end()) array = arrays.insert(arrays.end(), TiledMaps{{}, 0, glm::ivec3(size, 0)});
    places.push_back({static_cast<size_t>(array - arrays.begin()), array->size.z++});
  }
}

ShadowMap::Impl::~Impl() {
  context->make_current();
  if (const auto kept = spares.lock())
    for (TiledMaps& array : arrays) kept->put(std::move(array));
}

ShadowMap::ShadowMap(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ShadowMap::ShadowMap(ShadowMap&&) noexcept = default;
ShadowMap& ShadowMap::operator=(ShadowMap&&) noexcept = default;
ShadowMap::~ShadowMap() = default;
int ShadowMap::count() const { return impl_->cube ? 1 : static_cast<int>(impl_->places.size()); }
glm::ivec2 ShadowMap::size(int map) const {
  return impl_->cube ? glm::ivec2(impl_->cube_side) : glm::ivec2(impl_->array_of(map).size);
}
size_t ShadowMap::texels(int map) const {
  const glm::ivec2 face = size(map);
  return static_cast<size_t>(impl_->faces()) * static_cast<size_t>(face.x) * static_cast<size_t>(face.y);
}

}  // namespace noonmark::gl
