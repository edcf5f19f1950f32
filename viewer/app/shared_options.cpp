#include "viewer/app/shared_options.hpp"

#include "engine/core/parallel.hpp"

namespace impinge {

void set_option(Options& options, std::vector<std::string>& overrides, const std::string& doc) {
  options.texts("--set", overrides, doc);
}

void scene_options(Options& options, std::filesystem::path& scene, std::vector<std::string>& overrides) {
  options.word("SCENE", scene, "scene file (TOML), or the run.toml of a run");
  set_option(options, overrides);
}

void script_option(Options& options, std::filesystem::path& script, const std::string& doc) {
  options.path("--script", script, doc);
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

void threads_option(Options& options) {
  options.whole("--threads", set_thread_count, 1, 4096, "threads to use (default: all cores); changes no result");
}

void quiet_option(Options& options, bool& quiet, const std::string& doc) { options.flag("--quiet", quiet, doc); }

std::filesystem::path default_out(const std::filesystem::path& scene, const std::string& ending) {
  return "out/" + scene.stem().string() + ending;
}

}  // namespace impinge
