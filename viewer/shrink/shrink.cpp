#include "viewer/shrink/shrink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "engine/core/interrupt.hpp"
#include "engine/io/file.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "viewer/shrink/fewest.hpp"
#include "viewer/shrink/smaller_mesh.hpp"
#include "viewer/shrink/trial.hpp"

namespace impinge {

namespace {

constexpr int kMostRounds = 4;
constexpr std::size_t kMostParts = 2000;  // of one surface, that are tried

SceneSize size_of(const Trial& trial) {
  return {trial.scene.scene.bodies.size(), trial.scene.scene.attachments.size(), trial.scene.run.script.size(),
          trial.triangles, trial.frame + 1};
}

class Shrinking {
 public:
  Shrinking(const UnpackedBundle& bundle, const ShrinkOptions& options,
            const std::function<void(const ShrinkProgress&)>& watch)
      : options_(options),
        watch_(watch),
        trials_(bundle.folder(), options.condition, bundle.lines("opening.script")),
        best_(trials_.first(bundle.folder() / "run.toml", bundle.head().frame)),
        before_(size_of(best_)) {
    before_.frames = bundle.head().frame + 1;
    // what a condition speaks of stays
    for (const std::string& name : best_.scene.bodies())
      if (names_one_of(options.condition, {name})) wanted_.push_back(name);
    write();
  }

  void run() {
    for (int round = 0; round < kMostRounds; ++round) {
      const int adopted = adopted_;
      drop_bodies();
      drop_attachments();
      drop_lines();
      begin_later();
      if (adopted == adopted_) break;
    }
    replace_surfaces();
    drop_bodies();
    begin_with_state();
    if (!best_.scene.run.start.empty()) drop_bodies(), drop_added();  // of those that took part only before it
    trials_.complete(best_);
    write();
  }

  ShrinkResult result() const { return {before_, size_of(best_), trials_.tried(), false, notes_}; }

 private:
  /// Whether the condition comes true in the scene, in the same frame or an earlier one. Then it is the best by now.
  bool adopt(const SmallScene& scene, int last_frame) {
    watch_({size_of(best_), at_, trials_.tried(), left_ = std::max(0, left_ - 1)});
    std::optional<Trial> trial = trials_.run(scene, last_frame);
    if (!trial) return false;
    best_ = std::move(*trial);
    ++adopted_;
    write();
    return true;
  }
  bool adopt(const SmallScene& scene) { return adopt(scene, best_.frame); }

  void begin(const char* what, std::size_t units) {
    at_ = what;
    left_ = static_cast<int>(units) + (at_ == std::string("triangles") ? 0 : kLater);
  }

  void write() const { write_file(options_.out, format_bundle(best_.head, best_.parts)); }

  void drop_bodies() {
    std::vector<std::string> others;
    for (const std::string& name : best_.scene.bodies())
      if (std::find(wanted_.begin(), wanted_.end(), name) == wanted_.end()) others.push_back(name);
    begin("bodies", 2 * others.size());
    fewest<std::string>(others, [&](const std::vector<std::string>& some) {
      std::vector<std::string> names = wanted_;
      names.insert(names.end(), some.begin(), some.end());
      if (names.size() >= best_.scene.scene.bodies.size()) return false;
      const std::optional<SmallScene> less = trials_.with_bodies(best_.scene, names);
      return less && adopt(*less);
    });
  }

  /// Bodies that lines add, and that a state with which it begins has.
  void drop_added() {
    const std::vector<std::string> added = best_.scene.added();
    begin("bodies", added.size());
    for (const std::string& name : added) {
      if (names_one_of(options_.condition, {name})) continue;
      const std::optional<SmallScene> less = trials_.without_added(best_.scene, name);
      if (less) adopt(*less);
    }
  }

