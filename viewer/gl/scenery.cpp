#include "viewer/gl/scenery.hpp"

#include "viewer/gl/gl.hpp"

namespace impinge {
namespace {

template <class Matrix>
void append(std::vector<double>& numbers, const Matrix& m) {
  for (Eigen::Index i = 0; i < m.size(); ++i) numbers.push_back(static_cast<double>(m.data()[i]));
}

void append(std::vector<double>& numbers, const Color& c) {
  for (const float share : {c.r, c.g, c.b, c.a}) numbers.push_back(static_cast<double>(share));
}

}  // namespace

void Scenery::draw(const Backdrop& backdrop, const std::vector<DrawPlane>& planes, const Camera& camera,
                   const ViewTransform& view, float pixel_scale, Framebuffer& target) {
  std::vector<double> now = {static_cast<double>(target.width()), static_cast<double>(target.height()),
                             static_cast<double>(pixel_scale), backdrop.is_transparent ? 1.0 : 0.0, camera.fov_deg};
  append(now, backdrop.top);
  append(now, backdrop.bottom);
  append(now, camera.eye);
  append(now, camera.target);
  append(now, camera.up);
  append(now, view.projection);
  now.push_back(view.distance);
  now.push_back(view.floor_radius);
  for (const DrawPlane& plane : planes) {
    append(now, plane.normal);
    append(now, plane.color);
    now.push_back(plane.offset);
  }
  if (copy_ && now == kept_) {
    copy_->copy_with_depth_to(target);
    target.bind();
    return;
  }
  target.bind();
  paint(backdrop, planes, camera, view, pixel_scale);
  // a camera that moves is never worth a copy
  if (now == last_) {
    if (!copy_ || copy_->width() != target.width() || copy_->height() != target.height())
      copy_ = std::make_unique<Framebuffer>(target.width(), target.height());
    target.copy_with_depth_to(*copy_);
    target.bind();
    kept_ = now;
  }
  last_ = std::move(now);
}

void Scenery::paint(const Backdrop& backdrop, const std::vector<DrawPlane>& planes, const Camera& camera,
                    const ViewTransform& view, float pixel_scale) {
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glClearDepth(1.0);
  glClear(GL_DEPTH_BUFFER_BIT);
  if (backdrop.is_transparent) {
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT);
  } else {
    glDisable(GL_DEPTH_TEST);
    nothing_.bind();
    backdrop_program_.use();
    backdrop_program_.set("top", Eigen::Vector3f(backdrop.top.r, backdrop.top.g, backdrop.top.b));
    backdrop_program_.set("bottom", Eigen::Vector3f(backdrop.bottom.r, backdrop.bottom.g, backdrop.bottom.b));
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  for (const DrawPlane& plane : planes) grid_.draw(plane, camera, view, pixel_scale);
}

}  // namespace impinge
