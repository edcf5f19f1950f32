// Universal Scene Description as text: a mesh a body, where it is and how it is turned by time samples in doubles,
// deformable surfaces as time-sampled points. Points are single precision by the format, so they count from an origin
// of the body's own where it lies far out. Surfaces that several bodies share are written once and referred to.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "viewer/export/export_bodies.hpp"
#include "viewer/export/exporter.hpp"
#include "viewer/export/new_file.hpp"

namespace impinge {

namespace {

/// A number that is whole but for rounding.
double rounded(double value) {
  const double whole = std::round(value);
  return std::abs(value - whole) <= 1e-9 * std::max(1.0, std::abs(value)) ? whole : value;
}

std::string points_text(std::span<const Vec3> points) {
  std::string text = "[";
  for (const Vec3& point : points) {
    const Eigen::Vector3f x = point.cast<float>();
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}({}, {}, {})"), text.size() == 1 ? "" : ", ", x.x(), x.y(),
                   x.z());
  }
  return text + "]";
}

std::string extent_text(std::span<const Vec3> points) {
  Aabb box;
  for (const Vec3& x : points) box.include(x);
  const Vec3 ends[] = {box.min, box.max};
  return points_text(ends);
}

/// What a surface is whatever moves it.
std::string topology(const TriangleMesh& surface, const std::string& indent) {
  std::string counts, corners;
  for (const Triangle& t : surface.triangles) {
    const char* comma = counts.empty() ? "" : ", ";
    fmt::format_to(std::back_inserter(counts), FMT_COMPILE("{}3"), comma);
    fmt::format_to(std::back_inserter(corners), FMT_COMPILE("{}{}, {}, {}"), comma, t[0], t[1], t[2]);
  }
  return fmt::format(
      "{0}int[] faceVertexCounts = [{1}]\n{0}int[] faceVertexIndices = [{2}]\n{0}uniform token subdivisionScheme = "
      "\"none\"\n",
      indent, counts, corners);
}

std::string points_attributes(std::span<const Vec3> points, const std::string& indent) {
  return fmt::format("{0}point3f[] points = {1}\n{0}float3[] extent = {2}\n", indent, points_text(points),
                     extent_text(points));
}

struct Sample {
  double code = 0.0;
  Vec3 position;
  Quat rotation;
};

/// What is kept of a body until all frames are there.
struct Track {
  std::string prim;                          // its name there
  std::vector<Sample> samples;               // of what has a pose
  std::unique_ptr<NewFile> points, extents;  // of a deformable body: its time samples
  std::vector<bool> is_there;                // by frame: added by now, and not deleted
};

class UsdaExporter final : public Exporter {
 public:
  void begin(const ExportJob& job, const StepRecord& start) override;
  void add(const StepRecord& record) override;
  void finish() override;
  std::string result() const override { return codes_.empty() ? "" : path_.string(); }

 private:
  bool is_shared(const ExportBody& body) const { return users_.at(body.surface.get()) > 1; }
  std::string head() const;
  void write_shared(NewFile& file) const;
  void write_body(NewFile& file, std::size_t i) const;
  std::string transform(const ExportBody& body, const Track& track) const;
  std::string visibility(const Track& track) const;

  std::filesystem::path path_;
  std::string name_;
  double codes_per_second_ = 24.0;
  std::vector<ExportBody> bodies_;
  std::vector<Track> tracks_;  // by body
  std::map<const TriangleMesh*, int> users_;
  std::vector<double> codes_;
};

/// A letter or _, then those and digits; not one that is taken.
std::string prim_name(std::string name, std::set<std::string>& taken) {
  for (char& c : name)
    if (c == '-') c = '_';
  while (!taken.insert(name).second) name += '_';
  return name;
}

void UsdaExporter::begin(const ExportJob& job, const StepRecord& start) {
  path_ = job.folder / (job.name + ".usda");
  name_ = job.name;
  codes_per_second_ = rounded(1.0 / job.frame_time);
  bodies_ = export_bodies(start, job.colors);
  std::set<std::string> taken;
  for (const ExportBody& body : bodies_) {
    ++users_[body.surface.get()];
    tracks_.emplace_back().prim = prim_name(body.name, taken);
  }
}

void UsdaExporter::add(const StepRecord& record) {
  const double code = rounded(record.stats.time * codes_per_second_);
  codes_.push_back(code);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const ExportBody& body = bodies_[i];
    Track& track = tracks_[i];
    track.is_there.push_back(there(body, record) != nullptr);
    if (!track.is_there.back()) continue;
    if (body.is_deformable()) {
      if (track.points == nullptr) {
        track.points = std::make_unique<NewFile>(path_.parent_path() / (body.name + ".points"));
        track.extents = std::make_unique<NewFile>(path_.parent_path() / (body.name + ".extents"));
      }
      const std::vector<Vec3> points = local_surface(body, record);
      track.points->append(fmt::format("            {}: {},\n", code, points_text(points)));
      track.extents->append(fmt::format("            {}: {},\n", code, extent_text(points)));
    }
    if (!track.samples.empty() && (body.is_static() || body.is_deformable())) continue;
    const Pose pose = local_pose(body, record);
    const Quat rotation = quaternion_of(
        pose.rotation, track.samples.empty() ? std::nullopt : std::optional(track.samples.back().rotation));
    track.samples.push_back({code, pose.position, rotation});
  }
}

