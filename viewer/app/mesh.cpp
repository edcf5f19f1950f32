// impinge mesh: what a surface file is, and what makes the boundary of a solid of it.
#include <fmt/format.h>

#include <charconv>

#include "engine/core/error.hpp"
#include "engine/core/memory.hpp"
#include "engine/geometry/mend/remesh.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "engine/io/meshes/mesh_memory.hpp"
#include "engine/io/meshes/mesh_unit.hpp"
#include "viewer/app/shared_options.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/mesh_picture.hpp"
#include "viewer/report/mesh_report.hpp"

namespace impinge {

namespace {

class MeshCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.words("FILE", files_, "surface files; several make a table");
    options.flag("--mend", mends_, "make the boundary of a solid of it, and say what was done");
    options.path("--out", out_, "with --mend, --decimate or --unit: the PLY file to write, in metres");
    options.path("--picture", picture_, "the PNG file to draw it to, faults marked; mended if --mend is given");
    options.flag("--json", json_, "for programs: lengths in metres");
    options.text("--unit", unit_,
                 "what the file's numbers are in: m, mm, cm, dm, km, inch, foot, ... (default: metres)");
    real_option(options, "--weld", mend_.weld, 0.0, "with --mend: metres between border vertices that are one");
    real_option(options, "--thickness", mend_.thickness, 1e-9, "with --mend: of parts that stay open, metres");
    options.whole("--remesh", mend_.remesh, 8, 400,
                  "with --mend: then a new skin of so many cells along the longest side, without crossings");
    options.whole("--decimate", decimate_, 4, 100'000'000,
                  "make so many triangles of it at most, mended first if --mend is given; the volume stays");
    size_option(options, width_, height_, "WIDTHxHEIGHT of the picture (default: 1280x720)");
    memory_option(options);
    threads_option(options);
  }

  int run() override;

 private:
  static void real_option(Options& options, const char* name, std::optional<double>& to, double low,
                          const std::string& doc) {
    options.other(
        name,
        [name, low, &to](const std::string& text) {
          double value = 0.0;
          const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
          if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= 1e6))
            refuse_option(fmt::format("{} is '{}'", name, text), fmt::format("metres from {} to 1e6 are wanted", low),
                          "change it");
          to = value;
        },
        doc);
  }

  void check() const;
  MeshReport look_at(const std::string& file);
  void decimate_it(const std::string& file, TriangleMesh& mesh, MeshReport& report) const;

  std::vector<std::string> files_;
  std::filesystem::path out_, picture_;
  std::string unit_;
  bool mends_ = false, json_ = false;
  MendSettings mend_;
  std::optional<int> decimate_;
  int width_ = 1280, height_ = 720;
};

void MeshCommand::check() const {
  if (files_.size() > 1 && (!out_.empty() || !picture_.empty()))
    refuse_option(fmt::format("{} with {} files", out_.empty() ? "--picture" : "--out", files_.size()),
                  "one file at a time is written", "name one");
  const bool has_settings = mend_.weld || mend_.thickness || mend_.remesh > 0;
  if (!mends_ && has_settings)
    refuse_option("--weld, --thickness or --remesh without --mend", "they say how to mend", "add --mend");
  if (!out_.empty() && !mends_ && !decimate_ && unit_.empty())
    refuse_option("--out without --mend", "what is mended, decimated or in another unit is written", "add --mend");
  if (!out_.empty() && out_.extension() != ".ply")
    refuse_option(fmt::format("--out is '{}'", out_.string()), "a PLY file is written", "end its name with .ply");
  if (!picture_.empty() && picture_.extension() != ".png")
    refuse_option(fmt::format("--picture is '{}'", picture_.string()), "a PNG file is written",
                  "end its name with .png");
}

void MeshCommand::decimate_it(const std::string& file, TriangleMesh& mesh, MeshReport& report) const {
  const std::string what = fmt::format("{} with --decimate {}", file, *decimate_);
  if (!make_topology(mesh).is_closed()) mesh = weld(mesh).mesh;
  if (const auto problem = check_indices(mesh))
    throw InputError(fmt::format("{}: {}; or add --mend, which drops such triangles", what, *problem));
  check_memory("", what, decimate_memory(mesh), "simplify it");
  DecimatedMesh few = decimate(mesh, *decimate_);
  report.decimated = few.report;
  if (few.report.triangles_after > *decimate_)
    throw InputError(
        fmt::format("{}: it goes down to {} triangles: then it would cross itself, or lose a part, a hole "
                    "or a handle; use {} or more",
                    what, few.report.triangles_after, few.report.triangles_after));
  mesh = std::move(few.mesh);
}

