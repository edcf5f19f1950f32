// The list of shapes: what each is called, which keys it has in a scene file, and how it is made from their values.
#pragma once

#include <map>
#include <string>

#include "engine/shapes/shape.hpp"

namespace impinge {

/// A key of a shape's table in a scene file. Lengths are read with their range and multiplied by the body's scale.
struct ShapeKey {
  enum Kind {
    length,      ///< metres, greater than 0
    lengths,     ///< three of them
    coordinate,  ///< metres, of either sign
    direction,   ///< three numbers, not all 0; as it is written
    points,      ///< a list of [x, y, z] in metres
    surface,     ///< a mesh file: its vertices, as points
    parts        ///< a list of { shape = { ... }, position, rotation }, convex or compounds of such
  };
  std::string_view name;
  Kind kind = length;
  std::string_view doc;
  bool required = true;
};

/// What a value of that kind is, in a word or two for lists: "m, greater than 0".
std::string_view unit_of(ShapeKey::Kind kind);

/// What the keys of one table say. A key that is not required and not there reads as zero or empty.
class ShapeValues {
 public:
  using Value = std::variant<double, Vec3, std::vector<Vec3>, std::vector<ShapePart>>;

  void set(std::string_view key, Value value) { values_[std::string(key)] = std::move(value); }
  bool has(std::string_view key) const { return values_.contains(std::string(key)); }
  double number(std::string_view key) const { return get<double>(key); }
  Vec3 vector(std::string_view key) const { return has(key) ? get<Vec3>(key) : Vec3(Vec3::Zero()); }
  std::vector<Vec3> points(std::string_view key) const { return get<std::vector<Vec3>>(key); }
  std::vector<ShapePart> parts(std::string_view key) const { return get<std::vector<ShapePart>>(key); }

 private:
  template <class T>
  T get(std::string_view key) const {
    const auto found = values_.find(std::string(key));
    return found == values_.end() ? T{} : std::get<T>(found->second);
  }
  std::map<std::string, Value> values_;
};

/// A shape cannot be made of its values. The reader of the scene adds the place of the key.
struct ShapeError {
  std::string key;  ///< at fault; of the whole table if it is empty
  std::string found, allowed, remedy;
};

struct ShapeEntry {
  std::string_view name;
  std::string_view doc;
  std::vector<ShapeKey> keys;
  /// Throws ShapeError. Null: it has a key of its own in the body (a mesh: `surface`).
  SharedShape (*make)(const ShapeValues& values) = nullptr;
  /// Why no deformable body can be of it, as "has no bounds"; empty: it can.
  std::string_view not_deformable = {};
};

/// All shapes, in the order of all.cpp.
const std::vector<ShapeEntry>& shape_entries();

/// The place of a name in that list; InternalError if it has none.
int shape_type(std::string_view name);

/// A shape by its name and values, for programs; what a scene says is read in engine/io/scene. Throws InternalError
/// with the ShapeError's words.
SharedShape make_shape(std::string_view name, const ShapeValues& values);

}  // namespace impinge
