// PLY, ASCII and binary of either byte order. Any elements and properties may stand beside vertices and faces.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "engine/core/error.hpp"
#include "engine/io/meshes/mesh_readers.hpp"
#include "engine/io/meshes/polygon.hpp"
#include "engine/io/text_lines.hpp"

namespace impinge {

namespace {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
constexpr int kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
bool is_whole(Scalar type) { return type < Scalar::float32; }

struct Property {
  std::string name;
  Scalar type = Scalar::float32;
  bool is_list = false;
  Scalar count_type = Scalar::uint8;
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;

  int find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
      if (properties[i].name == property) return static_cast<int>(i);
    return -1;
  }
};

struct Head {
  enum { ascii, little, big } format = ascii;
  std::vector<Element> elements;
  std::size_t size = 0;  // bytes
  int lines = 0;
};

Scalar scalar(const TextLines& in, std::size_t i) {
  constexpr std::string_view kNames[] = {"char", "uchar", "short", "ushort", "int",   "uint",   "float",   "double",
                                         "int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};
  if (i < in.count())
    for (int k = 0; k < 16; ++k)
      if (in.word(i) == kNames[k]) return static_cast<Scalar>(k % 8);
  in.fail(i, i < in.count() ? quoted(in.word(i)) : "the line ends early",
          "a type such as float, double, uchar, int is wanted", "export the file again");
}

Head read_head(const std::string& name, std::string_view bytes) {
  TextLines in(name, bytes);
  if (!in.next() || in.word(0) != "ply")
    throw InputError(name + ":1:1: no 'ply' at the start; a PLY file starts with it; check the file's ending");
  Head head;
  bool has_format = false;
  for (;;) {
    in.need("'end_header'");
    const std::string_view key = in.word(0);
    if (key == "end_header") break;
    if (key == "comment" || key == "obj_info") continue;
    if (key == "format") {
      const std::string_view format = in.count() > 1 ? in.word(1) : "";
      if (format == "ascii")
        head.format = Head::ascii;
      else if (format == "binary_little_endian")
        head.format = Head::little;
      else if (format == "binary_big_endian")
        head.format = Head::big;
      else
        in.fail(1, quoted(format), "ascii, binary_little_endian or binary_big_endian is wanted",
                "export the file again");
      has_format = true;
    } else if (key == "element") {
      if (in.count() != 3)
        in.fail(0, "an element without name or count", "'element NAME COUNT' is wanted", "export the file again");
      const std::int64_t count = in.integer(2);
      if (count < 0 || count > kMostElements)
        in.fail(2, fmt::format("{} elements", count), fmt::format("0 to {} are taken", kMostElements),
                "make the mesh smaller");
      head.elements.push_back({std::string(in.word(1)), count, {}});
    } else if (key == "property") {
      if (head.elements.empty())
        in.fail(0, "a property before any element", "'element NAME COUNT' comes first", "export the file again");
      Property property;
      property.is_list = in.count() > 1 && in.word(1) == "list";
      if (property.is_list) {
        property.count_type = scalar(in, 2);
        if (!is_whole(property.count_type))
          in.fail(2, quoted(in.word(2)), "a list is counted in whole numbers", "export the file again");
      }
      const std::size_t at = property.is_list ? 3 : 1;
      property.type = scalar(in, at);
      if (at + 1 >= in.count())
        in.fail(at, "a property without a name", "'property TYPE NAME' is wanted", "export the file again");
      property.name = in.word(at + 1);
      head.elements.back().properties.push_back(std::move(property));
    } else {
      in.fail(0, quoted(key), "format, element, property, comment or end_header is wanted", "export the file again");
    }
  }
  if (!has_format)
    in.fail(0, "a head without 'format'", "'format ascii 1.0' or a binary one is wanted", "export the file again");
  head.size = bytes.size() - in.bytes_left();
  head.lines = in.line();
  return head;
}

// where values come from: words of lines, or bytes
class AsciiSource {
 public:
  /// `lines`: those of the head, which are passed over so that line numbers are the file's.
  AsciiSource(const std::string& name, std::string_view bytes, int lines) : in_(name, bytes) {
    while (in_.line() < lines && in_.next()) {
    }
  }
  void begin(const Element& element) {
    in_.need(element.name == "vertex" ? "a vertex" : element.name == "face" ? "a face" : "an element");
    at_ = 0;
  }
  void end() {
    if (at_ != in_.count()) in_.fail(at_, quoted(in_.word(at_)), "the line should end here", "export the file again");
  }
  double real(Scalar) { return in_.real(at_++); }
  std::int64_t whole(Scalar) { return in_.integer(at_++); }
  void skip(Scalar) {
    if (at_ >= in_.count()) in_.real(at_);  // says that the line ends early
    ++at_;
  }
  [[noreturn]] void fail(const std::string& found, const std::string& allowed) const {
    in_.fail(at_ ? at_ - 1 : 0, found, allowed, "export the file again");
  }
  bool has_room(std::int64_t values) const { return values <= static_cast<std::int64_t>(in_.count() - at_); }
  bool at_end() { return !in_.next(); }

 private:
  TextLines in_;
  std::size_t at_ = 0;
};

class BinarySource {
 public:
  BinarySource(const std::string& name, std::string_view bytes, bool big) : name_(name), bytes_(bytes), big_(big) {}
  void begin(const Element&) {}
  void end() {}
  double real(Scalar type) {
    const double value = take(type);
    if (!std::isfinite(value)) fail("a coordinate that is not finite", "a finite number is wanted");
    return value;
  }
  std::int64_t whole(Scalar type) { return static_cast<std::int64_t>(take(type)); }
  void skip(Scalar type) { take(type); }
  [[noreturn]] void fail(const std::string& found, const std::string& allowed) const {
    throw InputError(fmt::format("{}: byte {}: {}; {}; export the file again", name_, last_, found, allowed));
  }
  bool has_room(std::int64_t values) const { return values <= static_cast<std::int64_t>(bytes_.size() - at_); }
  bool at_end() const { return at_ == bytes_.size(); }
  void start_at(std::size_t offset) { at_ = last_ = offset; }

 private:
  // every PLY type fits a double exactly
  double take(Scalar type) {
    const int n = kBytes[static_cast<int>(type)];
    last_ = at_;
    if (bytes_.size() - at_ < static_cast<std::size_t>(n)) fail("the file ends early", "more data should follow");
    unsigned char raw[8];
    for (int i = 0; i < n; ++i) raw[big_ ? n - 1 - i : i] = static_cast<unsigned char>(bytes_[at_ + i]);
    at_ += n;
    const auto as = [&raw](auto value) {
      std::memcpy(&value, raw, sizeof value);
      return static_cast<double>(value);
    };
    switch (type) {
      case Scalar::int8:
        return as(std::int8_t{});
      case Scalar::uint8:
        return as(std::uint8_t{});
      case Scalar::int16:
        return as(std::int16_t{});
      case Scalar::uint16:
        return as(std::uint16_t{});
      case Scalar::int32:
        return as(std::int32_t{});
      case Scalar::uint32:
        return as(std::uint32_t{});
      case Scalar::float32:
        return as(float{});
      case Scalar::float64:
        return as(double{});
    }
    return 0.0;
  }

  std::string name_;
  std::string_view bytes_;
  bool big_;
  std::size_t at_ = 0, last_ = 0;
};
static_assert(std::endian::native == std::endian::little, "take() builds little-endian numbers");

template <class Source>
std::int64_t list_length(Source& in, const Property& property, std::int64_t most = kMostCorners) {
  const std::int64_t n = in.whole(property.count_type);
  if (n < 0 || n > most || !in.has_room(n))
    in.fail(fmt::format("a list of {} values", n), "no more than the file has room for");
  return n;
}

template <class Source>
void skip_property(Source& in, const Property& property) {
  std::int64_t n = 1;
  if (property.is_list) n = list_length(in, property);
  for (std::int64_t i = 0; i < n; ++i) in.skip(property.type);
}

std::size_t list_of_vertices(const std::string& name, const Element& element, const char* what) {
  const int a = element.find("vertex_indices"), b = element.find("vertex_index");
  const int indices = a >= 0 ? a : b;
  if (indices < 0 || !element.properties[indices].is_list || !is_whole(element.properties[indices].type))
    throw InputError(
        fmt::format("{}:1: {} without vertex_indices; 'property list uchar int vertex_indices' is wanted "
                    "in the head; export the file again",
                    name, what));
  return static_cast<std::size_t>(indices);
}

template <class Source>
void read_vertices(Source& in, const Element& element, const int (&axes)[3], TriangleMesh& mesh) {
  mesh.vertices.reserve(element.count);
  for (std::int64_t i = 0; i < element.count; ++i) {
    Vec3 x;
    in.begin(element);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      int axis = -1;
      for (int k = 0; k < 3; ++k)
        if (axes[k] == static_cast<int>(p)) axis = k;
      if (axis < 0)
        skip_property(in, element.properties[p]);
      else
        x[axis] = in.real(element.properties[p].type);
    }
    in.end();
    mesh.vertices.push_back(x);
  }
}

/// Hands the list that has number `indices` to `read`, row by row, and passes over all else.
template <class Source, class Read>
void read_lists(Source& in, const Element& element, std::size_t indices, const Read& read) {
  for (std::int64_t i = 0; i < element.count; ++i) {
    in.begin(element);
    for (std::size_t p = 0; p < element.properties.size(); ++p)
      if (p == indices)
        read(element.properties[p]);
      else
        skip_property(in, element.properties[p]);
    in.end();
  }
}

template <class Source>
void read_faces(Source& in, const Element& element, std::size_t indices, std::int64_t vertices, TriangleMesh& mesh) {
  mesh.triangles.reserve(element.count);
  std::vector<int> corners;
  read_lists(in, element, indices, [&](const Property& property) {
    const std::int64_t n = list_length(in, property);
    if (n < 3) in.fail(fmt::format("a face of {} corners", n), "a face has at least 3");
    corners.clear();
    for (std::int64_t k = 0; k < n; ++k) {
      const std::int64_t v = in.whole(property.type);
      if (v < 0 || v >= vertices)
        in.fail(fmt::format("vertex {}", v), fmt::format("there are vertices 0 to {}", vertices - 1));
      corners.push_back(static_cast<int>(v));
    }
    append_polygon(corners, mesh.vertices, mesh.triangles);
  });
}

/// Vertices of which each makes a triangle with the two before it, every other one turned; −1 begins a new strip.
template <class Source>
void read_strips(Source& in, const Element& element, std::size_t indices, std::int64_t vertices, TriangleMesh& mesh) {
  read_lists(in, element, indices, [&](const Property& property) {
    const std::int64_t n = list_length(in, property, kMostElements);
    int before[2] = {-1, -1};
    bool is_turned = false;
    for (std::int64_t k = 0; k < n; ++k) {
      const std::int64_t v = in.whole(property.type);
      if (v < -1 || v >= vertices)
        in.fail(fmt::format("vertex {}", v), fmt::format("there are vertices 0 to {}, and -1", vertices - 1));
      const int next = static_cast<int>(v);
      if (next < 0) {
        before[0] = before[1] = -1;
        is_turned = false;
        continue;
      }
      if (before[0] >= 0) {
        // strips turn corners by naming a vertex twice
        if (before[0] != before[1] && before[1] != next && before[0] != next)
          mesh.triangles.push_back({before[is_turned ? 1 : 0], before[is_turned ? 0 : 1], next});
        is_turned = !is_turned;
      }
      before[0] = before[1];
      before[1] = next;
    }
  });
}

template <class Source>
TriangleMesh read_body(Source& in, const std::string& name, const Head& head) {
  TriangleMesh mesh;
  bool has_vertices = false;
  std::int64_t vertices = 0;
  for (const Element& element : head.elements)
    if (element.name == "vertex") vertices = element.count;
  for (const Element& element : head.elements) {
    if (element.name == "vertex" && !has_vertices) {
      const int axes[3] = {element.find("x"), element.find("y"), element.find("z")};
      for (int k = 0; k < 3; ++k)
        if (axes[k] < 0 || element.properties[axes[k]].is_list)
          throw InputError(fmt::format(
              "{}:1: vertices without {}; 'property float {}' (or double) is wanted in the head; export the file again",
              name, "xyz"[k], "xyz"[k]));
      read_vertices(in, element, axes, mesh);
      has_vertices = true;
    } else if (element.name == "face") {
      read_faces(in, element, list_of_vertices(name, element, "faces"), vertices, mesh);
    } else if (element.name == "tristrips") {
      read_strips(in, element, list_of_vertices(name, element, "triangle strips"), vertices, mesh);
    } else {
      for (std::int64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
        in.begin(element);
        for (const Property& property : element.properties) skip_property(in, property);
        in.end();
      }
    }
  }
  if (!in.at_end()) in.fail("data after the last element", "the file should end there");
  return mesh;
}

// counts are checked against the size before anything is allocated for them
void check_counts(const std::string& name, const Head& head, std::size_t bytes_left) {
  double least = 0.0;
  for (const Element& element : head.elements) {
    double each = 0.0;
    for (const Property& property : element.properties)
      each += head.format == Head::ascii
                  ? 2
                  : kBytes[static_cast<int>(property.is_list ? property.count_type : property.type)];
    least += each * static_cast<double>(element.count);
    if (least > static_cast<double>(bytes_left) + 1)
      throw InputError(
          fmt::format("{}:{}: {} elements '{}'; no more than the file has room for ({} bytes follow); it is cut short, "
                      "fetch or export it again",
                      name, head.lines, element.count, element.name, bytes_left));
  }
}

}  // namespace

TriangleMesh read_ply(const std::string& name, std::string_view bytes) {
  const Head head = read_head(name, bytes);
  check_counts(name, head, bytes.size() - head.size);
  if (head.format == Head::ascii) {
    AsciiSource in(name, bytes, head.lines);
    return read_body(in, name, head);
  }
  BinarySource in(name, bytes, head.format == Head::big);
  in.start_at(head.size);
  return read_body(in, name, head);
}

}  // namespace impinge
