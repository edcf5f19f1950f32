#include "viewer/gl/program.hpp"

#include "viewer/gl/gl.hpp"

namespace impinge {
namespace {

GLuint compile(GLenum stage, const std::string& file, const std::string& define) {
  const auto source = shader_sources().find(file);
  if (source == shader_sources().end()) throw InternalError("no shader " + file);
  const GLuint shader = glCreateShader(stage);
  std::string whole = source->second;
  if (!define.empty()) whole.insert(whole.find('\n') + 1, "#define " + define + "\n");  // after #version
  const char* text = whole.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good) {
    char log[2048] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw InternalError(file + ": " + log);
  }
  return shader;
}

}  // namespace

Program::Program(const std::string& name, const std::string& define) {
  const GLuint vertex = compile(GL_VERTEX_SHADER, name + ".vert", define),
               fragment = compile(GL_FRAGMENT_SHADER, name + ".frag", define);
  id_ = glCreateProgram();
  glAttachShader(id_, vertex);
  glAttachShader(id_, fragment);
  glLinkProgram(id_);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint good = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &good);
  if (!good) {
    char log[2048] = "";
    glGetProgramInfoLog(id_, sizeof log, nullptr, log);
    throw InternalError(name + ": " + log);
  }
}

Program::~Program() { glDeleteProgram(id_); }

void Program::use() const { glUseProgram(id_); }

int Program::location(const char* name) {
  const auto [place, is_new] = locations_.try_emplace(name, -1);
  if (is_new) place->second = glGetUniformLocation(id_, name);
  return place->second;
}

void Program::set(const char* name, float value) { glUniform1f(location(name), value); }
void Program::set(const char* name, int value) { glUniform1i(location(name), value); }
void Program::set(const char* name, const Eigen::Vector2f& value) { glUniform2fv(location(name), 1, value.data()); }
void Program::set(const char* name, const Eigen::Vector3f& value) { glUniform3fv(location(name), 1, value.data()); }
void Program::set(const char* name, const Eigen::Vector4f& value) { glUniform4fv(location(name), 1, value.data()); }
void Program::set(const char* name, std::span<const Eigen::Vector3f> values) {
  glUniform3fv(location(name), static_cast<GLsizei>(values.size()), values.front().data());
}
void Program::set(const char* name, const Eigen::Matrix3f& value) {
  glUniformMatrix3fv(location(name), 1, GL_FALSE, value.data());
}
void Program::set(const char* name, const Eigen::Matrix4f& value) {
  glUniformMatrix4fv(location(name), 1, GL_FALSE, value.data());
}

}  // namespace impinge
