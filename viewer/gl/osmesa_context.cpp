#include <array>
#include <cstdlib>
#include <stdexcept>

#include "engine/core/parallel.hpp"
#include "viewer/gl/context.hpp"
#include "viewer/gl/gl.hpp"

namespace impinge {
namespace {

class OsmesaContext final : public GlContext {
 public:
  OsmesaContext() {
    // 3.3 is what the shaders are written for; OSMesa refuses more than 4.5
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              0,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    // llvmpipe's own threads are asked for by the environment alone; what the user says there holds
    if (thread_count() == 1) setenv("LP_NUM_THREADS", "0", 0);
    context_ = OSMesaCreateContextAttribs(attributes, nullptr);
    if (context_ == nullptr) throw std::runtime_error("no OpenGL 3.3 core context from OSMesa");
    make_current();
    const auto text = [](GLenum name) { return std::string(reinterpret_cast<const char*>(glGetString(name))); };
    name_ = text(GL_RENDERER);
    const std::string version = text(GL_VERSION);  // "3.3 (Core Profile) Mesa 22.3.6"
    if (const auto mesa = version.find("Mesa "); mesa != std::string::npos) name_ += " " + version.substr(mesa + 5);
  }
  ~OsmesaContext() override { OSMesaDestroyContext(context_); }

  void make_current() override {
    if (OSMesaGetCurrentContext() == context_) return;  // asked for again it waits for all that is being drawn
    if (!OSMesaMakeCurrent(context_, surface_.data(), GL_UNSIGNED_BYTE, kSide, kSide))
      throw std::runtime_error("OSMesa's context cannot be made current");
  }
  std::string renderer_name() const override { return name_; }

 private:
  static constexpr int kSide = 16;  // OSMesa wants a surface; nothing is drawn to it
  OSMesaContext context_ = nullptr;
  std::array<std::uint8_t, 4 * kSide * kSide> surface_{};
  std::string name_;
};

}  // namespace

std::unique_ptr<GlContext> make_offscreen_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace impinge
