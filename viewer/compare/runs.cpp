#include "viewer/compare/runs.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "engine/core/utf8.hpp"
#include "engine/io/paths.hpp"
#include "viewer/compare/output_files.hpp"
#include "viewer/compare/run_comparison.hpp"
#include "viewer/image/contact_sheet.hpp"
#include "viewer/image/difference.hpp"
#include "viewer/image/label.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/plot_picture.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMostLines = 12;  // of settings and of fields, on the terminal
constexpr int kMostRows = 8;            // frames of the sheet

/// The bodies' largest distance at a frame that was made again.
struct Distance {
  double metres = 0.0;
  std::string body;
};

class Comparison {
 public:
  explicit Comparison(const RunsOptions& options)
      : tolerance_(options.tolerance), out_(options.out), a_(options.a), b_(options.b) {
    for (const RecordedRun* run : {&a_, &b_}) check_utf8_name(absolute_path(run->folder()).string());
    if (!out_.empty()) files_.make_folder(out_);
  }

  int run() {
    say_settings();
    common_ = static_cast<int>(std::min(a_.rows().size(), b_.rows().size()));
    if (a_.rows().size() != b_.rows().size())
      fmt::print("frames: A has {}, B has {}; the first {} are compared\n", a_.rows().size(), b_.rows().size(),
                 common_);
    first_ = first_difference();
    if (first_ < 0) {
      fmt::print("states: {} frames compared, every state hash is the same\n", common_);
      return 0;
    }
    fmt::print("states: the first that differs is frame {} of {} (hash {} in A, {} in B)\n", first_, common_,
               hash(a_, first_), hash(b_, first_));
    say_fields();
    measure();
    if (!out_.empty()) write();
    return 1;
  }

 private:
  static const std::string& hash(const RecordedRun& run, int frame) {
    return run.rows()[static_cast<std::size_t>(frame)].state_hash;
  }

  int first_difference() const {
    for (int frame = 0; frame < common_; ++frame)
      if (hash(a_, frame) != hash(b_, frame)) return frame;
    return -1;
  }

  static std::string brief(const std::string& value) {
    if (value.empty()) return "(none)";
    return value.size() > 60 ? fmt::format("{:.57}...", value) : value;
  }

  void say_settings() const {
    const std::vector<SettingDifference> differences = setting_differences(a_, b_);
    if (differences.empty()) {
      fmt::print("settings: the same\n");
      return;
    }
    fmt::print("settings: {} differ{}\n", differences.size(), differences.size() == 1 ? "s" : "");
    for (std::size_t i = 0; i < differences.size() && i < kMostLines; ++i)
      fmt::print("  {}: {} in A, {} in B\n", differences[i].path, brief(differences[i].a), brief(differences[i].b));
    if (differences.size() > kMostLines) fmt::print("  and {} more\n", differences.size() - kMostLines);
  }

  void say_fields() {
    is_repeatable_ = go_to(first_);
    if (!is_repeatable_) return;
    const std::vector<FieldDifference> fields = field_differences(a_.record(), b_.record());
    const std::vector<std::string> alone = bodies_of_one(a_.record(), b_.record());
    for (const std::string& name : alone) fmt::print("body:   {}\n", name);
    if (fields.empty())
      fmt::print("body:   {}; what contacts remember (warm start), sleep timers or the time differ\n",
                 alone.empty() ? "none differs in position or velocity" : "those in both don't differ");
    say_bodies(fields);
  }

  /// A line a body, those that moved the farthest first.
  static void say_bodies(const std::vector<FieldDifference>& fields) {
    struct Line {
      std::string body, text;
      double moved = 0.0;
    };
    std::vector<Line> lines;
    for (const FieldDifference& f : fields) {
      if (lines.empty() || lines.back().body != f.body) lines.emplace_back().body = f.body;
      Line& line = lines.back();
      line.text += fmt::format("{}{}{}{}", line.text.empty() ? "" : ", ", f.field,
                               f.unit.empty() ? "" : fmt::format(" by {:.3g} {}", f.largest, f.unit),
                               f.where.empty() ? "" : " at " + f.where);
      if (f.field == "position") line.moved = f.largest;
    }
    std::stable_sort(lines.begin(), lines.end(), [](const Line& l, const Line& r) { return l.moved > r.moved; });
    for (std::size_t i = 0; i < lines.size() && i < kMostLines; ++i)
      fmt::print("{} {}: {}\n", i == 0 ? "body:  " : "       ", lines[i].body, lines[i].text);
    if (lines.size() > kMostLines) fmt::print("        and {} more bodies\n", lines.size() - kMostLines);
  }

