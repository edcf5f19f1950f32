#include "viewer/gl/id_buffer.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "viewer/gl/gl.hpp"

namespace impinge {

IdBuffer::IdBuffer(int width, int height) : width_(width), height_(height) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (width < 1 || height < 1 || width > limit || height > limit) throw InternalError("no id buffer of that size");
  glGenRenderbuffers(1, &depth_);
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glGenRenderbuffers(1, &ids_);
  glBindRenderbuffer(GL_RENDERBUFFER, ids_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RG32UI, width, height);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, ids_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw InternalError("the id buffer is not complete");
}

IdBuffer::~IdBuffer() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteRenderbuffers(1, &ids_);
  glDeleteRenderbuffers(1, &depth_);
}

void IdBuffer::bind_cleared() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_, height_);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  const GLuint nothing[4] = {0, IdImage::kNoPart, 0, 0};
  const GLfloat far = 1.0f;
  glClearBufferuiv(GL_COLOR, 0, nothing);
  glClearBufferfv(GL_DEPTH, 0, &far);
}

void IdBuffer::read(IdImage& out) {
  const std::size_t pixels = static_cast<std::size_t>(width_) * height_;
  rows_.resize(2 * pixels);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RG_INTEGER, GL_UNSIGNED_INT, rows_.data());
  out.width = width_;
  out.height = height_;
  out.object.resize(pixels);
  out.part.resize(pixels);
  for (int y = 0; y < height_; ++y) {
    const std::uint32_t* from = rows_.data() + static_cast<std::size_t>(height_ - 1 - y) * width_ * 2;
    for (int x = 0; x < width_; ++x, from += 2) {
      const std::size_t i = static_cast<std::size_t>(y) * width_ + x;
      out.object[i] = from[0];
      out.part[i] = from[1];
    }
  }
}

namespace {

/// The objects met so far, by what tells them apart.
class Objects {
 public:
  explicit Objects(const StepRecord& record) : record_(record) {}

  Color code(std::string_view layer, const char* mark, PickId pick) {
    const auto [place, is_new] =
        index_.try_emplace({layer, mark, pick}, static_cast<std::uint32_t>(objects_.size() + 1));
    if (is_new) objects_.push_back(object(layer, mark, pick));
    const std::uint32_t i = place->second;
    const auto channel = [i](int shift) { return static_cast<float>(i >> shift & 0xffu) / 255.0f; };
    return {channel(0), channel(8), channel(16), channel(24)};
  }
  std::vector<IdObject> take() { return std::move(objects_); }

 private:
  IdObject object(std::string_view layer, const char* mark, PickId pick) const {
    IdObject o;
    o.layer = layer;
    o.mark = mark;
    const auto name = [&](int body) {
      return body < 0 ? std::string("world") : std::string(record_.bodies[static_cast<std::size_t>(body)].name);
    };
    if (pick >= contact_pick(0)) {
      const std::size_t contact = pick - contact_pick(0);
      if (contact >= record_.contacts.size()) return o;
      const ContactRecord& c = record_.contacts[contact];
      o.body = name(c.body_a), o.other = name(c.body_b);
      o.identity = c.pair_id;
      o.body_index = c.body_a, o.contact_index = static_cast<int>(contact);
    } else if (pick > 0 && pick <= record_.bodies.size()) {
      o.body_index = static_cast<int>(pick - 1);
      o.body = name(o.body_index);
      if (o.mark == "surface" && record_.bodies[pick - 1].kind == BodyKind::fixed) o.mark = "fixed surface";
    }
    return o;
  }

  const StepRecord& record_;
  std::map<std::tuple<std::string_view, std::string_view, PickId>, std::uint32_t> index_;
  std::vector<IdObject> objects_;
};

}  // namespace

std::vector<IdObject> code_colors(DrawList& list, const StepRecord& record) {
  Objects objects(record);
  const auto code = [&](auto& items, const char* mark, std::size_t DrawnLayer::*count) {
    std::size_t layer = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      while (layer < list.layers.size() && i >= list.layers[layer].*count) ++layer;
      items[i].color = objects.code(layer < list.layers.size() ? list.layers[layer].name : "", mark, items[i].pick);
    }
  };
  code(list.surfaces, "surface", &DrawnLayer::surfaces);
  code(list.planes, "plane", &DrawnLayer::planes);
  code(list.triangles, "triangle", &DrawnLayer::triangles);
  code(list.lines, "line", &DrawnLayer::lines);
  code(list.arrows, "arrow", &DrawnLayer::arrows);
  code(list.points, "point", &DrawnLayer::points);
  return objects.take();
}

}  // namespace impinge
