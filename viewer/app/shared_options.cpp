#include "viewer/app/shared_options.hpp"

#include <fmt/format.h>

#include "engine/core/memory.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {

void set_option(Options& options, std::vector<std::string>& overrides, const std::string& doc) {
  options.texts("--set", overrides, doc);
}

void scene_options(Options& options, std::filesystem::path& scene, std::vector<std::string>& overrides) {
  options.word("SCENE", scene, "scene file (TOML), or the run.toml of a run");
  set_option(options, overrides);
  memory_option(options);
}

void script_option(Options& options, std::filesystem::path& script, const std::string& doc) {
  options.path("--script", script, doc + "; - for standard input");
}

void frames_option(Options& options, std::optional<int>& last, const std::string& doc) {
  options.whole("--frames", last, 0, 100'000'000, doc);
}

void size_option(Options& options, int& width, int& height, const std::string& doc) {
  options.size("--size", width, height, doc);
}

void images_option(Options& options, bool& images) {
  options.flag_off("--no-images", images, "no pictures, figures only");
}

void tolerance_option(Options& options, int& tolerance, const std::string& doc) {
  options.whole("--tolerance", tolerance, 0, 255, doc);
}

void memory_option(Options& options) {
  const auto take = [](const std::string& text) {
    const auto bytes = parse_bytes(text);
    if (!bytes)
      refuse_option(fmt::format("--memory-limit is '{}'", text), "bytes, or a number with K, M, G or T, are wanted",
                    "write --memory-limit 4G");
    // a limit that is passed before anything is loaded could hold nothing
    if (const std::uint64_t held = memory_in_use(); *bytes <= held)
      refuse_option(fmt::format("--memory-limit is '{}'", text),
                    fmt::format("more than the {} that the program holds with nothing loaded is wanted",
                                describe_bytes(static_cast<double>(held))),
                    "write --memory-limit 4G");
    set_memory_limit(*bytes);
  };
  options.other("--memory-limit", take,
                "SIZE such as 4G: surfaces, volumes and factorizations that would take more memory are refused before "
                "it is taken; what many small things add up to is not watched (default: half of the machine's)");
}

void judge_option(Options& options, RunOptions& run) {
  options.flag_or_word(
      "--judge", [&run](const std::string& word) { run.judge = true, run.judge_substeps = word == "substeps"; },
      "substeps",
      "measure overlap independently of detection (slow): judged_penetration_m, judged_depth_m, judged_intersections; "
      "--judge=substeps: at the end of every sub-step, and the worst of a frame counts, self_crossings too");
}

void threads_option(Options& options) {
  options.whole("--threads", set_thread_count, 1, 4096, "threads to use (default: all cores); changes no result");
}

void quiet_option(Options& options, bool& quiet, const std::string& doc) { options.flag("--quiet", quiet, doc); }

std::filesystem::path default_out(const std::filesystem::path& scene, const std::string& ending) {
  return "out/" + scene.stem().string() + ending;
}

}  // namespace impinge
