// glTF 2.0: a mesh a body, poses as animated nodes, deformable surfaces as morph targets, a target a frame. One file,
// .glb, not .gltf and .bin: what is sent to somebody can't lose its numbers, and nothing is half written. Numbers are
// single precision by the format; where the scene lies far from the origin a node above all has the way there.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "viewer/export/export_bodies.hpp"
#include "viewer/export/exporter.hpp"
#include "viewer/export/glb_file.hpp"

namespace impinge {

namespace {

constexpr std::uint64_t kMostMorphBytes = std::uint64_t{64} << 20;

/// A body's way through the frames, from the root's origin.
struct Track {
  std::vector<Vec3> position;
  std::vector<Quat> rotation;
  std::vector<std::vector<Eigen::Vector3f>> surface;  // of a deformable body, frame by frame
  std::vector<bool> is_there;  // not added yet, or deleted: as it was, or will be, and of no size

  bool moves() const {
    return std::any_of(position.begin(), position.end(), [&](const Vec3& x) { return x != position.front(); }) ||
           std::any_of(rotation.begin(), rotation.end(),
                       [&](const Quat& q) { return q.coeffs() != rotation.front().coeffs(); });
  }
};

std::uint64_t morph_bytes(std::uint64_t vertices, std::uint64_t bodies, std::uint64_t frames) {
  return frames == 0 ? 0 : (frames - 1) * (12 * vertices + 4 * frames * bodies);
}

std::string list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ",\n") + item;
  return "[" + text + "]";
}

std::vector<Eigen::Vector3f> singles(std::span<const Vec3> points) {
  std::vector<Eigen::Vector3f> out;
  out.reserve(points.size());
  for (const Vec3& x : points) out.push_back(x.cast<float>());
  return out;
}

class GltfExporter final : public Exporter {
 public:
  void begin(const ExportJob& job, const StepRecord& start) override;
  void add(const StepRecord& record) override;
  void finish() override;
  std::string result() const override { return times_.empty() ? "" : path_.string(); }

 private:
  void check_size(const ExportJob& job) const;
  void add_mesh(std::size_t i, const StepRecord& first);
  void add_body(std::size_t i);
  void add_channel(std::size_t node, const char* path, int values, const char* between = "LINEAR");
  void add_scale(std::size_t node, const std::vector<bool>& is_there);

  std::filesystem::path path_;
  std::string name_;
  std::vector<ExportBody> bodies_;
  std::vector<Track> tracks_;  // by body
  std::vector<float> times_;
  Vec3 origin_ = Vec3::Zero();

  // the file
  GlbBuffer buffer_;
  std::map<const TriangleMesh*, std::pair<int, int>> shared_;  // accessors of vertices and corners
  std::vector<std::pair<int, int>> of_body_;
  std::vector<std::string> meshes_, materials_, nodes_, samplers_, channels_;
  int input_ = -1;  // the accessor of the times
};

void GltfExporter::begin(const ExportJob& job, const StepRecord& start) {
  path_ = job.folder / (job.name + ".glb");
  name_ = job.name;
  bodies_ = export_bodies(start, job.colors);
  check_size(job);
  tracks_.resize(bodies_.size());
  origin_ = far_origin(bounds_of(bodies_, start));
}

void GltfExporter::check_size(const ExportJob& job) const {
  std::uint64_t vertices = 0, bodies = 0;
  for (const ExportBody& body : bodies_)
    if (body.is_deformable()) vertices += body.surface->vertices.size(), ++bodies;
  const auto frames = static_cast<std::uint64_t>(job.frames);
  const std::uint64_t bytes = morph_bytes(vertices, bodies, frames);
  if (bytes <= kMostMorphBytes) return;
  std::uint64_t step = 2;
  while (morph_bytes(vertices, bodies, (frames - 1) / step + 1) > kMostMorphBytes) ++step;
  throw InputError(fmt::format(
      "command line: {} of {} frames: the deformable bodies' morph targets take {} MB; at most {} MB are written; take "
      "every {} frame (impinge export --frames {}:{}:{}), or usda or vtu, which have no such bound",
      job.option, frames, (bytes + (1 << 20) - 1) >> 20, kMostMorphBytes >> 20,
      step == 2   ? "second"
      : step == 3 ? "third"
                  : fmt::format("{}th", step),
      job.first, job.first + job.stride * (job.frames - 1), step * static_cast<std::uint64_t>(job.stride)));
}

