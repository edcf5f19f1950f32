#include "viewer/export/surface_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace impinge {

void SurfaceSequence::begin(const ExportJob& job, const StepRecord& start) {
  folder_ = job.folder;
  bodies_ = export_bodies(start, job.colors);
  files_ = FrameFiles(job.folder, ending_);
}

void SurfaceSequence::add(const StepRecord& record) {
  last_ = record.stats.frame;
  if (first_ < 0) first_ = last_;
  for (const ExportBody& body : bodies_) {
    if ((body.is_static() && has_static_) || there(body, record) == nullptr) continue;
    write(body.is_static() ? files_.of_all(body.name) : files_.of_frame(body.name, last_), world_surface(body, record),
          body.surface->triangles);
  }
  has_static_ = true;
}

std::string SurfaceSequence::result() const {
  if (first_ < 0) return "";
  const auto moving = std::find_if(bodies_.begin(), bodies_.end(), [](const ExportBody& b) { return !b.is_static(); });
  if (moving != bodies_.end())
    return fmt::format("{}/{}.{:06}{} ... {:06}{}", folder_.string(), moving->name, first_, ending_, last_, ending_);
  return bodies_.empty() ? "" : files_.of_all(bodies_.front().name).string();
}

}  // namespace impinge
