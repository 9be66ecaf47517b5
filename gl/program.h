// OpenGL programs that are made of the embedded GLSL files (gl/shaders). Each program is built once per context.
//
//   Program& lookup = programs.get({"shaders/screen.vert", "shaders/lookup.frag"},
//                                  {{"filter", "shaders/filter/box.glsl"}});
//   lookup.set("resolution", 1024);
//   glUseProgram(lookup.id());
#pragma once
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>

#include "gl/gl_objects.h"
#include "gl/shader_text.h"

namespace noonmark::gl {

struct ShaderStages {
  std::string vertex, fragment;
  std::string geometry = {};  // empty: none
};

class Program {
 public:
  // Throws Error(device) with the shader's file and line.
  Program(const ShaderStages& stages, const ShaderSlots& slots, const ShaderFiles& files);

  GLuint id() const { return object_.id(); }

  // Throws std::logic_error when the program has no such uniform in use.
  void set(const char* uniform, int value);
  void set(const char* uniform, float value);
  void set(const char* uniform, glm::vec2 value);
  void set(const char* uniform, glm::ivec2 value);
  void set(const char* uniform, glm::vec3 value);
  void set(const char* uniform, glm::vec4 value);
  void set(const char* uniform, const glm::mat4& value);
  void set(const char* uniform, std::span<const int> values);
  void set(const char* uniform, std::span<const glm::mat4> values);
  // The same, but without an error if the program does not use the uniform. Only some files of a slot use these.
  void set_if_used(const char* uniform, float value);
  void set_if_used(const char* uniform, int value);
  void set_if_used(const char* uniform, glm::vec2 value);
  void set_if_used(const char* uniform, glm::vec3 value);
  void set_if_used(const char* uniform, const glm::mat3& value);
  void set_if_used(const char* uniform, std::span<const float> values);
  void set_if_used(const char* uniform, std::span<const glm::vec2> values);
  void set_if_used(const char* uniform, std::span<const glm::vec3> values);
  void set_if_used(const char* uniform, std::span<const glm::mat4> values);

 private:
  int location(const char* uniform) const;
  ProgramObject object_;
};

class ProgramCache {
 public:
  // replaced: texts to use instead of embedded files. Throws Error(usage) if one of these files is not embedded.
  explicit ProgramCache(std::map<std::string, std::string> replaced = {});

  // Defines a text by a name, which slots and includes may use like the name of a file. A text that is already defined
  // is not changed.
  void define(const std::string& name, std::string text);

  Program& get(const ShaderStages& stages, const ShaderSlots& slots = {});

 private:
  std::map<std::string, std::string> replaced_, made_;
  std::map<std::string, Program> programs_;
};

}  // namespace noonmark::gl
