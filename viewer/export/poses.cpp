// The motion of bodies that have a pose, as a table or as JSON. Where a body stands is where its file's (or its
// shape's) origin stands: x_world = R(quaternion)·(scale·x_file) + position, as in a scene file; velocities are those
// of its centre of mass. Bodies that never move are there once, with the first frame; planes and deformable bodies,
// which have no pose, are not. While a body is not added yet, or deleted, the table has no row of it and the JSON null.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <map>
#include <memory>
#include <utility>

#include "engine/shapes/primitives.hpp"
#include "viewer/export/export_bodies.hpp"
#include "viewer/export/exporter.hpp"
#include "viewer/export/new_file.hpp"

namespace impinge {

namespace {

struct Posed {
  const BodyRecord* body;  ///< null: not there
  Quat rotation;
};

class PosesExporter : public Exporter {
 public:
  void begin(const ExportJob& job, const StepRecord& start) override {
    path_ = job.folder / name_;
    frame_time_ = job.frame_time;
    all_ = start.bodies;
  }

  void add(const StepRecord& record) override {
    const bool is_first = file_ == nullptr;
    std::vector<Posed> moving, fixed;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (all_[i].deformable != nullptr || all_[i].shape->as<Plane>() != nullptr) continue;
      const bool moves = all_[i].kind != BodyKind::fixed;
      if (!moves && !is_first) continue;
      if (i >= record.bodies.size() || record.bodies[i].deleted) {
        if (moves) moving.push_back({nullptr, Quat::Identity()});
        continue;
      }
      const BodyRecord& body = record.bodies[i];
      const auto before = rotations_.find(i);
      const Quat rotation = quaternion_of(body.file_pose.rotation,
                                          before == rotations_.end() ? std::nullopt : std::optional(before->second));
      rotations_[i] = rotation;
      (moves ? moving : fixed).push_back({&body, rotation});
    }
    std::string text;
    if (is_first) {
      file_ = std::make_unique<NewFile>(path_);
      std::vector<Posed> all;
      for (const BodyRecord& body : all_)
        if (body.deformable == nullptr && body.shape->as<Plane>() == nullptr && body.kind != BodyKind::fixed)
          all.push_back({&body, Quat::Identity()});
      text = head(fixed, all, record);
    }
    text += frame(moving, record, is_first);
    file_->append(text);
  }

  void finish() override {
    if (file_ == nullptr) return;
    file_->append(tail());
    file_->keep();
  }
  std::string result() const override {
    if (file_ == nullptr) return "";
    return path_.string() + (rotations_.empty() ? " (of no body: planes and deformable ones have no pose)" : "");
  }

 protected:
  explicit PosesExporter(const char* name) : name_(name) {}
  /// `moving`: all that there are or will be, as loaded.
  virtual std::string head(const std::vector<Posed>& fixed, const std::vector<Posed>& moving,
                           const StepRecord& record) const = 0;
  virtual std::string frame(const std::vector<Posed>& moving, const StepRecord& record, bool is_first) const = 0;
  virtual std::string tail() const = 0;

  double frame_time_ = 0.0;

 private:
  const char* name_;
  std::filesystem::path path_;
  std::unique_ptr<NewFile> file_;
  std::vector<BodyRecord> all_;            // as loaded
  std::map<std::size_t, Quat> rotations_;  // of the frame before, by body
};

class PosesCsv final : public PosesExporter {
 public:
  PosesCsv() : PosesExporter("poses.csv") {}

 private:
  static void rows(std::string& text, const std::vector<Posed>& bodies, const FrameStats& stats) {
    for (const auto& [body, q] : bodies) {
      if (body == nullptr) continue;
      const Vec3 &x = body->file_pose.position, &c = body->pose.position, &v = body->velocity,
                 &w = body->angular_velocity;
      fmt::format_to(std::back_inserter(text),
                     FMT_COMPILE("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n"), stats.frame, stats.time,
                     body->name, x.x(), x.y(), x.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z(), w.x(), w.y(),
                     w.z(), c.x(), c.y(), c.z());
    }
  }
  std::string head(const std::vector<Posed>& fixed, const std::vector<Posed>&,
                   const StepRecord& record) const override {
    std::string text =
        "frame,time_s,body,x_m,y_m,z_m,q_w,q_x,q_y,q_z,v_x,v_y,v_z,omega_x,omega_y,omega_z,center_x_m,center_y_m,"
        "center_z_m\n";
    rows(text, fixed, record.stats);
    return text;
  }
  std::string frame(const std::vector<Posed>& moving, const StepRecord& record, bool) const override {
    std::string text;
    rows(text, moving, record.stats);
    return text;
  }
  std::string tail() const override { return ""; }
};

class PosesJson final : public PosesExporter {
 public:
  PosesJson() : PosesExporter("poses.json") {}

 private:
  static std::string vector(const Vec3& v) { return fmt::format(FMT_COMPILE("[{}, {}, {}]"), v.x(), v.y(), v.z()); }
  static std::string pose(const Posed& p) {
    return fmt::format(FMT_COMPILE("\"position\": {}, \"quaternion\": [{}, {}, {}, {}]"),
                       vector(p.body->file_pose.position), p.rotation.w(), p.rotation.x(), p.rotation.y(),
                       p.rotation.z());
  }
  // names hold nothing that JSON would have to escape
  std::string head(const std::vector<Posed>& fixed, const std::vector<Posed>& moving,
                   const StepRecord&) const override {
    std::string text = fmt::format(
        "{{\"units\": {{\"length\": \"m\", \"time\": \"s\", \"angle\": \"rad\"}}, \"quaternion\": \"w, x, y, z\", "
        "\"frame_time\": {},\n\"static\": [",
        frame_time_);
    const char* comma = "\n  ";
    for (const Posed& p : fixed)
      text += fmt::format("{}{{\"name\": \"{}\", {}}}", std::exchange(comma, ",\n  "), p.body->name, pose(p));
    text += "],\n\"bodies\": [";
    comma = "\n  ";
    for (const Posed& p : moving)
      text += fmt::format("{}{{\"name\": \"{}\", \"kind\": \"{}\", \"mass\": {}, \"center_of_mass\": {}}}",
                          std::exchange(comma, ",\n  "), p.body->name, kind_name(p.body->kind), p.body->mass,
                          vector(p.body->file_pose.apply_inverse(p.body->pose.position)));
    return text + "],\n\"frames\": [";
  }
  std::string frame(const std::vector<Posed>& moving, const StepRecord& record, bool is_first) const override {
    std::string text = fmt::format("{}{{\"frame\": {}, \"time\": {}, \"bodies\": [", is_first ? "\n  " : ",\n  ",
                                   record.stats.frame, record.stats.time);
    const char* comma = "\n    ";
    for (const Posed& p : moving)
      if (p.body == nullptr)
        text += std::string(std::exchange(comma, ",\n    ")) + "null";
      else
        text += fmt::format(FMT_COMPILE("{}{{{}, \"velocity\": {}, \"angular_velocity\": {}}}"),
                            std::exchange(comma, ",\n    "), pose(p), vector(p.body->velocity),
                            vector(p.body->angular_velocity));
    return text + "]}";
  }
  std::string tail() const override { return "]}\n"; }
};

}  // namespace

Entry<Exporter> poses_csv_exporter() {
  return entry<Exporter, PosesCsv>("poses.csv",
                                   "time, position, quaternion and velocities of rigid bodies, a row a body and frame");
}
Entry<Exporter> poses_json_exporter() { return entry<Exporter, PosesJson>("poses.json", "the same as JSON"); }

}  // namespace impinge
