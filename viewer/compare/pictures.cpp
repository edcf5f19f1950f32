#include "viewer/compare/pictures.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "engine/core/utf8.hpp"
#include "engine/io/paths.hpp"
#include "viewer/compare/picture_comparison.hpp"
#include "viewer/image/png.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMostDetails = 10;  // pictures that are explained on the terminal

struct Pair {
  std::string name;
  fs::path a, b;  // "" for none
};

bool is_run(const fs::path& folder) { return is_folder(folder / "frames") && is_file(folder / "run.toml"); }

// a run's folder stands for its frames
fs::path pictures_of(const fs::path& folder) { return is_run(folder) ? folder / "frames" : folder; }

std::set<std::string> pictures_in(const fs::path& folder) {
  std::set<std::string> names;
  if (!is_folder(folder)) return names;
  for (const std::string& name : names_in(folder))
    if (fs::path(name).extension() == ".png" && is_file(folder / name)) {
      check_utf8_name((folder / name).string());
      names.insert(name);
    }
  return names;
}

void check_there(const fs::path& path) {
  if (!is_there(path))
    throw InputError(path.string() +
                     ": there is no such file or folder; a PNG or a folder of PNGs is wanted; check the path");
}

std::vector<Pair> pairs_of_folders(const fs::path& a, const fs::path& b) {
  const fs::path folder_a = pictures_of(a), folder_b = pictures_of(b);
  std::set<std::string> in_a = pictures_in(folder_a), in_b = pictures_in(folder_b);
  // an alternate X@RENDERER.png stands in for X.png; it is no picture of its own unless both folders have it
  std::erase_if(in_a, [&](const std::string& name) { return is_alternate(name) && !in_b.contains(name); });
  std::set<std::string> names = in_a;
  names.insert(in_b.begin(), in_b.end());
  if (names.empty())
    throw InputError(fmt::format("{} and {}: no PNG files in either; folders of PNGs are wanted; check the paths",
                                 folder_a.string(), folder_b.string()));
  std::vector<Pair> pairs;
  for (const std::string& name : names) {
    Pair pair{name, folder_a / name, folder_b / name};
    if (!in_b.contains(name))
      pair.b.clear();
    else if (!in_a.contains(name) && !is_file(alternate_for(pair.a, pair.b)))
      pair.a.clear();
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

std::vector<Pair> pairs_of(const fs::path& a, const fs::path& b, bool update) {
  check_there(b);
  if (update && !is_there(a))
    return is_folder(b) ? pairs_of_folders(a, b) : std::vector<Pair>{{b.filename().string(), "", b}};
  check_there(a);
  if (is_folder(a) != is_folder(b))
    throw InputError(fmt::format(
        "{} and {}: one is a folder, the other is not; two PNGs or two folders are wanted; name two of a kind",
        a.string(), b.string()));
  if (is_folder(a)) return pairs_of_folders(a, b);
  return {{a.filename().string(), a, b}};
}

PictureComparison judge_pair(const Pair& pair, const fs::path& folder_a, const fs::path& folder_b,
                             const PictureRules& rules) {
  if (!pair.a.empty() && !pair.b.empty()) return judge_pictures(pair.name, baseline_for(pair.a, pair.b), pair.b, rules);
  PictureComparison c;
  c.name = pair.name;
  c.a = pair.a, c.b = pair.b;
  c.verdict = pair.a.empty() ? PictureComparison::missing_in_a : PictureComparison::missing_in_b;
  c.headline = "missing in " + (pair.a.empty() ? folder_a : folder_b).string();
  return c;
}

bool is_missing(const PictureComparison& c) {
  return c.verdict == PictureComparison::missing_in_a || c.verdict == PictureComparison::missing_in_b;
}

/// All of them judged, and explained where that will be shown: everywhere, or of the first that differ.
std::vector<PictureComparison> compare_pairs(const std::vector<Pair>& pairs, const fs::path& folder_a,
                                             const fs::path& folder_b, const PictureRules& rules, bool explains_all) {
  std::vector<PictureComparison> all(pairs.size());
  parallel_for(pairs.size(), 1, [&](std::size_t i) { all[i] = judge_pair(pairs[i], folder_a, folder_b, rules); });
  std::vector<PictureComparison*> explained;
  std::size_t told = 0;
  for (PictureComparison& c : all) {
    if (c.verdict == PictureComparison::same || (told++ >= kMostDetails && !explains_all) || is_missing(c)) continue;
    explained.push_back(&c);
  }
  parallel_for(explained.size(), 1, [&](std::size_t i) { explain_difference(*explained[i], rules); });
  return all;
}

/// "3 of 91 differ, 60 are missing in B".
std::string count_text(const std::vector<PictureComparison>& all) {
  std::size_t differ = 0, in_a = 0, in_b = 0;
  for (const PictureComparison& c : all) {
    in_a += c.verdict == PictureComparison::missing_in_a;
    in_b += c.verdict == PictureComparison::missing_in_b;
    differ += c.verdict != PictureComparison::same && !is_missing(c);
  }
  const std::size_t both = all.size() - in_a - in_b;
  std::string text = both == 0 ? "no picture is in both" : fmt::format("{} of {} differ", differ, both);
  for (const auto& [count, where] : {std::pair(in_a, "A"), {in_b, "B"}})
    if (count > 0) text += fmt::format(", {} {} missing in {}", count, count == 1 ? "is" : "are", where);
  return text;
}

void print(const PictureComparison& c, bool with_details = true) {
  fmt::print("{}: {}\n", c.name, c.headline);
  for (const std::string& line : c.details)
    if (with_details) fmt::print("  {}\n", line);
}

/// What --update does and says. Baselines without a picture in B stay: to remove one is a decision of its own.
int update(const std::vector<PictureComparison>& all, const fs::path& a) {
  int left = 0, written_anew = 0, rewritten = 0, ids_written = 0;
  for (const PictureComparison& c : all) {
    if (c.verdict == PictureComparison::same) {
      const fs::path ids = update_ids(c);
      if (ids.empty()) continue;
      fmt::print("{}: the same within the limits, and kept\n  wrote its ids {}\n", c.name, ids.string());
      ++ids_written;
      continue;
    }
    print(c);
    if (c.verdict == PictureComparison::missing_in_b) {
      fmt::print("  kept {}: B has no such picture; remove it by hand if it is no longer wanted\n", c.a.string());
      ++left;
      continue;
    }
    const bool is_new = c.a.empty();
    const fs::path baseline = !is_new ? c.a : a.extension() == ".png" ? a : pictures_of(a) / c.name;
    const bool had_ids = !is_new && is_file(id_picture_of(baseline));
    const fs::path written = update_baseline(c, baseline, c.b);
    (written == baseline && !is_new ? rewritten : written_anew) += 1;
    const bool has_ids = is_file(id_picture_of(written));
    fmt::print("  {} {}{}\n",
               is_new                ? "new:"
               : written == baseline ? "rewrote"
                                     : "wrote the alternate",
               written.string(),
               has_ids                          ? " with its ids"
               : written == baseline && had_ids ? "; B has no ids of it, so the old ones were removed"
                                                : "");
  }
  fmt::print("{} picture{} compared, {} rewritten, {} new{}\n", all.size(), all.size() == 1 ? "" : "s", rewritten,
             written_anew, ids_written == 0 ? "" : fmt::format(", ids alone written of {}", ids_written));
  return left == 0 ? 0 : 1;
}

}  // namespace

int compare_pictures(const PicturesOptions& options) {
  const fs::path &a = options.a, &b = options.b, &out = options.out;
  std::optional<Image> mask;
  if (!options.mask.empty()) mask = read_png(options.mask);
  PictureRules rules;
  rules.settings.tolerance = options.tolerance;
  rules.mask = mask ? &*mask : nullptr;
  const std::vector<Pair> pairs = pairs_of(a, b, options.update);
  if (options.update && is_run(a))
    throw InputError(a.string() +
                     ": is a run's folder, and --update would change its frames; a folder of baselines is wanted; swap "
                     "A and B, or copy the frames first");

  const std::vector<PictureComparison> all =
      compare_pairs(pairs, pictures_of(a), pictures_of(b), rules, !out.empty() || options.update);
  std::vector<PictureComparison> differing;
  std::copy_if(all.begin(), all.end(), std::back_inserter(differing),
               [](const PictureComparison& c) { return c.verdict != PictureComparison::same; });
  if (!out.empty() && !differing.empty())
    write_picture_report(out, fmt::format("{} and {}", a.string(), b.string()), all, rules);
  std::error_code error;
  // of the last time: it tells of differences that are gone
  if (!out.empty() && differing.empty()) fs::remove(out / "report.html", error);
  if (options.update) return update(all, a);

  for (std::size_t i = 0; i < differing.size(); ++i) {
    if (i == kMostDetails) fmt::print("without what they look like from here on; --out DIR tells it of every one\n");
    print(differing[i], i < kMostDetails);
  }
  if (differing.empty())
    fmt::print("{} picture{} compared, no difference beyond the tolerance\n", all.size(), all.size() == 1 ? "" : "s");
  else if (out.empty())
    fmt::print("{}; --out DIR shows them\n", count_text(all));
  else
    fmt::print("{}, shown in {}\n", count_text(all), (out / "report.html").string());
  return differing.empty() ? 0 : 1;
}

}  // namespace impinge