  bool go_to(int frame) {
    for (const auto& [run, side] : {std::pair{&a_, "A"}, {&b_, "B"}})
      if (!run->go_to(frame)) {
        fmt::print(
            "bodies: frame {} of {} made again has another hash than the recorded one (another version or machine?); "
            "bodies are not compared\n",
            frame, side);
        return false;
      }
    return true;
  }

  /// At the first difference, and wherever both have a snapshot: nothing is simulated for these.
  void measure() {
    for (int frame = first_; frame < common_ && is_repeatable_; ++frame) {
      if (frame != first_ && !(a_.has_snapshot(frame) && b_.has_snapshot(frame))) continue;
      if (frame != first_ && !(is_repeatable_ = go_to(frame))) break;
      Distance largest;
      for (const FieldDifference& f : field_differences(a_.record(), b_.record()))
        if (f.field == "position" && f.largest > largest.metres) largest = {f.largest, f.body};
      distances_[frame] = largest;
    }
    if (distances_.empty()) return;
    const auto worst = std::max_element(distances_.begin(), distances_.end(),
                                        [](const auto& l, const auto& r) { return l.second.metres < r.second.metres; });
    const auto& [last, distance] = *distances_.rbegin();
    if (worst->second.metres > 0.0)
      fmt::print("apart:  at most {:.3g} m ({}, frame {}){}; {:.3g} m in frame {}\n", worst->second.metres,
                 worst->second.body, worst->first, distances_.size() > 1 ? ", of the frames with snapshots" : "",
                 distance.metres, last);
  }

  // by name: a judged run has more columns
  double figure(const RecordedRun& run, int frame, const std::string& name) const {
    const std::vector<std::string>& names = run.columns();
    const auto it = std::find(names.begin(), names.end(), name);
    return it == names.end()
               ? std::nan("")
               : run.rows()[static_cast<std::size_t>(frame)].figures[static_cast<std::size_t>(it - names.begin())];
  }

  /// What tells two runs apart: no times, and only what both files have.
  bool is_compared(const std::string& name) const {
    return name != "frame" && name != "time_s" && find_figure(name)->kind != FigureKind::time &&
           !std::isnan(figure(a_, 0, name)) && !std::isnan(figure(b_, 0, name));
  }

  void write() {
    std::vector<std::string> figures;
    for (const std::string& name : a_.columns())
      if (is_compared(name)) figures.push_back(name);
    std::string csv = "frame,time_a_s,time_b_s,same_state,position_m,body";
    for (const std::string& name : figures) csv += ",abs_" + name;
    csv += "\n";
    std::map<std::string, PlotSeries> lines;
    for (int frame = 0; frame < common_; ++frame) {
      const auto it = distances_.find(frame);
      const bool known = frame < first_ || it != distances_.end();
      const double metres = it == distances_.end() ? 0.0 : it->second.metres;
      csv += fmt::format("{},{},{},{},{},{}", frame, figure(a_, frame, "time_s"), figure(b_, frame, "time_s"),
                         hash(a_, frame) == hash(b_, frame) ? 1 : 0, known ? fmt::format("{}", metres) : "",
                         it == distances_.end() ? "" : it->second.body);
      if (it != distances_.end()) lines["position"].points.push_back(Vec2(frame, metres > 0.0 ? metres : std::nan("")));
      for (const std::string& name : figures) {
        const double difference = std::abs(figure(a_, frame, name) - figure(b_, frame, name));
        csv += fmt::format(",{}", difference);
        lines[name].points.push_back(Vec2(frame, difference > 0.0 ? difference : std::nan("")));
      }
      csv += "\n";
    }
    files_.write(out_ / "difference.csv", csv);
    write_plot(lines);
    const std::string sheet = write_sheet();
    files_.keep();
    fmt::print("figures: {}\nplot:   {}\nsheet:  {}\n", (out_ / "difference.csv").string(),
               (out_ / "difference.png").string(), sheet);
  }

