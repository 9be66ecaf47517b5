#include "gl/program.h"

#include <fmt/format.h>

#include <stdexcept>

#include "base/error.h"
#include "gl/renderer.h"
#include "gl_shaders.h"
#include "technique_files.h"

namespace noonmark::gl {
namespace {

Shader compile(GLenum stage, const ShaderText& source) {
  Shader shader(glCreateShader(stage));
  const char* text = source.text.c_str();
  glShaderSource(shader.id(), 1, &text, nullptr);
  glCompileShader(shader.id());
  GLint ok = 0, length = 0;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &ok);
  if (ok) return shader;
  glGetShaderiv(shader.id(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(length) + 1, '\0');
  glGetShaderInfoLog(shader.id(), length + 1, nullptr, log.data());
  throw Error(ErrorKind::device,
              fmt::format("the OpenGL driver cannot compile a shader: {}", name_lines(log.c_str(), source.files)));
}

}  // namespace

Program::Program(const ShaderStages& stages, const ShaderSlots& slots, const ShaderFiles& files) {
  object_ = ProgramObject(glCreateProgram());
  const std::pair<GLenum, const std::string&> parts[] = {
      {GL_VERTEX_SHADER, stages.vertex}, {GL_GEOMETRY_SHADER, stages.geometry}, {GL_FRAGMENT_SHADER, stages.fragment}};
  std::vector<Shader> shaders;
  for (const auto& [stage, file] : parts)
    if (!file.empty()) shaders.push_back(compile(stage, expand_includes(file, slots, files)));
  for (const Shader& shader : shaders) glAttachShader(id(), shader.id());
  glLinkProgram(id());
  for (const Shader& shader : shaders) glDetachShader(id(), shader.id());
  GLint ok = 0, length = 0;
  glGetProgramiv(id(), GL_LINK_STATUS, &ok);
  if (ok) return;
  glGetProgramiv(id(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(length) + 1, '\0');
  glGetProgramInfoLog(id(), length + 1, nullptr, log.data());
  throw Error(ErrorKind::device,
              fmt::format("the OpenGL driver cannot link {} with {}: {}", stages.vertex, stages.fragment, log.c_str()));
}

int Program::location(const char* uniform) const {
  const int found = glGetUniformLocation(id(), uniform);
  if (found < 0) throw std::logic_error(fmt::format("the shader has no uniform '{}' in use", uniform));
  return found;
}

void Program::set(const char* uniform, int value) { glProgramUniform1i(id(), location(uniform), value); }
void Program::set(const char* uniform, float value) { glProgramUniform1f(id(), location(uniform), value); }
void Program::set(const char* uniform, glm::vec2 value) { glProgramUniform2fv(id(), location(uniform), 1, &value.x); }
void Program::set(const char* uniform, glm::ivec2 value) { glProgramUniform2iv(id(), location(uniform), 1, &value.x); }
void Program::set(const char* uniform, glm::vec4 value) { glProgramUniform4fv(id(), location(uniform), 1, &value.x); }
void Program::set(const char* uniform, glm::vec3 value) { glProgramUniform3fv(id(), location(uniform), 1, &value.x); }
void Program::set(const char* uniform, const glm::mat4& value) { set(uniform, std::span(&value, 1)); }
void Program::set(const char* uniform, std::span<const int> values) {
  glProgramUniform1iv(id(), location(uniform), static_cast<GLsizei>(values.size()), values.data());
}
void Program::set(const char* uniform, std::span<const glm::mat4> values) {
  glProgramUniformMatrix4fv(id(), location(uniform), static_cast<GLsizei>(values.size()), GL_FALSE, &values[0][0][0]);
}
// A uniform that is not used has the location -1, and OpenGL ignores it.
void Program::set_if_used(const char* uniform, float value) {
  glProgramUniform1f(id(), glGetUniformLocation(id(), uniform), value);
}
void Program::set_if_used(const char* uniform, int value) {
  glProgramUniform1i(id(), glGetUniformLocation(id(), uniform), value);
}
void Program::set_if_used(const char* uniform, glm::vec2 value) {
  glProgramUniform2fv(id(), glGetUniformLocation(id(), uniform), 1, &value.x);
}
void Program::set_if_used(const char* uniform, glm::vec3 value) {
  glProgramUniform3fv(id(), glGetUniformLocation(id(), uniform), 1, &value.x);
}
void Program::set_if_used(const char* uniform, const glm::mat3& value) {
  glProgramUniformMatrix3fv(object_.id(), glGetUniformLocation(object_.id(), uniform), 1, GL_FALSE, &value[0][0]);
}
// OpenGL ignores what is beyond the elements that an array has in use.
void Program::set_if_used(const char* uniform, std::span<const float> values) {
  glProgramUniform1fv(id(), glGetUniformLocation(id(), uniform), static_cast<GLsizei>(values.size()), values.data());
}
void Program::set_if_used(const char* uniform, std::span<const glm::vec2> values) {
  glProgramUniform2fv(id(), glGetUniformLocation(id(), uniform), static_cast<GLsizei>(values.size()), &values[0].x);
}
void Program::set_if_used(const char* uniform, std::span<const glm::vec3> values) {
  glProgramUniform3fv(id(), glGetUniformLocation(id(), uniform), static_cast<GLsizei>(values.size()), &values[0].x);
}
void Program::set_if_used(const char* uniform, std::span<const glm::mat4> values) {
  glProgramUniformMatrix4fv(id(), glGetUniformLocation(id(), uniform), static_cast<GLsizei>(values.size()), GL_FALSE,
                            &values[0][0][0]);
}

namespace {

// The text of a file of gl/shaders or of a file of technique/ that C++ compiles too. It is empty if there is no such
// file.
std::string_view embedded(std::string_view name) {
  constexpr std::string_view shared = "technique/";
  return name.starts_with(shared) ? technique_files::embedded(name.substr(shared.size())) : shaders::embedded(name);
}

}  // namespace

std::string shader_file(const std::string& name) {
  const std::string_view text = embedded(name);
  if (text.empty())
    throw Error(ErrorKind::usage,
                fmt::format("there is no shader file '{}'; gl/CMakeLists.txt lists those of the program", name));
  return std::string(text);
}

ProgramCache::ProgramCache(std::map<std::string, std::string> replaced) : replaced_(std::move(replaced)) {
  for (const auto& [name, text] : replaced_) shader_file(name);
}

void ProgramCache::define(const std::string& name, std::string text) { made_.try_emplace(name, std::move(text)); }

Program& ProgramCache::get(const ShaderStages& stages, const ShaderSlots& slots) {
  std::string key = stages.vertex + '\n' + stages.geometry + '\n' + stages.fragment;
  for (const auto& [slot, file] : slots) key += '\n' + slot + '=' + file;
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  const ShaderFiles files = [&](std::string_view name) {
    for (const auto* texts : {&replaced_, &made_})
      if (const auto text = texts->find(std::string(name)); text != texts->end()) return std::string_view(text->second);
    return embedded(name);
  };
  return programs_.emplace(key, Program(stages, slots, files)).first->second;
}

}  // namespace noonmark::gl
