#include "viewer/sweep/job.hpp"

#include <fmt/format.h>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/former_paths.hpp"
#include "engine/io/scene/scene_overrides.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "viewer/sweep/table.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kMostOfRecord = std::uint64_t{1} << 24;

std::string text_list(const std::vector<std::string>& texts) {
  std::string out = "[\n";
  for (const std::string& text : texts) out += fmt::format("  {},\n", toml_string(text));
  return out + "]";
}

const TomlNode& need(const TomlNode& table, const char* key) {
  const TomlEntry* entry = table.find(key);
  if (entry == nullptr)
    refuse(table.place, fmt::format("no '{}'", key), "the file as a sweep wrote it is wanted",
           "remove the job's folder and run the sweep again");
  return entry->value;
}

std::vector<std::string> texts_of(const TomlNode& node) {
  std::vector<std::string> texts;
  for (const TomlNode& item : node.items) texts.push_back(scene_text(item, "text"));
  return texts;
}

int whole_of(const TomlNode& node, const char* what) { return static_cast<int>(scene_real(node, what, {0, 1e9})); }

}  // namespace

SessionOptions sweep_session_options(const RunOptions& options) {
  SessionOptions session;
  session.width = options.width, session.height = options.height;
  session.judge = options.judge, session.judge_substeps = options.judge_substeps;
  return session;
}

SweepBase::SweepBase(const RunOptions& options)
    : options_(options),
      session_(options.scene, options.overrides, options.script, sweep_session_options(options)),
      last_frame_(options.frames.value_or(session_.default_last_frame())) {}

std::string SweepBase::hash(const std::vector<std::string>& changes) const {
  RunRecord record = session_.run_record();
  record.scene = record.folder = record.script_file = "";
  record.frames = last_frame_;
  record.images = options_.images;
  record.contacts = options_.contacts;
  record.export_ply = options_.export_ply;
  record.width = options_.width;
  record.height = options_.height;

  Scene scene = session_.scene();
  TomlNode root, bodies;
  bodies.kind = TomlNode::array;
  bodies.items = scene.bodies;
  root.entries.push_back({"body", "", bodies});
  std::vector<std::pair<const Parameter*, ParameterValue>> before;
  std::vector<std::string> former;
  for (const std::string& change : renamed_overrides(changes, session_.rows(), former)) {
    const std::size_t equals = change.find('=');
    const Parameter* row = session_.rows().find(change.substr(0, equals));
    if (row == nullptr) {
      apply_overrides(root, {change});
      // bodies are recorded as given: a real number has a point, as in most scenes
    } else if (change.rfind("body.", 0) == 0) {
      apply_overrides(
          root, {change.substr(0, equals + 1) + format_toml(toml_node(parse_value(*row, change.substr(equals + 1))))});
    } else {
      before.emplace_back(row, row->get());
      row->set(parse_value(*row, change.substr(equals + 1)));
    }
  }
  scene.bodies = root.find("body")->value.items;
  const std::string resolved = format_run(scene, session_.rows(), record);
  while (!before.empty()) before.back().first->set(before.back().second), before.pop_back();
  return hex64(hash_bytes(resolved));
}

void write_sweep_job(const fs::path& folder, const SweepJob& job) {
  const RunOptions& o = job.options;
  std::string text = "# one job of a sweep; impinge sweep --job runs it alone\n";
  text += fmt::format("hash = \"{}\"\nreference = \"{}\"\nscene = {}\nscript = {}\n", job.hash, job.reference,
                      toml_string(o.scene.string()), toml_string(o.script.string()));
  text += fmt::format("set = {}\nvary = {}\nframes = {}\nsize = [{}, {}]\nimages = {}\nsurfaces = {}\ncontacts = {}\n",
                      text_list(o.overrides), text_list(job.changes), o.frames.value_or(0), o.width, o.height, o.images,
                      o.export_ply, o.contacts);
  if (o.judge) text += fmt::format("judge = true\njudge_substeps = {}\n", o.judge_substeps);
  write_file(folder / "job.toml", text);
}

SweepJob read_sweep_job(const fs::path& folder) {
  const fs::path file = folder / "job.toml";
  const TomlNode table = parse_toml(file.string(), read_file(file, kMostOfRecord));
  SweepJob job;
  job.hash = scene_text(need(table, "hash"), "hash");
  job.reference = scene_text(need(table, "reference"), "reference");
  job.options.scene = scene_text(need(table, "scene"), "scene");
  job.options.script = scene_text(need(table, "script"), "script");
  job.options.overrides = texts_of(need(table, "set"));
  job.changes = texts_of(need(table, "vary"));
  job.options.frames = whole_of(need(table, "frames"), "frames");
  const TomlNode& size = need(table, "size");
  if (size.items.size() != 2)
    refuse(size.place, "size is no pair", "[width, height] is wanted",
           "remove the job's folder and run the sweep again");
  job.options.width = whole_of(size.items[0], "size");
  job.options.height = whole_of(size.items[1], "size");
  job.options.images = scene_flag(need(table, "images"), "images");
  job.options.export_ply = scene_flag(need(table, "surfaces"), "surfaces");
  job.options.contacts = scene_flag(need(table, "contacts"), "contacts");
  // an older sweep's jobs were not judged
  if (const TomlEntry* judge = table.find("judge")) {
    job.options.judge = scene_flag(judge->value, "judge");
    job.options.judge_substeps = scene_flag(need(table, "judge_substeps"), "judge_substeps");
  }
  return job;
}

const char* status_name(SweepOutcome::Status status) {
  constexpr const char* kNames[] = {"done",    "failed",      "diverged", "refused",
                                    "crashed", "interrupted", "unequal",  "open"};
  return kNames[status];
}

SweepOutcome read_sweep_outcome(const fs::path& folder) {
  SweepOutcome outcome;
  for (const char* name : {"done", "failed"}) {
    const fs::path file = folder / name;
    if (!is_file(file)) continue;
    const TomlNode table = parse_toml(file.string(), read_file(file, kMostOfRecord));
    const std::string status = scene_text(need(table, "status"), "status");
    for (int s = 0; s <= SweepOutcome::open; ++s)
      if (status == status_name(static_cast<SweepOutcome::Status>(s)))
        outcome.status = static_cast<SweepOutcome::Status>(s);
    outcome.reason = scene_text(need(table, "reason"), "reason");
    outcome.wall_ms = scene_real(need(table, "wall_ms"), "wall_ms", {0, 1e15});
    return outcome;
  }
  return outcome;
}

bool has_what_was_asked(const fs::path& folder, const SweepJob& job) {
  if (folder.parent_path().filename() == "repeats") return true;
  const fs::path run = folder / "run";
  const std::vector<StatsLine> lines = sweep_stats(run);
  if (lines.empty()) return true;
  // what goes goes from the first on
  for (const std::size_t frame : {std::size_t{0}, lines.size() - 1}) {
    if (job.options.export_ply && !is_folder(run / "surfaces" / fmt::format("{:06}", frame))) return false;
    if (job.options.images && !is_file(run / "frames" / fmt::format("{:06}.png", frame))) return false;
  }
  return true;
}

fs::path job_folder(const fs::path& out, const std::string& hash) { return out / "jobs" / hash; }

fs::path repeat_folder(const fs::path& job, int k) { return k <= 1 ? job : job / "repeats" / std::to_string(k); }

}  // namespace impinge