std::string UsdaExporter::head() const {
  return fmt::format(
      "#usda 1.0\n(\n    defaultPrim = \"World\"\n    doc = \"{0}, by impinge {1}\"\n    endTimeCode = {2}\n    "
      "framesPerSecond = {3}\n    metersPerUnit = 1\n    startTimeCode = {4}\n    timeCodesPerSecond = {3}\n    "
      "upAxis = \"Y\"\n)\n\n",
      name_, IMPINGE_VERSION, codes_.back(), codes_per_second_, codes_.front());
}

void UsdaExporter::write_shared(NewFile& file) const {
  std::set<const TriangleMesh*> written;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const ExportBody& body = bodies_[i];
    if (!is_shared(body) || !written.insert(body.surface.get()).second) continue;
    std::vector<Vec3> points = body.surface->vertices;
    for (Vec3& x : points) x -= body.origin;
    file.append(fmt::format("class Mesh \"surface_of_{}\"\n{{\n", tracks_[i].prim) + topology(*body.surface, "    ") +
                points_attributes(points, "    ") + "}\n\n");
  }
}

/// Only where it isn't there all the time.
std::string UsdaExporter::visibility(const Track& track) const {
  const auto word = [](bool is_there) { return is_there ? "inherited" : "invisible"; };
  const std::vector<bool>& all = track.is_there;
  if (std::find(all.begin(), all.end(), !all.front()) == all.end())
    return all.front() ? "" : "        token visibility = \"invisible\"\n";
  std::string samples;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (k == 0 || all[k] != all[k - 1]) samples += fmt::format("            {}: \"{}\",\n", codes_[k], word(all[k]));
  return fmt::format("        token visibility.timeSamples = {{\n{}        }}\n", samples);
}

std::string UsdaExporter::transform(const ExportBody& body, const Track& track) const {
  const auto of_position = [](const Sample& s) {
    return fmt::format(FMT_COMPILE("({}, {}, {})"), s.position.x(), s.position.y(), s.position.z());
  };
  const auto of_rotation = [](const Sample& s) {
    return fmt::format(FMT_COMPILE("({}, {}, {}, {})"), s.rotation.w(), s.rotation.x(), s.rotation.y(), s.rotation.z());
  };
  const auto attribute = [&](const std::string& name, const auto& text) {
    const Pose start = start_pose(body);
    const std::string first =
        text(track.samples.empty() ? Sample{0.0, start.position, quaternion_of(start.rotation, std::nullopt)}
                                   : track.samples.front());
    std::string samples;
    bool moves = false;
    for (std::size_t k = 0; k < track.samples.size(); ++k) {
      const std::string now = text(track.samples[k]);
      moves = moves || now != first;
      samples += fmt::format("            {}: {},\n", track.samples[k].code, now);
    }
    return moves ? fmt::format("        {}.timeSamples = {{\n{}        }}\n", name, samples)
                 : fmt::format("        {} = {}\n", name, first);
  };
  return attribute("double3 xformOp:translate", of_position) + attribute("quatd xformOp:orient", of_rotation) +
         "        uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]\n";
}

void UsdaExporter::write_body(NewFile& file, std::size_t i) const {
  const ExportBody& body = bodies_[i];
  const Track& track = tracks_[i];
  std::string about;
  if (track.prim != body.name)
    about += fmt::format("        customData = {{\n            string name = \"{}\"\n        }}\n", body.name);
  if (is_shared(body)) {
    const auto first =
        std::find_if(bodies_.begin(), bodies_.end(), [&](const ExportBody& b) { return b.surface == body.surface; });
    about += fmt::format("        prepend references = </surface_of_{}>\n",
                         tracks_[static_cast<std::size_t>(first - bodies_.begin())].prim);
  }
  file.append(
      fmt::format("    def Mesh \"{}\"{}\n    {{\n", track.prim, about.empty() ? "" : " (\n" + about + "    )"));
  const std::string indent(8, ' ');
  if (!is_shared(body)) file.append(topology(*body.surface, indent));
  if (track.points != nullptr) {
    for (const auto& [name, spool] :
         {std::pair{"point3f[] points", track.points.get()}, {"float3[] extent", track.extents.get()}}) {
      file.append(fmt::format("{}{}.timeSamples = {{\n", indent, name));
      spool->read_back([&](std::string_view piece) { file.append(piece); });
      file.append(indent + "}\n");
    }
  } else if (!is_shared(body)) {
    std::vector<Vec3> points = body.surface->vertices;
    for (Vec3& x : points) x -= body.origin;
    file.append(points_attributes(points, indent));
  }
  const Vec3 color = linear_color(body.color);
  file.append(fmt::format("{}color3f[] primvars:displayColor = [({:.5f}, {:.5f}, {:.5f})]\n", indent, color.x(),
                          color.y(), color.z()) +
              visibility(track) + transform(body, track) + "    }\n");
}

void UsdaExporter::finish() {
  if (codes_.empty()) return;
  NewFile file(path_);
  file.append(head());
  write_shared(file);
  file.append("def Xform \"World\"\n{\n");
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (i > 0) file.append("\n");
    write_body(file, i);
  }
  file.append("}\n");
  file.keep();
}

}  // namespace

Entry<Exporter> usda_exporter() {
  return entry<Exporter, UsdaExporter>("usda", "Universal Scene Description as text, with time samples");
}

}  // namespace impinge