void GltfExporter::add(const StepRecord& record) {
  if (times_.empty()) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) add_mesh(i, record);
  }
  times_.push_back(static_cast<float>(record.stats.time));
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Track& track = tracks_[i];
    const bool is_there = there(bodies_[i], record) != nullptr;
    track.is_there.push_back(is_there);
    if (bodies_[i].is_static() && !track.position.empty()) continue;
    const bool is_known = is_there || !track.position.empty();
    if (bodies_[i].is_deformable()) {
      track.surface.push_back(is_there   ? singles(local_surface(bodies_[i], record))
                              : is_known ? track.surface.back()
                                         : singles(start_surface(bodies_[i])));
      if (!track.position.empty()) continue;
    }
    if (!is_there && is_known) {
      track.position.push_back(track.position.back());
      track.rotation.push_back(track.rotation.back());
      continue;
    }
    const Pose pose = is_there ? local_pose(bodies_[i], record) : start_pose(bodies_[i]);
    track.position.push_back(pose.position - origin_);
    track.rotation.push_back(
        quaternion_of(pose.rotation, track.rotation.empty() ? std::nullopt : std::optional(track.rotation.back())));
  }
}

void GltfExporter::add_mesh(std::size_t i, const StepRecord& first) {
  const TriangleMesh* surface = bodies_[i].surface.get();
  const auto [at, is_new] = shared_.try_emplace(surface);
  if (is_new)
    at->second = {buffer_.add_points(singles(there(bodies_[i], first) != nullptr ? local_surface(bodies_[i], first)
                                                                                 : start_surface(bodies_[i])),
                                     true),
                  buffer_.add_corners(surface->triangles)};
  of_body_.push_back(at->second);
}

void GltfExporter::add_channel(std::size_t node, const char* path, int values, const char* between) {
  channels_.push_back(
      fmt::format("{{\"sampler\":{},\"target\":{{\"node\":{},\"path\":\"{}\"}}}}", samplers_.size(), node, path));
  samplers_.push_back(fmt::format("{{\"input\":{},\"interpolation\":\"{}\",\"output\":{}}}", input_, between, values));
}

/// glTF has no other way to say from when to when there is something.
void GltfExporter::add_scale(std::size_t node, const std::vector<bool>& is_there) {
  std::vector<Eigen::Vector3f> scales;
  for (const bool now : is_there) scales.push_back(Eigen::Vector3f::Constant(now ? 1.0f : 0.0f));
  add_channel(node, "scale", buffer_.add_points(scales, false), "STEP");
}

