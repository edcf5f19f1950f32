// Small owners of OpenGL buffer objects.
#pragma once

#include <cstddef>

namespace impinge {

/// A vertex array with one vertex buffer and perhaps an index buffer. Made, used and destroyed while its context is
/// current.
class VertexArray {
 public:
  VertexArray();
  ~VertexArray();
  VertexArray(const VertexArray&) = delete;
  VertexArray& operator=(const VertexArray&) = delete;

  void bind() const;
  void set_vertices(const void* data, std::size_t bytes);
  void set_indices(const void* data, std::size_t bytes);
  /// Floats at `offset` of every `stride` bytes; `per_instance`: one a quad instead of one a vertex.
  void floats(unsigned location, int count, std::size_t stride, std::size_t offset, bool per_instance = false);
  /// The same for bytes read as 0..1.
  void bytes(unsigned location, int count, std::size_t stride, std::size_t offset, bool per_instance = false);

 private:
  unsigned array_ = 0, vertices_ = 0, indices_ = 0;
};

}  // namespace impinge
