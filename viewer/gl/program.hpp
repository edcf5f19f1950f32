// A linked pair of shaders from shaders/, found by name in the program itself.
#pragma once

#include <map>
#include <span>
#include <string>

#include <Eigen/Core>

namespace impinge {

/// The GLSL texts by file name, embedded at build time.
const std::map<std::string, std::string>& shader_sources();

/// Must be made, used and destroyed while its context is current.
class Program {
 public:
  /// Compiles shaders/NAME.vert and shaders/NAME.frag, with `define` (if not "") defined in both. Throws InternalError
  /// with the compiler's words.
  explicit Program(const std::string& name, const std::string& define = "");
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const;
  void set(const char* name, float value);
  void set(const char* name, int value);
  void set(const char* name, const Eigen::Vector2f& value);
  void set(const char* name, const Eigen::Vector3f& value);
  void set(const char* name, const Eigen::Vector4f& value);
  void set(const char* name, std::span<const Eigen::Vector3f> values);  ///< of an array; `name` with its "[0]"
  void set(const char* name, const Eigen::Matrix3f& value);
  void set(const char* name, const Eigen::Matrix4f& value);

 private:
  int location(const char* name);

  unsigned id_ = 0;
  std::map<std::string, int> locations_;
};

}  // namespace impinge