  void drop_attachments() {
    const SmallScene from = best_.scene;
    std::vector<std::size_t> places(from.scene.attachments.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    begin("attachments", 2 * places.size());
    fewest<std::size_t>(places,
                        [&](const std::vector<std::size_t>& some) { return adopt(from.with_attachments(some)); });
  }

  void drop_lines() {
    begin("commands", 2 * best_.scene.run.script.size());
    fewest<std::string>(best_.scene.run.script,
                        [&](const std::vector<std::string>& some) { return adopt(best_.scene.with_lines(some)); });
  }

  /// As late as can be: one frame before it comes true, two, four, ...
  void begin_later() {
    const SmallScene from = best_.scene;
    const int end = best_.frame;
    begin("frames", 12);
    for (int before = 1; before < end; before *= 2) {
      const std::optional<SmallScene> later = trials_.begun_at(from, end - before);
      if (!later) return;
      if (adopt(*later, std::min(end - 1, 2 * before))) return;
    }
  }

  /// Where a scene can't say how it is by then, a state does.
  void begin_with_state() {
    const SmallScene from = best_.scene;
    const int end = best_.frame;
    if (end < 2) return;
    begin("frames", 1);
    for (int before = 1; before < end; before *= 2) {
      const std::optional<SmallScene> later = trials_.begun_with(from, end - before);
      if (!later) return note("no frames are left out at the beginning: a ramp of the script would be cut in two");
      if (!adopt(*later, std::min(end - 1, 2 * before))) continue;
      return note("it begins with a state, start.bin, which is read by this version only");
    }
  }

  /// Of each file the parts that are needed, then the coarsest of what may stand in its place.
  void replace_surfaces() {
    std::vector<std::string> names;
    for (const SurfaceFile& file : best_.scene.scene.surfaces)
      if (file.triangles > 0) names.push_back(file.name);
    for (const std::string& name : names) {
      const std::filesystem::path path = trials_.folder() / name;
      TriangleMesh mesh = read_mesh(path, FileGuard(trials_.folder()));
      std::string now = name;
      const auto try_mesh = [&](const TriangleMesh& other) {
        const std::string file = fmt::format("meshes/small_{}.ply", ++files_);
        write_ply(trials_.folder() / file, other.vertices, other.triangles);
        if (!adopt(best_.scene.with_surface(now, file))) return false;
        now = file, mesh = other;
        return true;
      };
      if (const std::vector<std::vector<int>> parts = connected_parts(mesh); parts.size() > 1) {
        begin("triangles", 2 * parts.size());
        const TriangleMesh whole = mesh;
        if (parts.size() <= kMostParts)
          fewest<std::vector<int>>(parts, [&](const std::vector<std::vector<int>>& some) {
            std::vector<int> triangles;
            for (const std::vector<int>& part : some) triangles.insert(triangles.end(), part.begin(), part.end());
            return !triangles.empty() && try_mesh(with_triangles(whole, triangles));
          });
        else
          note(fmt::format("{}: has {} connected parts, which were not tried one by one", name, parts.size()));
      }
      const std::vector<TriangleMesh> smaller = smaller_meshes(mesh);
      begin("triangles", smaller.size());
      std::find_if(smaller.begin(), smaller.end(), try_mesh);
    }
  }

  void note(const std::string& text) {
    if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
  }

  static constexpr int kLater = 16;  // scenes of what comes behind, at a guess
  const ShrinkOptions& options_;
  const std::function<void(const ShrinkProgress&)>& watch_;
  Trials trials_;
  Trial best_;
  SceneSize before_;
  std::vector<std::string> wanted_, notes_;
  const char* at_ = "";
  int left_ = 0, adopted_ = 0, files_ = 0;
};

}  // namespace

ShrinkResult shrink(const ShrinkOptions& options, const std::function<void(const ShrinkProgress&)>& watch) {
  const UnpackedBundle bundle(options.bundle);
  Shrinking shrinking(bundle, options, watch);
  bool interrupted = false;
  try {
    shrinking.run();
  } catch (const Interrupted&) {
    interrupted = true;
  }
  ShrinkResult result = shrinking.result();
  result.interrupted = interrupted;
  return result;
}

}  // namespace impinge
