#include "viewer/gl/imgui_backend.hpp"

#include <imgui.h>
#include <cmath>
#include <cstdint>

#include "viewer/gl/gl.hpp"

namespace impinge {

ImguiBackend::ImguiBackend(ImFontAtlas& atlas) {
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  atlas.SetTexID(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture_)));
  array_.floats(0, 2, sizeof(ImDrawVert), offsetof(ImDrawVert, pos));
  array_.floats(1, 2, sizeof(ImDrawVert), offsetof(ImDrawVert, uv));
  array_.bytes(2, 4, sizeof(ImDrawVert), offsetof(ImDrawVert, col));
}

ImguiBackend::~ImguiBackend() { glDeleteTextures(1, &texture_); }

void ImguiBackend::draw(const ImDrawData& data) {
  draw({data.CmdLists, static_cast<std::size_t>(data.CmdListsCount)}, data.DisplaySize.x, data.DisplaySize.y);
}

void ImguiBackend::draw(std::span<const ImDrawList* const> lists, float width, float height) {
  if (lists.empty()) return;
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_SCISSOR_TEST);
  glActiveTexture(GL_TEXTURE0);
  program_.use();
  program_.set("picture", Eigen::Vector2f(width, height));
  program_.set("atlas", 0);
  for (const ImDrawList* each : lists) {
    const ImDrawList& list = *each;
    array_.set_vertices(list.VtxBuffer.Data, static_cast<std::size_t>(list.VtxBuffer.Size) * sizeof(ImDrawVert));
    array_.set_indices(list.IdxBuffer.Data, static_cast<std::size_t>(list.IdxBuffer.Size) * sizeof(ImDrawIdx));
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr) {
        command.UserCallback(&list, &command);
        continue;
      }
      const ImVec4& clip = command.ClipRect;  // left, top, right, bottom, from the top left
      if (clip.z <= clip.x || clip.w <= clip.y) continue;
      glScissor(static_cast<GLint>(clip.x), static_cast<GLint>(height - clip.w),
                static_cast<GLsizei>(std::ceil(clip.z - clip.x)), static_cast<GLsizei>(std::ceil(clip.w - clip.y)));
      glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(reinterpret_cast<std::intptr_t>(command.GetTexID())));
      const GLenum type = sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
      glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), type,
                               reinterpret_cast<const void*>(command.IdxOffset * sizeof(ImDrawIdx)),
                               static_cast<GLint>(command.VtxOffset));
    }
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
}

}  // namespace impinge
