#include "viewer/image/id_image.hpp"

#include <fmt/format.h>

#include <charconv>

#include "engine/core/error.hpp"

namespace impinge {

namespace {

constexpr const char* kKeyword = "impinge:objects";

std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == mark)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

bool to_number(const std::string& text, std::uint64_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& found) {
  throw InputError(fmt::format("{}: {}; a picture that impinge run --ids wrote is wanted; run the scene again",
                               path.string(), found));
}

}  // namespace

void keep_visible_objects(IdImage& ids) {
  std::vector<std::uint32_t> index(ids.objects.size() + 1, 0);
  for (const std::uint32_t i : ids.object) index[i] = 1;
  index[0] = 0;
  std::vector<IdObject> kept;
  for (std::size_t i = 1; i < index.size(); ++i) {
    if (index[i] == 0) continue;
    kept.push_back(ids.objects[i - 1]);
    index[i] = static_cast<std::uint32_t>(kept.size());
  }
  for (std::uint32_t& i : ids.object) i = index[i];
  ids.objects = std::move(kept);
}

Image id_picture(const IdImage& ids) {
  IMPINGE_ASSERT(ids.objects.size() < (1u << 24));
  Image image(ids.width, ids.height);
  for (std::size_t i = 0; i < ids.object.size(); ++i)
    for (int c = 0; c < 3; ++c) image.rgb[3 * i + c] = static_cast<std::uint8_t>(ids.object[i] >> (16 - 8 * c));
  return image;
}

PngText id_text(const IdImage& ids) {
  std::string table;
  for (std::size_t i = 0; i < ids.objects.size(); ++i) {
    const IdObject& o = ids.objects[i];
    table += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\n", i + 1, o.layer, o.mark, o.body, o.other, o.identity);
  }
  return {{kKeyword, table}};
}

IdImage read_ids(const std::filesystem::path& path) {
  const Image image = read_png(path);
  IdImage ids;
  ids.width = image.width;
  ids.height = image.height;
  bool found = false;
  for (const auto& [keyword, text] : read_png_text(path)) {
    if (keyword != kKeyword) continue;
    found = true;
    for (const std::string& line : split(text, '\n')) {
      if (line.empty()) continue;
      const std::vector<std::string> cells = split(line, '\t');
      IdObject object;
      std::uint64_t index = 0;
      if (cells.size() != 6 || !to_number(cells[0], index) || index != ids.objects.size() + 1 ||
          !to_number(cells[5], object.identity))
        refuse(path, fmt::format("line {} of its table of objects is damaged", ids.objects.size() + 1));
      object.layer = cells[1], object.mark = cells[2], object.body = cells[3], object.other = cells[4];
      ids.objects.push_back(std::move(object));
    }
  }
  if (!found) refuse(path, "has no table of objects");
  ids.object.resize(image.rgb.size() / 3);
  for (std::size_t i = 0; i < ids.object.size(); ++i) {
    const std::uint8_t* p = image.rgb.data() + 3 * i;
    ids.object[i] = static_cast<std::uint32_t>(p[0]) << 16 | static_cast<std::uint32_t>(p[1]) << 8 | p[2];
    if (ids.object[i] > ids.objects.size())
      refuse(path, fmt::format("a pixel names object {} of {}", ids.object[i], ids.objects.size()));
  }
  return ids;
}

}  // namespace impinge
