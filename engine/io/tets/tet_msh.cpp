// Gmsh's .msh, versions 2.2 and 4.1, as text or binary. Text is read word by word, not line by line: writers put line
// ends where they like. A place in binary data is told as the last text line and the bytes since its start.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "engine/core/error.hpp"
#include "engine/io/tets/tet_draft.hpp"
#include "engine/io/text_lines.hpp"

namespace impinge {
namespace {

struct ElementType {
  int dimension, nodes;
  const char* name;
};

/// Gmsh's element types 1 to 31 (reference manual, MSH file format).
constexpr ElementType kTypes[] = {{1, 2, "line"},
                                  {2, 3, "triangle"},
                                  {2, 4, "quadrangle"},
                                  {3, 4, "tetrahedron"},
                                  {3, 8, "hexahedron"},
                                  {3, 6, "prism"},
                                  {3, 5, "pyramid"},
                                  {1, 3, "line"},
                                  {2, 6, "triangle"},
                                  {2, 9, "quadrangle"},
                                  {3, 10, "second-order tetrahedron"},
                                  {3, 27, "hexahedron"},
                                  {3, 18, "prism"},
                                  {3, 14, "pyramid"},
                                  {0, 1, "point"},
                                  {2, 8, "quadrangle"},
                                  {3, 20, "hexahedron"},
                                  {3, 15, "prism"},
                                  {3, 13, "pyramid"},
                                  {2, 9, "triangle"},
                                  {2, 10, "triangle"},
                                  {2, 12, "triangle"},
                                  {2, 15, "triangle"},
                                  {2, 15, "triangle"},
                                  {2, 21, "triangle"},
                                  {1, 4, "line"},
                                  {1, 5, "line"},
                                  {1, 6, "line"},
                                  {3, 20, "third-order tetrahedron"},
                                  {3, 35, "fourth-order tetrahedron"},
                                  {3, 56, "fifth-order tetrahedron"}};
constexpr int kTetrahedron = 4;

/// How a whole number is stored in binary data.
enum class Stored { int32, size64 };

class MshReader {
 public:
  MshReader(const std::string& name, std::string_view bytes) : text_(bytes) { draft_.files = {name}; }

  TetFile read() {
    if (!next() || word_ != "$MeshFormat")
      fail(word_.empty() ? "an empty file" : quoted(word_), "a .msh file starts with $MeshFormat",
           "check the file's ending");
    read_format();
    bool nodes = false, elements = false;
    while (next()) {
      if (word_ == "$Nodes" || word_ == "$Elements") {
        bool& seen = word_ == "$Nodes" ? nodes : elements;
        if (seen) fail(fmt::format("a second {} section", word_), "one is allowed", "keep one of them");
        if (word_ == "$Elements" && !nodes)
          fail("$Elements before $Nodes", "nodes come first", "export the file again");
        seen = true;
        if (word_ == "$Nodes")
          legacy_ ? read_nodes_2() : read_nodes_4();
        else
          legacy_ ? read_elements_2() : read_elements_4();
      } else if (word_.size() > 1 && word_[0] == '$' && word_.substr(0, 4) != "$End") {
        skip_section();
      } else {
        fail(quoted(word_), "a section ($Name ... $EndName) should follow", "remove it");
      }
    }
    if (!nodes) fail("no $Nodes section", "a mesh has nodes and elements", "export the file again");
    if (!elements) fail("no $Elements section", "a mesh has nodes and elements", "export the file again");
    if (draft_.result.mesh.tets.empty())
      fail(fmt::format("a surface-only mesh: {} triangles, 0 tetrahedra", triangles_), "a volume mesh is wanted",
           "mesh in three dimensions, or use the file as a surface");
    return finish_tets(std::move(draft_), true);
  }

 private:
  FilePlace here() const { return {0, line_, column_}; }
  [[noreturn]] void fail(const std::string& found, const std::string& allowed, const std::string& remedy) const {
    draft_.fail(here(), found, allowed, remedy);
  }

  /// The next word; false at the end of the file.
  bool next() {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; };
    while (at_ < text_.size() && blank(text_[at_])) {
      if (text_[at_] == '\n') {
        ++next_line_;
        line_start_ = at_ + 1;
      }
      ++at_;
    }
    line_ = next_line_;
    column_ = static_cast<int>(at_ - line_start_) + 1;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !blank(text_[at_])) ++at_;
    word_ = text_.substr(begin, at_ - begin);
    return !word_.empty();
  }
  void need(const char* what) {
    if (!next()) fail("the file ends early", fmt::format("{} should follow", what), "export the file again");
    if (word_[0] == '$')
      fail(quoted(word_), fmt::format("{} should follow", what), "mend the counts or export the file again");
  }
  template <class Number>
  Number number(const char* what) {
    need(what);
    std::string_view w = word_;
    if (w.size() > 1 && w[0] == '+' && w[1] != '-') w.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    bool good = error == std::errc() && end == w.data() + w.size();
    if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(value);
    if (!good)
      fail(quoted(word_),
           fmt::format("{} should be a {} number", what, std::is_floating_point_v<Number> ? "finite" : "whole"),
           "mend or export the file again");
    return value;
  }

