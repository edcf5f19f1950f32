// Pictures in the report: small copies inside the page, so that it can be passed on alone.
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "engine/io/paths.hpp"
#include "viewer/image/contact_sheet.hpp"
#include "viewer/image/jpeg.hpp"
#include "viewer/image/png.hpp"
#include "viewer/report/parts.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPictures = 480, kJobs = 120;  // about 6 MB of page at most
constexpr int kFrames = 13, kWidth = 360, kQuality = 82;

fs::path picture(const fs::path& out, const std::string& hash, int frame) {
  return out / "jobs" / hash / "run" / "frames" / fmt::format("{:06}.png", frame);
}

int last_picture(const fs::path& out, const std::string& hash) {
  int last = -1;
  const fs::path frames = out / "jobs" / hash / "run" / "frames";
  if (!is_folder(frames)) return last;
  for (const fs::path name : names_in(frames)) {
    const std::string stem = name.stem().string();
    if (name.extension() == ".png" && stem.size() == 6 && stem.find_first_not_of("0123456789") == std::string::npos)
      last = std::max(last, std::stoi(stem));
  }
  return last;
}

// which range each colour stands for in it, "" where colours have none
std::string colors_of(const fs::path& file) {
  try {
    for (const auto& [key, text] : read_png_text(file))
      if (key == "impinge:colors") return text;
  } catch (const InputError&) {
  }
  return "";
}

// "" where the file is cut off by a crash: as if it weren't there
std::string small_copy(const fs::path& file, std::pair<int, int>& size) {
  try {
    const Image image = read_png(file);
    size = {std::min(kWidth, image.width), std::max(1, image.height * std::min(kWidth, image.width) / image.width)};
    return data_uri("jpeg", encode_jpeg(reduce_image(image, size.first, size.second), kQuality));
  } catch (const InputError&) {
    return "";
  }
}

}  // namespace

std::string frames_json(const ReportTable& table, const fs::path& out, double frame_time) {
  const std::size_t jobs = std::min(table.rows.size(), kJobs);
  std::vector<int> lasts;
  for (std::size_t i = 0; i < jobs; ++i) lasts.push_back(last_picture(out, table.cell(i, "hash")));
  const int last = lasts.empty() ? -1 : *std::max_element(lasts.begin(), lasts.end());
  if (last < 0) return "null";
  const int count = std::clamp(static_cast<int>(kPictures / jobs), 2,
                               std::min(kFrames, last + 1) < 2 ? 2 : std::min(kFrames, last + 1));
  std::vector<int> frames;
  for (int k = 0; k < count; ++k) {
    const int frame = (k * last + (count - 1) / 2) / (count - 1);
    if (frames.empty() || frames.back() != frame) frames.push_back(frame);
  }
  // and, as one more, the last picture of each job that ended before the others
  const std::size_t per_job = frames.size() + 1;
  const auto frame_of = [&](std::size_t i) {
    return i % per_job < frames.size() ? frames[i % per_job] : lasts[i / per_job] < last ? lasts[i / per_job] : -1;
  };
  std::vector<std::string> pictures(jobs * per_job), colors(jobs * per_job);
  std::vector<std::pair<int, int>> sizes(pictures.size());
  parallel_for(pictures.size(), 1, [&](std::size_t i) {
    if (frame_of(i) < 0 || frame_of(i) > lasts[i / per_job]) return;
    const fs::path file = picture(out, table.cell(i / per_job, "hash"), frame_of(i));
    if (!is_file(file)) return;
    pictures[i] = small_copy(file, sizes[i]);
    colors[i] = colors_of(file);
  });
  const auto size = *std::max_element(sizes.begin(), sizes.end());
  if (size.first == 0) return "null";
  std::string json = fmt::format("{{\"numbers\":[{}", fmt::join(frames, ","));
  json += fmt::format("],\"step\":{:.9g},\"width\":{},\"height\":{},\"jobs\":[", frame_time, size.first, size.second);
  bool first = true;
  for (std::size_t i = 0; i < jobs; ++i) {
    const auto begin = pictures.begin() + static_cast<std::ptrdiff_t>(i * per_job);
    if (std::all_of(begin, begin + static_cast<std::ptrdiff_t>(per_job),
                    [](const std::string& p) { return p.empty(); }))
      continue;
    json += fmt::format("{}{{\"row\":{},\"last\":{},\"lastPicture\":\"{}\",\"pictures\":[", first ? "" : ",", i,
                        lasts[i], *(begin + static_cast<std::ptrdiff_t>(frames.size())));
    for (std::size_t k = 0; k < frames.size(); ++k)
      json += fmt::format("{}\"{}\"", k == 0 ? "" : ",", *(begin + static_cast<std::ptrdiff_t>(k)));
    json += "],\"colors\":[";  // of these and of the last picture
    for (std::size_t k = 0; k < per_job; ++k) json += (k == 0 ? "" : ",") + json_text(colors[i * per_job + k]);
    json += "]}\n";
    first = false;
  }
  return json + "]}";
}

}  // namespace impinge
