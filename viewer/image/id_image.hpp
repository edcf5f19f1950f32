// What each pixel of a picture shows, as an index into a table of objects: the id buffer that tests name changes by and
// that a pointer picks from. Beside each frame as ids/000000.png: the index as R * 65536 + G * 256 + B, and in the tEXt
// chunk impinge:objects a line for each index that occurs: index, layer, mark, body, other body, identity, by tabs.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "viewer/image/png.hpp"

namespace impinge {

/// Everything of one kind that a layer draws for a body or for a contact.
struct IdObject {
  std::string layer;  ///< "panels" for what is written over the picture
  /// surface, fixed surface (of a static body), plane, point, line, arrow, triangle; figures, legend, bar
  std::string mark;
  std::string body, other;     ///< names; `other` of contacts only; "" for none
  std::uint64_t identity = 0;  ///< of a contact: ContactRecord::pair_id, the same from frame to frame
  // not in files, for pickers
  int body_index = -1;     ///< in the record
  int contact_index = -1;  ///< in the record
  /// In two pictures the same thing, though its index may differ.
  bool is_same_as(const IdObject& o) const {
    return layer == o.layer && mark == o.mark && body == o.body && other == o.other && identity == o.identity;
  }
};

struct IdImage {
  static constexpr std::uint32_t kNoPart = 0xffffffffu;
  int width = 0, height = 0;
  std::vector<std::uint32_t> object;  ///< a pixel each, top row first: 0 is the backdrop, else objects[i - 1]
  std::vector<std::uint32_t> part;    ///< of a surface: which of its triangles; else kNoPart; empty if read from a file
  std::vector<IdObject> objects;

  std::uint32_t at(int x, int y) const { return object[static_cast<std::size_t>(y) * width + x]; }
  /// Null for the backdrop.
  const IdObject* object_at(int x, int y) const { return at(x, y) == 0 ? nullptr : &objects[at(x, y) - 1]; }
};

/// Drops objects that no pixel shows. Indices change.
void keep_visible_objects(IdImage& ids);

/// The picture and its text. Throws InternalError on 2^24 objects or more.
Image id_picture(const IdImage& ids);
PngText id_text(const IdImage& ids);

/// Throws InputError where the file is no id picture.
IdImage read_ids(const std::filesystem::path& path);

}  // namespace impinge