  /// Binary data begins after the end of the present line.
  void begin_data() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\r')) ++at_;
    if (at_ >= text_.size() || text_[at_] != '\n')
      fail("a line that goes on", "binary data starts on a new line", "export the file again");
    ++at_;
    ++next_line_;
    line_start_ = at_;
    in_data_ = true;
  }
  template <class Number>
  Number raw(const char* what) {
    line_ = next_line_;
    column_ = static_cast<int>(std::min<std::size_t>(at_ - line_start_ + 1, std::numeric_limits<int>::max()));
    std::array<char, sizeof(Number)> bytes;
    if (text_.size() - at_ < bytes.size())
      fail("the file ends early", fmt::format("{} should follow", what), "export the file again");
    std::copy_n(text_.data() + at_, bytes.size(), bytes.begin());
    if (swap_) std::reverse(bytes.begin(), bytes.end());
    at_ += bytes.size();
    Number value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  double real(const char* what) {
    if (!in_data_) return number<double>(what);
    const double value = raw<double>(what);
    if (!std::isfinite(value))
      fail(fmt::format("{}", value), fmt::format("{} should be a finite number", what), "export the file again");
    return value;
  }
  long long integer(const char* what, Stored stored = Stored::int32) {
    if (!in_data_) return number<long long>(what);
    return stored == Stored::int32 ? raw<std::int32_t>(what) : raw<std::int64_t>(what);
  }
  long long count(const char* what, Stored stored = Stored::int32) {
    const long long n = integer(what, stored);
    if (n < 0 || n > kMostTets || static_cast<std::uint64_t>(n) > text_.size())
      fail(fmt::format("{} as {}", n, what), "at least 0 and no more than the file has room for",
           "export the file again");
    return n;
  }
  void need_end(std::string_view section) {
    in_data_ = false;
    if (!next()) fail("the file ends early", fmt::format("{} should follow", section), "export the file again");
    if (word_ != section)
      fail(quoted(word_), fmt::format("{} should follow", section), "mend the counts or export the file again");
  }
  void skip_section() {
    const FilePlace start = here();
    const std::string name(word_), end = "$End" + name.substr(1);
    if (binary_) {
      at_ = std::min(text_.find(end, at_), text_.size());
      if (next()) return;
    }
    while (next())
      if (word_ == end) return;
    draft_.fail(start, fmt::format("section {} does not end", impinge::quoted(name)), fmt::format("{} closes it", end),
                "export the file again");
  }

  void read_format() {
    need("the version");
    const std::string version(word_);
    if (version != "2.2" && version != "4.1")
      fail(fmt::format("version {}", impinge::quoted(version)), "versions 2.2 and 4.1 are read",
           "save it with -format msh41 or msh22");
    legacy_ = version == "2.2";
    const long long type = integer("the file type");
    binary_ = type == 1;
    if (type != 0 && type != 1)
      fail(fmt::format("file type {}", type), "0 (text) and 1 (binary) are read", "export the file again");
    const long long size = integer("the data size");
    if (size != 8) fail(fmt::format("data size {}", size), "8 (double) is read", "export the file again");
    if (binary_) {
      begin_data();
      const auto one = raw<std::int32_t>("the number 1");
      swap_ = one == 1 << 24;
      if (one != 1 && !swap_)
        fail(fmt::format("{} to tell the order of bytes", one), "1 is allowed", "export the file again");
    }
    need_end("$EndMeshFormat");
  }

  void add_node(long long tag, const FilePlace& place) {
    if (!index_.emplace(tag, static_cast<int>(draft_.vertex_place.size())).second)
      draft_.fail(place, fmt::format("node {} a second time", tag), "every node has a tag of its own",
                  "export the file again");
    draft_.vertex_place.push_back(place);
    draft_.vertex_label.push_back(tag);
  }
  void read_position() {
    const double x = real("x"), y = real("y"), z = real("z");
    draft_.result.mesh.vertices.emplace_back(x, y, z);
  }

  void read_nodes_2() {
    const long long n = count("the number of nodes");
    if (binary_) begin_data();
    for (long long i = 0; i < n; ++i) {
      const long long tag = integer("a node's tag");
      add_node(tag, here());
      read_position();
    }
    need_end("$EndNodes");
  }

  void read_nodes_4() {
    if (binary_) begin_data();
    const long long blocks = count("the number of blocks", Stored::size64),
                    total = count("the number of nodes", Stored::size64);
    integer("the smallest tag", Stored::size64);
    integer("the largest tag", Stored::size64);
    for (long long b = 0; b < blocks; ++b) {
      const long long dimension = integer("an entity's dimension");
      if (dimension < 0 || dimension > 3)
        fail(fmt::format("dimension {}", dimension), "0 to 3 are allowed", "export the file again");
      integer("an entity's tag");
      const long long parametric = integer("whether nodes are parametric");
      const long long n = count("the number of nodes in a block", Stored::size64);
      for (long long i = 0; i < n; ++i) {
        const long long tag = integer("a node's tag", Stored::size64);
        add_node(tag, here());
      }
      for (long long i = 0; i < n; ++i) {
        read_position();
        if (parametric != 0)
          for (long long k = 0; k < dimension; ++k) real("a node's parameter");
      }
    }
    if (static_cast<long long>(draft_.vertex_place.size()) != total)
      fail(fmt::format("{} nodes", draft_.vertex_place.size()), fmt::format("{} were announced", total),
           "export the file again");
    need_end("$EndNodes");
  }

  const ElementType& element_type(long long type) const {
    if (type < 1 || type > static_cast<long long>(std::size(kTypes)))
      fail(fmt::format("element type {}", type), "Gmsh's types 1 to 31 are known", "export tetrahedra");
    const ElementType& t = kTypes[type - 1];
    if (t.dimension == 3 && type != kTetrahedron)
      fail(fmt::format("a {} (element type {})", t.name, type), "volume elements must be tetrahedra of 4 nodes",
           "mesh again with first-order tetrahedra");
    return t;
  }

  /// The nodes of one element, of which tetrahedra are kept.
  void read_element(long long tag, long long type, const ElementType& t, const FilePlace& place) {
    Tet tet{};
    for (int k = 0; k < t.nodes; ++k) {
      const long long node = integer("an element's node", legacy_ ? Stored::int32 : Stored::size64);
      const auto found = index_.find(node);
      if (found == index_.end())
        fail(fmt::format("node {}", node), "it is in no $Nodes section", "export the file again");
      if (k < 4) tet[k] = found->second;
    }
    if (type == 2) ++triangles_;
    if (type != kTetrahedron) return;
    draft_.result.mesh.tets.push_back(tet);
    draft_.tet_place.push_back(place);
    draft_.tet_label.push_back(tag);
  }

  void read_elements_2() {
    const long long n = count("the number of elements");
    if (binary_) return read_element_blocks_2(n);
    for (long long i = 0; i < n; ++i) {
      const long long tag = integer("an element's number");
      const FilePlace place = here();
      const long long type = integer("an element's type");
      const ElementType& t = element_type(type);
      const long long tags = count("an element's number of tags");
      for (long long k = 0; k < tags; ++k) integer("an element's tag");
      read_element(tag, type, t, place);
    }
    need_end("$EndElements");
  }

  /// Binary 2.2: elements of one type and number of tags follow one header.
  void read_element_blocks_2(long long n) {
    begin_data();
    for (long long read = 0; read < n;) {
      const long long type = integer("an element's type");
      const ElementType& t = element_type(type);
      const long long follow = count("the number of elements in a block"), tags = count("an element's number of tags");
      if (follow == 0 || follow > n - read)
        fail(fmt::format("a block of {} elements", follow), fmt::format("{} are left", n - read),
             "export the file again");
      for (long long i = 0; i < follow; ++i, ++read) {
        const long long tag = integer("an element's number");
        const FilePlace place = here();
        for (long long k = 0; k < tags; ++k) integer("an element's tag");
        read_element(tag, type, t, place);
      }
    }
    need_end("$EndElements");
  }

  void read_elements_4() {
    if (binary_) begin_data();
    const long long blocks = count("the number of blocks", Stored::size64),
                    total = count("the number of elements", Stored::size64);
    integer("the smallest tag", Stored::size64);
    integer("the largest tag", Stored::size64);
    long long read = 0;
    for (long long b = 0; b < blocks; ++b) {
      integer("an entity's dimension");
      integer("an entity's tag");
      const long long type = integer("an element type");
      const ElementType& t = element_type(type);
      const long long n = count("the number of elements in a block", Stored::size64);
      for (long long i = 0; i < n; ++i, ++read) {
        const long long tag = integer("an element's tag", Stored::size64);
        const FilePlace place = here();
        read_element(tag, type, t, place);
      }
    }
    if (read != total)
      fail(fmt::format("{} elements", read), fmt::format("{} were announced", total), "export the file again");
    need_end("$EndElements");
  }

  TetDraft draft_;
  std::string_view text_, word_;
  std::size_t at_ = 0, line_start_ = 0;
  int next_line_ = 1, line_ = 1, column_ = 1;
  bool legacy_ = false;  // 2.2
  bool binary_ = false, swap_ = false;
  bool in_data_ = false;  // between the text of a binary file
  long long triangles_ = 0;
  std::unordered_map<long long, int> index_;
};

}  // namespace

TetFile parse_msh(const std::string& name, std::string_view bytes) { return MshReader(name, bytes).read(); }

}  // namespace impinge
