#include "viewer/compare/picture_comparison.hpp"

#include <fmt/format.h>

#include <set>
#include <tuple>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/image/flip.hpp"
#include "viewer/image/png.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 28;
constexpr std::size_t kMostObjects = 8;  // lines about objects

void compare_objects(PictureComparison& c, const Image& a, const Image& b, const PictureRules& rules) {
  const fs::path ids_a = id_picture_of(c.a), ids_b = id_picture_of(c.b);
  if (!is_file(ids_a) || !is_file(ids_b)) return;
  c.has_ids = true;
  c.objects = object_changes(a, b, read_ids(ids_a), read_ids(ids_b), rules.settings.tolerance, rules.mask);
  for (std::size_t i = 0; i < c.objects.size() && i < kMostObjects; ++i) c.details.push_back(c.objects[i].text());
  if (c.objects.size() > kMostObjects)
    c.details.push_back(fmt::format("and {} more kinds of objects", c.objects.size() - kMostObjects));
  if (c.objects.empty()) c.details.push_back("the pixels that differ belong to the backdrop or to labels");
}

void copy_to(const fs::path& from, const fs::path& to) {
  make_folder(absolute_path(to).parent_path());
  write_file(to, read_file(from, kMostBytes));
}

// the order in a file is that of drawing
bool names_the_same(const IdImage& a, const IdImage& b) {
  const auto names = [](const IdImage& ids) {
    std::set<std::tuple<std::string, std::string, std::string, std::string, std::uint64_t>> all;
    for (const IdObject& o : ids.objects) all.emplace(o.layer, o.mark, o.body, o.other, o.identity);
    return all;
  };
  return names(a) == names(b);
}

}  // namespace

fs::path id_picture_of(const fs::path& picture) {
  const fs::path folder = picture.parent_path();
  if (folder.filename() == "frames") return folder.parent_path() / "ids" / picture.filename();
  // named from within
  const bool is_in_frames = absolute_path(picture).lexically_normal().parent_path().filename() == "frames";
  return (is_in_frames ? folder / ".." : folder) / "ids" / picture.filename();
}

bool is_alternate(const std::string& file_name) { return file_name.find('@') != std::string::npos; }

fs::path alternate_for(const fs::path& baseline, const fs::path& picture) {
  const std::string renderer = facts_of(read_png_text(picture)).renderer;
  if (renderer.empty() || is_alternate(baseline.filename().string())) return baseline;
  return baseline.parent_path() / (baseline.stem().string() + "@" + renderer_key(renderer) + ".png");
}

fs::path baseline_for(const fs::path& baseline, const fs::path& picture) {
  const fs::path alternate = alternate_for(baseline, picture);
  return is_file(alternate) ? alternate : baseline;
}

PictureComparison judge_pictures(const std::string& name, const fs::path& a, const fs::path& b,
                                 const PictureRules& rules) {
  PictureComparison c;
  c.name = name;
  c.a = a, c.b = b;
  const std::string file_a = read_file(a, kMostBytes), file_b = read_file(b, kMostBytes);
  const Image image_a = decode_png(file_a, a.string());
  const Image image_b = file_a == file_b ? image_a : decode_png(file_b, b.string());
  if (image_a.width != image_b.width || image_a.height != image_b.height) {
    c.verdict = PictureComparison::sizes;
    c.headline = fmt::format(
        "sizes differ: A has {}x{} pixels, B {}x{}; make both with the same --size, or rewrite A with --update",
        image_a.width, image_a.height, image_b.width, image_b.height);
    return c;
  }
  c.difference = compare(image_a, image_b, rules.settings, rules.mask);
  if (c.difference.same) return c;
  c.verdict = PictureComparison::different;
  c.headline = c.difference.reason;
  return c;
}

void explain_difference(PictureComparison& c, const PictureRules& rules) {
  c.facts_a = facts_of(read_png_text(c.a)), c.facts_b = facts_of(read_png_text(c.b));
  c.cause = cause_of(c.facts_a, c.facts_b);
  if (c.verdict != PictureComparison::different) return;
  const Image image_a = read_png(c.a), image_b = read_png(c.b);
  if (const std::string cause = cause_text(c.facts_a, c.facts_b); !cause.empty()) c.details.push_back(cause);
  c.kind = change_kind(image_a, image_b, c.difference);
  // a state that differs a little moves everything a little, which is no change of colour
  const bool is_told =
      c.kind.kind == ChangeKind::recolored &&
      (c.cause == ChangeCause::state || c.cause == ChangeCause::other_frame || c.cause == ChangeCause::other_scene);
  if (!c.kind.text.empty() && !is_told) c.details.push_back("looks like: " + c.kind.text);
  compare_objects(c, image_a, image_b, rules);
  c.flip = flip(image_a, image_b).mean;
  c.details.push_back(fmt::format("FLIP: {:.4f} in the mean (0 the same, 1 the most; for information)", c.flip));
}

PictureComparison compare_pictures(const std::string& name, const fs::path& a, const fs::path& b,
                                   const PictureRules& rules) {
  PictureComparison c = judge_pictures(name, a, b, rules);
  explain_difference(c, rules);
  return c;
}

fs::path update_baseline(const PictureComparison& comparison, const fs::path& baseline, const fs::path& picture) {
  const bool other_renderer =
      comparison.verdict == PictureComparison::different && comparison.cause == ChangeCause::renderer;
  fs::path target = other_renderer ? alternate_for(baseline, picture) : baseline;
  read_png(picture);  // a baseline that nobody can read helps nobody
  // the ids first: where the disk is full after them, the picture still differs and the next --update goes on
  const fs::path ids = id_picture_of(picture), ids_target = id_picture_of(target);
  std::error_code error;
  if (is_file(ids))
    copy_to(ids, ids_target);
  else
    fs::remove(ids_target, error);
  copy_to(picture, target);
  return target;
}

fs::path update_ids(const PictureComparison& same) {
  const fs::path ids = id_picture_of(same.b);
  fs::path target = id_picture_of(same.a);
  if (!is_file(ids) || (is_file(target) && names_the_same(read_ids(target), read_ids(ids)))) return "";
  copy_to(ids, target);
  return target;
}

}  // namespace impinge
