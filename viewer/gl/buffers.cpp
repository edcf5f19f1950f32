#include "viewer/gl/buffers.hpp"

#include "viewer/gl/gl.hpp"

namespace impinge {

VertexArray::VertexArray() {
  glGenVertexArrays(1, &array_);
  glGenBuffers(1, &vertices_);
  glGenBuffers(1, &indices_);
}

VertexArray::~VertexArray() {
  glDeleteVertexArrays(1, &array_);
  glDeleteBuffers(1, &vertices_);
  glDeleteBuffers(1, &indices_);
}

void VertexArray::bind() const {
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
}

void VertexArray::set_vertices(const void* data, std::size_t bytes) {
  bind();
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
}

void VertexArray::set_indices(const void* data, std::size_t bytes) {
  bind();
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
}

void VertexArray::floats(unsigned location, int count, std::size_t stride, std::size_t offset, bool per_instance) {
  bind();
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, count, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                        reinterpret_cast<const void*>(offset));
  glVertexAttribDivisor(location, per_instance ? 1 : 0);
}

void VertexArray::bytes(unsigned location, int count, std::size_t stride, std::size_t offset, bool per_instance) {
  bind();
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, count, GL_UNSIGNED_BYTE, GL_TRUE, static_cast<GLsizei>(stride),
                        reinterpret_cast<const void*>(offset));
  glVertexAttribDivisor(location, per_instance ? 1 : 0);
}

}  // namespace impinge
