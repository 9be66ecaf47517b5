// Move-only owners of OpenGL objects. The context that made an object must be current when the object is destroyed.
#pragma once
#include <epoxy/gl.h>

#include <glm/glm.hpp>
#include <utility>

namespace noonmark::gl {

template <class Kind>
class Owned {
 public:
  Owned() = default;  // owns nothing
  explicit Owned(GLuint id) : id_(id) {}
  Owned(Owned&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Owned() {
    if (id_) Kind::destroy(id_);
  }
  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 private:
  GLuint id_ = 0;
};

struct TextureKind {
  static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};
struct BufferKind {
  static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};
struct FramebufferKind {
  static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};
struct VertexArrayKind {
  static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};
struct SamplerKind {
  static void destroy(GLuint id) { glDeleteSamplers(1, &id); }
};
struct QueryKind {
  static void destroy(GLuint id) { glDeleteQueries(1, &id); }
};
struct ShaderKind {
  static void destroy(GLuint id) { glDeleteShader(id); }
};
struct ProgramKind {
  static void destroy(GLuint id) { glDeleteProgram(id); }
};

using Texture = Owned<TextureKind>;
using Buffer = Owned<BufferKind>;
using Framebuffer = Owned<FramebufferKind>;
using VertexArray = Owned<VertexArrayKind>;
using Sampler = Owned<SamplerKind>;
using Query = Owned<QueryKind>;
using Shader = Owned<ShaderKind>;
using ProgramObject = Owned<ProgramKind>;

// A 2D texture or a cube map with one level and nearest filtering. Its contents are undefined. The caller must check
// for GL_OUT_OF_MEMORY.
inline Texture make_texture(GLenum format, int width, int height, GLenum target = GL_TEXTURE_2D) {
  GLuint id = 0;
  glCreateTextures(target, 1, &id);
  glTextureStorage2D(id, 1, format, width, height);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return Texture(id);
}

// 2D textures of one size as the layers of an array, as make_texture().
inline Texture make_array(GLenum format, glm::ivec3 size) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
  glTextureStorage3D(id, 1, format, size.x, size.y, size.z);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return Texture(id);
}

// The faces of a cube map as the layers of an array with nearest filtering. Both have the same texels in memory.
inline Texture make_view_of_faces(const Texture& cube) {
  GLint format = 0;
  glGetTextureLevelParameteriv(cube.id(), 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
  GLuint id = 0;
  glGenTextures(1, &id);  // glTextureView needs a name that has no target yet
  glTextureView(id, GL_TEXTURE_2D_ARRAY, cube.id(), static_cast<GLenum>(format), 0, 1, 0, 6);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return Texture(id);
}

// data may be null; then the contents are undefined. The size may be 0 here, which OpenGL does not allow.
inline Buffer make_buffer(const void* data, size_t bytes) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  glNamedBufferStorage(id, static_cast<GLsizeiptr>(bytes ? bytes : 4), bytes ? data : nullptr, 0);
  return Buffer(id);
}

inline Framebuffer make_framebuffer() {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  return Framebuffer(id);
}

inline VertexArray make_vertex_array() {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  return VertexArray(id);
}

inline Sampler make_sampler() {
  GLuint id = 0;
  glCreateSamplers(1, &id);
  return Sampler(id);
}

inline Query make_query(GLenum target) {
  GLuint id = 0;
  glCreateQueries(target, 1, &id);
  return Query(id);
}

}  // namespace noonmark::gl