void GltfExporter::add_body(std::size_t i) {
  const ExportBody& body = bodies_[i];
  const Track& track = tracks_[i];
  const std::size_t frames = times_.size(), node = nodes_.size();
  const Vec3 color = linear_color(body.color), &x = track.position.front();
  const Quat& q = track.rotation.front();
  materials_.push_back(fmt::format(
      "{{\"name\":\"{}\",\"pbrMetallicRoughness\":{{\"baseColorFactor\":[{:.5f},{:.5f},{:.5f},1],\"metallicFactor\":0,"
      "\"roughnessFactor\":0.7}}}}",
      body.name, color.x(), color.y(), color.z()));
  std::string targets, weights;
  if (body.is_deformable() && frames > 1) {
    for (std::size_t f = 1; f < frames; ++f) {
      std::vector<Eigen::Vector3f> moved = track.surface[f];
      for (std::size_t v = 0; v < moved.size(); ++v) moved[v] -= track.surface.front()[v];
      targets += fmt::format("{}{{\"POSITION\":{}}}", f == 1 ? "" : ",", buffer_.add_points(moved, true));
    }
    targets = ",\"targets\":[" + targets + "]";
    for (std::size_t f = 1; f < frames; ++f) weights += f == 1 ? "0" : ",0";
    weights = ",\"weights\":[" + weights + "]";
  }
  nodes_.push_back(
      fmt::format("{{\"name\":\"{}\",\"mesh\":{},\"translation\":[{},{},{}],\"rotation\":[{},{},{},{}]{}}}", body.name,
                  meshes_.size(), x.x(), x.y(), x.z(), q.x(), q.y(), q.z(), q.w(),
                  track.is_there.front() ? "" : ",\"scale\":[0,0,0]"));
  meshes_.push_back(fmt::format(
      "{{\"name\":\"{}\",\"primitives\":[{{\"attributes\":{{\"POSITION\":{}}},\"indices\":{},\"material\":{}"
      "{}}}]{}}}",
      body.name, of_body_[i].first, of_body_[i].second, materials_.size() - 1, targets, weights));
  if (!targets.empty()) {
    // the surface of frame f is the f-th target's: weight 1 there, 0 elsewhere, and evenly between
    std::vector<float> of_frames(frames * (frames - 1), 0.0f);
    for (std::size_t f = 1; f < frames; ++f) of_frames[f * (frames - 1) + f - 1] = 1.0f;
    add_channel(node, "weights", buffer_.add_numbers(of_frames));
  } else if (track.moves()) {
    std::vector<Eigen::Vector4f> rotations;
    for (const Quat& r : track.rotation) rotations.emplace_back(r.coeffs().cast<float>());
    add_channel(node, "translation", buffer_.add_points(singles(track.position), false));
    add_channel(node, "rotation", buffer_.add_quaternions(rotations));
  }
  if (std::find(track.is_there.begin(), track.is_there.end(), !track.is_there.front()) != track.is_there.end())
    add_scale(node, track.is_there);
}

void GltfExporter::finish() {
  if (times_.empty()) return;
  input_ = buffer_.add_numbers(times_);
  std::string children;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    add_body(i);
    children += fmt::format("{}{}", i == 0 ? "" : ",", i);
  }
  const std::size_t root = nodes_.size();
  nodes_.push_back(fmt::format("{{\"name\":\"{}\",\"translation\":[{},{},{}]{}}}", name_, origin_.x(), origin_.y(),
                               origin_.z(), children.empty() ? "" : ",\"children\":[" + children + "]"));
  std::string json = fmt::format(
      "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"impinge {}\"}},\n\"scene\":0,\"scenes\":[{{\"name\":\"{}\","
      "\"nodes\":[{}]}}],\n\"nodes\":{}",
      IMPINGE_VERSION, name_, root, list(nodes_));
  if (!meshes_.empty()) json += ",\n\"meshes\":" + list(meshes_) + ",\n\"materials\":" + list(materials_);
  if (!channels_.empty())
    json += fmt::format(",\n\"animations\":[{{\"name\":\"{}\",\"samplers\":{},\n\"channels\":{}}}]", name_,
                        list(samplers_), list(channels_));
  json += fmt::format(",\n\"accessors\":{},\n\"bufferViews\":{},\n\"buffers\":[{{\"byteLength\":{}}}]}}",
                      buffer_.accessors_json(), buffer_.views_json(), buffer_.bytes().size());
  write_glb(path_, json, buffer_.bytes());
}

}  // namespace

Entry<Exporter> gltf_exporter() {
  return entry<Exporter, GltfExporter>("gltf", "one .glb: a mesh a body, animated; deformable bodies as morph targets");
}

}  // namespace impinge