  void write_plot(std::map<std::string, PlotSeries>& lines) {
    Plot plot;
    plot.title = fmt::format("A {} and B {}: how far apart", name_of(a_), name_of(b_));
    plot.x_label = "frame";
    plot.y_label = fmt::format("absolute difference; the states part in frame {}", first_);
    plot.x_linear = true;
    for (const auto& [key, name] : {std::pair{"position", "position of a body (m), the largest"},
                                    {"max_penetration_m", "max. penetration (m)"},
                                    {"kinetic_J", "kinetic energy (J)"},
                                    {"elastic_J", "elastic energy (J)"},
                                    {"momentum_y", "momentum, y (kg m/s)"},
                                    {"contacts", "contacts"}}) {
      PlotSeries series = lines[key];
      series.name = name;
      if (std::any_of(series.points.begin(), series.points.end(), [](const Vec2& p) { return std::isfinite(p.y()); }))
        plot.series.push_back(std::move(series));
    }
    files_.write(out_ / "difference.png", encode_png(paint_plots({plot}, 1280, 720).front()));
  }

  static std::string name_of(const RecordedRun& run) {
    const fs::path folder = absolute_path(run.folder()).lexically_normal();
    return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
  }

  /// The first frame that differs, and later ones evenly: A, B, and what differs. Returns the file, or why there is
  /// none.
  std::string write_sheet() {
    std::vector<int> frames;
    const int last = common_ - 1, count = std::min(kMostRows, last - first_ + 1);
    frames.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) frames.push_back(first_ + (count == 1 ? 0 : k * (last - first_) / (count - 1)));
    for (const int frame : frames)
      for (const RecordedRun* run : {&a_, &b_})
        if (!is_file(run->picture(frame)))
          return fmt::format("none: {} has no picture of frame {}", run->folder().string(), frame);
    constexpr int kMargin = 10, kScale = 2, kLine = text_height(kScale) + 4, kWidth = 400;
    constexpr Rgb kPaper = {18, 20, 24}, kInk = {225, 225, 225};
    Image sheet;
    int width = 0, height = 0, y = kMargin;
    for (const int frame : frames) {
      const Image a = read_png(a_.picture(frame)), b = read_png(b_.picture(frame));
      if (a.width != b.width || a.height != b.height)
        return fmt::format("none: frame {} has {}x{} pixels in A and {}x{} in B", frame, a.width, a.height, b.width,
                           b.height);
      if (sheet.rgb.empty()) {
        width = std::min(kWidth, a.width), height = std::max(1, width * a.height / a.width);
        sheet = Image(4 * kMargin + 3 * width, kMargin + count * (height + kLine + kMargin));
        fill_rectangle(sheet, 0, 0, sheet.width, sheet.height, kPaper);
      }
      DifferenceSettings settings;
      settings.tolerance = tolerance_;
      const Difference difference = compare(a, b, settings);
      const Image overlay = difference_overlay(a, b, tolerance_, 1);
      const std::array<std::string, 3> captions = {
          fmt::format("A, frame {}", frame), "B",
          difference.identical ? "the same pixels" : fmt::format("{} pixels differ", difference.differing)};
      const std::array<const Image*, 3> images = {&a, &b, &overlay};
      for (int k = 0; k < 3; ++k) {
        const int x = kMargin + k * (width + kMargin);
        draw_text(sheet, x, y, captions[static_cast<std::size_t>(k)], kInk, kScale);
        const Image small = reduce_image(*images[static_cast<std::size_t>(k)], width, height);
        for (int row = 0; row < height; ++row)
          std::copy_n(small.pixel(0, row), 3 * width, sheet.pixel(x, y + kLine + row));
      }
      y += height + kLine + kMargin;
    }
    files_.write(out_ / "sheet.png", encode_png(sheet));
    return (out_ / "sheet.png").string();
  }

  int tolerance_;
  fs::path out_;
  OutputFiles files_;
  RecordedRun a_, b_;
  int common_ = 0, first_ = -1;
  bool is_repeatable_ = false;
  std::map<int, Distance> distances_;  // by frame
};

}  // namespace

int compare_runs(const RunsOptions& options) { return Comparison(options).run(); }

}  // namespace impinge
