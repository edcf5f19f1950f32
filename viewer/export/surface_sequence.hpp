// Surfaces as files of their own, one a body and frame; of a body that never moves one.
#pragma once

#include <span>

#include "viewer/export/export_bodies.hpp"
#include "viewer/export/exporter.hpp"
#include "viewer/export/frame_files.hpp"

namespace impinge {

class SurfaceSequence : public Exporter {
 public:
  void begin(const ExportJob& job, const StepRecord& start) override;
  void add(const StepRecord& record) override;
  void finish() override { files_.remove_others(); }
  std::string result() const override;

 protected:
  explicit SurfaceSequence(std::string ending) : ending_(std::move(ending)) {}
  virtual void write(const std::filesystem::path& path, std::span<const Vec3> vertices,
                     std::span<const Triangle> triangles) const = 0;

 private:
  std::string ending_;
  std::filesystem::path folder_;
  std::vector<ExportBody> bodies_;
  FrameFiles files_;
  bool has_static_ = false;
  int first_ = -1, last_ = -1;  // frames
};

}  // namespace impinge