MeshReport MeshCommand::look_at(const std::string& file) {
  MeshReport report;
  report.file = file;
  const MeshCount count = estimate_mesh(file);
  check_memory("", fmt::format("{} ({}, about {:.2g} triangles)", file, describe_bytes(count.bytes), count.triangles),
               4.0 * surface_memory(count), "simplify it");
  MeshOrigin origin;
  TriangleMesh mesh = read_mesh(file, {}, &origin);
  report.says_unit = !origin.unit.empty() || !unit_.empty();
  report.unit = origin.unit.empty() ? "unit not said: taken for metres" : "unit: " + origin.unit;
  if (!unit_.empty()) {
    if (!origin.unit.empty())
      refuse_option(fmt::format("--unit with {}, whose unit is {}", file, origin.unit), "a file that says none has one",
                    "leave it out");
    const double metres = *metres_of(unit_);
    for (Vec3& x : mesh.vertices) x *= metres;
    report.unit = fmt::format("unit: {}", unit_);
  }
  report.file_vertices = mesh.vertices.size();
  MeshMarks marks;
  MeshMarks* wanted = picture_.empty() ? nullptr : &marks;
  report.facts = measure(mesh, mends_ || decimate_ ? nullptr : wanted);
  if (mends_) {
    if (mend_.remesh > 0)
      check_memory("", fmt::format("{} with --remesh {}", file, mend_.remesh), remesh_memory(mesh, mend_.remesh),
                   "use fewer cells");
    const std::optional<double> enclosed = enclosed_volume(mesh);
    MendedMesh mended = mend(std::move(mesh), mend_);
    constexpr double kRounding = 5e-3;  // of what rays find
    if (enclosed && mended.report.volume_before > (1.0 + kRounding) * *enclosed) report.enclosed = enclosed;
    mesh = std::move(mended.mesh);
    report.mended = mended.report;
    report.problem_left = mended.problem;
  }
  if (decimate_) decimate_it(file, mesh, report);
  if (mends_ || decimate_) report.after = measure(mesh, wanted);
  if (!out_.empty() && report.problem_left)
    throw InputError(fmt::format("{}: {}, even mended; nothing is written; a solid is wanted; try --remesh 100", file,
                                 *report.problem_left));
  if (!out_.empty()) {
    write_ply(out_, mesh.vertices, mesh.triangles);
    report.written = out_.string();
  }
  if (!picture_.empty())
    write_png(picture_, mesh_picture(marks,
                                     std::filesystem::path(file).filename().string() + (mends_ ? ", mended" : "") +
                                         (decimate_ ? fmt::format(", {} triangles", mesh.triangles.size()) : ""),
                                     fault_lines(report.after ? *report.after : report.facts), width_, height_));
  return report;
}

int MeshCommand::run() {
  check();
  if (!unit_.empty() && !metres_of(unit_))
    refuse_option(fmt::format("--unit is '{}'", unit_), fmt::format("allowed: {}", unit_names()), "use one of them");
  if (files_.size() == 1) {
    const MeshReport report = look_at(files_[0]);
    fmt::print("{}", json_ ? mesh_json({report}) : mesh_page(report));
    return 0;
  }
  std::vector<MeshReport> reports;
  bool all_read = true;
  for (const std::string& file : files_) {
    try {
      reports.push_back(look_at(file));
    } catch (const InputError& error) {
      reports.emplace_back();
      reports.back().file = file;
      reports.back().error = error.what();
      all_read = false;
    }
  }
  fmt::print("{}", json_ ? mesh_json(reports) : mesh_table(reports));
  return all_read ? 0 : 2;
}

}  // namespace

Entry<SubCommand> mesh_command() {
  return entry<SubCommand, MeshCommand>("mesh", "what a surface file is, and what mends it");
}

}  // namespace impinge
