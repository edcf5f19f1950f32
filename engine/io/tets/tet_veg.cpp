// Vega FEM's .veg, ASCII: vertices, elements, then materials, sets of elements and regions, with textual *INCLUDE.
//
// The grammar is Vega 4's own: comments only where `#` is the first character of a line, numbers separated by blanks,
// commas or tabs, keywords as prefixes at the start of a line. Vega itself checks little; here everything that doesn't
// fit is refused.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>
#include <map>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/tets/tet_draft.hpp"
#include "engine/io/text_lines.hpp"

namespace impinge {
namespace {

constexpr std::size_t kDeepestInclude = 8;

struct OrthotropicKind {
  const char* name;
  std::size_t shears, ratios, rotation;
};
constexpr OrthotropicKind kOrthotropic[] = {{"ORTHOTROPIC", 3, 3, 9},      {"ORTHOTROPIC_N3G3R9", 3, 3, 9},
                                            {"ORTHOTROPIC_N3G3", 3, 3, 0}, {"ORTHOTROPIC_N1G1R9", 1, 1, 9},
                                            {"ORTHOTROPIC_N1G1", 1, 1, 0}, {"ORTHOTROPIC_N1R9", 0, 1, 9},
                                            {"ORTHOTROPIC_N1", 0, 1, 0}};

std::string without_blanks(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (c != ' ' && c != '\t' && c != '\r') out += c;
  return out;
}

class VegReader {
 public:
  VegReader(const std::string& name, std::string_view bytes, std::filesystem::path directory, const FileGuard& guard)
      : directory_(std::move(directory)), guard_(guard) {
    open(name, std::string(bytes), {});
  }

  TetFile read() {
    next_line();
    while (!end_) {
      if (line_[0] != '*')
        fail(1, quoted(line_), "a section (*VERTICES, *ELEMENTS, *MATERIAL, *SET, *REGION) should follow",
             "remove the line or start it with #");
      if (keyword("*VERTICES"))
        read_vertices();
      else if (keyword("*ELEMENTS"))
        read_elements();
      else if (keyword("*MATERIAL"))
        read_material();
      else if (keyword("*SET"))
        read_set();
      else if (keyword("*REGION"))
        read_region();
      else
        fail(1, quoted(line_), "the sections are *VERTICES, *ELEMENTS, *MATERIAL, *SET, *REGION",
             "correct or remove it");
    }
    if (draft_.result.mesh.vertices.empty())
      fail(1, "no *VERTICES section", "a mesh has vertices and elements", "export the file again");
    if (draft_.result.mesh.tets.empty())
      fail(1, "no *ELEMENTS section", "a mesh has vertices and elements", "export the file again");
    assign_materials();
    return finish_tets(std::move(draft_), false);
  }

 private:
  struct Source {
    int file;
    std::string_view rest;
    int line = 0;
    std::filesystem::path path;
  };

  [[noreturn]] void fail(int column, const std::string& found, const std::string& allowed,
                         const std::string& remedy) const {
    draft_.fail({place_.file, place_.line, column}, found, allowed, remedy);
  }
  bool keyword(std::string_view word) const { return line_.substr(0, word.size()) == word; }

  void open(const std::string& name, std::string bytes, const std::filesystem::path& path) {
    draft_.files.push_back(name);
    texts_.push_back(std::move(bytes));
    const std::string& text = texts_.back();
    place_ = {static_cast<int>(draft_.files.size()) - 1, 1, 1};
    for (const char c : std::string_view(text).substr(0, 512))
      if (static_cast<unsigned char>(c) < 9 || (c > 13 && c < 32))
        fail(1, "bytes that are not text", "ASCII .veg files are read", "convert Vega's binary format to ASCII");
    if (text.find('\n') == std::string::npos && text.find('\r') != std::string::npos)
      fail(1, "lines that end in CR alone", "lines end in LF or CR LF", "convert the line ends");
    sources_.push_back({place_.file, text, 0, path});
  }

  /// The next line that is no comment, with *INCLUDE followed; sets end_ at the end of the first file.
  void next_line() {
    for (;;) {
      Source& source = sources_.back();
      if (source.rest.empty()) {
        if (sources_.size() == 1) {
          end_ = true;
          place_ = {source.file, source.line + 1, 1};
          line_ = {};
          return;
        }
        sources_.pop_back();
        continue;
      }
      const std::size_t length = source.rest.find('\n');
      line_ = source.rest.substr(0, length);
      source.rest.remove_prefix(length == std::string_view::npos ? source.rest.size() : length + 1);
      place_ = {source.file, ++source.line, 1};
      if (line_.empty() || line_[0] == '#' || line_[0] == '\r') continue;
      while (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
      if (line_.find_first_not_of(" \t") == std::string_view::npos)
        fail(1, "a line of blanks", "Vega takes only empty lines and those that start with # for remarks",
             "remove the blanks");
      if (!keyword("*INCLUDE")) return;
      include();
    }
  }

  void include() {
    std::string_view name = line_.substr(std::min<std::size_t>(line_.size(), 9));
    while (!name.empty() && (name.back() == ' ' || name.back() == '\t')) name.remove_suffix(1);
    if (name.empty() || line_[8] != ' ')
      fail(9, "no file name", "*INCLUDE, one blank and a file name are wanted", "name the file");
    const std::filesystem::path relative(name);
    if (relative.is_absolute())
      fail(10, impinge::quoted(name), "names relative to the mesh's folder are read", "copy the file beside the mesh");
    for (const auto& part : relative)
      if (part == "..")
        fail(10, impinge::quoted(name), "names inside the mesh's folder are read", "copy the file beside the mesh");
    const std::filesystem::path path = (directory_ / relative).lexically_normal();
    for (const Source& s : sources_)
      if (s.path == path || (s.path.empty() && path.filename() == std::filesystem::path(draft_.files[0]).filename() &&
                             path.parent_path() == directory_.lexically_normal()))
        fail(10, impinge::quoted(name), "a file can't include itself", "remove the line");
    if (sources_.size() >= kDeepestInclude)
      fail(10, impinge::quoted(name), fmt::format("files may include one another {} deep", kDeepestInclude - 1),
           "put the parts into one file");
    if (static_cast<int>(texts_.size()) > kMostIncludes)
      fail(10, impinge::quoted(name), fmt::format("{} files may be included in all", kMostIncludes),
           "put the parts into one file");
    if (const auto target = guard_.refused(path))
      fail(10, fmt::format("{} leads out of the scene's folder ({})", impinge::quoted(name), target->string()),
           "files inside it are read", "copy the file beside the mesh");
    if (!is_file(path))
      fail(10, fmt::format("{} is not there", impinge::quoted(name)), "an existing file is wanted",
           "put it beside the mesh");
    open(path.string(), read_file(path, kLargestTetFile), path);
  }

  void split() {
    words_.clear();
    std::size_t i = 0;
    while (i < line_.size()) {
      if (line_[i] == ' ' || line_[i] == ',' || line_[i] == '\t') {
        ++i;
        continue;
      }
      const std::size_t begin = i;
      while (i < line_.size() && line_[i] != ' ' && line_[i] != ',' && line_[i] != '\t') ++i;
      words_.push_back(line_.substr(begin, i - begin));
    }
  }
  int column(std::size_t word) const { return static_cast<int>(words_[word].data() - line_.data()) + 1; }

  /// The next line as words; it must not be the next section.
  void need(const std::string& what) {
    next_line();
    if (end_) fail(1, "the file ends early", what + " should follow", "mend the counts or export the file again");
    if (line_[0] == '*') fail(1, quoted(line_), what + " should follow", "mend the counts or export the file again");
    split();
    if (words_.empty()) fail(1, quoted(line_), what + " should follow", "remove the line");
  }
  void need_words(std::size_t count, const char* what) const {
    if (words_.size() < count)
      fail(static_cast<int>(line_.size()) + 1, fmt::format("the line ends after {} entries", words_.size()),
           fmt::format("{} has {}", what, count), "export the file again");
    if (words_.size() > count)
      fail(column(count), quoted(words_[count]), fmt::format("{} has {} entries", what, count), "remove what follows");
  }
  template <class Number>
  Number number(std::size_t word, const char* what) const {
    if (word >= words_.size())
      fail(static_cast<int>(line_.size()) + 1, "the line ends early", fmt::format("{} should follow", what),
           "export the file again");
    std::string_view w = words_[word];
    if (w.size() > 1 && w[0] == '+' && w[1] != '-') w.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    bool good = error == std::errc() && end == w.data() + w.size();
    if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(value);
    if (!good)
      fail(column(word), quoted(words_[word]),
           fmt::format("{} should be a {} number", what, std::is_floating_point_v<Number> ? "finite" : "whole"),
           "mend or export the file again");
    return value;
  }
  long long count(const char* what) const {
    const auto n = number<long long>(0, what);
    if (n < 1 || n > kMostTets || static_cast<std::uint64_t>(n) > texts_.back().size() + texts_.front().size())
      fail(column(0), fmt::format("{} as {}", n, what), "at least 1 and no more than the file has room for",
           "export the file again");
    return n;
  }
  double positive(std::size_t word, const char* what) const {
    const auto value = number<double>(word, what);
    if (!(value > 0.0)) fail(column(word), fmt::format("{} {}", what, value), "it must be positive", "correct it");
    return value;
  }

  void read_vertices() {
    TetMesh& mesh = draft_.result.mesh;
    if (!mesh.vertices.empty()) fail(1, "a second *VERTICES section", "one is allowed", "keep one of them");
    need("the number of vertices");
    const long long n = count("the number of vertices");
    bool from_zero = false;
    for (long long i = 0; i < n; ++i) {
      need(fmt::format("vertex {} of {}", i + 1, n));
      need_words(4, "a vertex");
      const auto label = number<long long>(0, "a vertex's index");
      from_zero = from_zero || label == 0;
      const double x = number<double>(1, "x"), y = number<double>(2, "y"), z = number<double>(3, "z");
      mesh.vertices.emplace_back(x, y, z);
      draft_.vertex_place.push_back(place_);
    }
    base_ = from_zero ? 0 : 1;
    for (long long i = 0; i < n; ++i) draft_.vertex_label.push_back(i + base_);
    next_line();
    if (!end_ && line_[0] != '*')
      fail(1, quoted(line_), fmt::format("a section should follow: {} vertices were announced", n), "mend the count");
  }

  void read_elements() {
    TetMesh& mesh = draft_.result.mesh;
    if (mesh.vertices.empty()) fail(1, "*ELEMENTS before *VERTICES", "vertices come first", "export the file again");
    if (!mesh.tets.empty()) fail(1, "a second *ELEMENTS section", "one is allowed", "keep one of them");
    need("the element type");
    if (line_.substr(0, 3) != "TET")
      fail(1, fmt::format("element type {}", quoted(line_)),
           line_.substr(0, 5) == "CUBIC" ? "cubes are not read; the type TET is" : "the type TET is read",
           "convert the mesh to tetrahedra");
    need("the number of elements");
    const long long n = count("the number of elements");
    if (words_.size() > 1 && number<long long>(1, "the number of corners") != 4)
      fail(column(1), fmt::format("{} corners", words_[1]), "tetrahedra have 4", "convert the mesh to tetrahedra");
    bool from_zero = false;
    const long long vertices = static_cast<long long>(mesh.vertices.size());
    for (long long i = 0; i < n; ++i) {
      need(fmt::format("element {} of {}", i + 1, n));
      need_words(5, "an element");
      const auto label = number<long long>(0, "an element's index");
      from_zero = from_zero || label == 0;
      Tet tet;
      for (int k = 0; k < 4; ++k) {
        const auto v = number<long long>(k + 1, "a vertex index");
        if (v < base_ || v >= base_ + vertices)
          fail(column(k + 1), fmt::format("vertex {}", v),
               fmt::format("there are vertices {} to {} (counted from {})", base_, base_ + vertices - 1, base_),
               "export the file again");
        tet[k] = static_cast<int>(v - base_);
      }
      mesh.tets.push_back(tet);
      draft_.tet_place.push_back(place_);
      draft_.tet_label.push_back(label);
    }
    set_base_ = from_zero ? 0 : 1;
    next_line();
    if (!end_ && line_[0] != '*')
      fail(1, quoted(line_), fmt::format("a section should follow: {} elements were announced", n), "mend the count");
  }

  void need_mesh() const {
    if (draft_.result.mesh.tets.empty())
      fail(1, quoted(line_), "*VERTICES and *ELEMENTS come first", "export the file again");
  }
  std::string section_name(std::size_t keyword_length) const {
    std::string name = without_blanks(line_.substr(keyword_length));
    if (name.empty()) fail(static_cast<int>(line_.size()) + 1, "no name", "a name should follow", "name it");
    return name;
  }

  void read_material() {
    need_mesh();
    TetFileMaterial material;
    material.name = section_name(9);
    if (material_index_.count(material.name) != 0)
      fail(10, fmt::format("material {} a second time", impinge::quoted(material.name)),
           "every material has a name of its own", "rename one of them");
    need("a material's type and parameters");
    const std::string type(words_[0]);
    if (type == "ENU") {
      need_words(4, "an ENU material");
      material.density = positive(1, "density");
      material.young = positive(2, "Young's modulus");
      material.poisson = number<double>(3, "Poisson's ratio");
      if (!(material.poisson > -1.0 && material.poisson < 0.5))
        fail(column(3), fmt::format("Poisson's ratio {}", material.poisson),
             "it must lie between -1 and 0.5, both excluded", "correct it");
    } else if (type == "MOONEYRIVLIN") {
      need_words(5, "a MOONEYRIVLIN material");
      material.isotropic = false;
      material.density = positive(1, "density");
      for (std::size_t k = 2; k < 5; ++k) number<double>(k, "a parameter");
    } else {
      const auto* kind = std::find_if(std::begin(kOrthotropic), std::end(kOrthotropic),
                                      [&](const OrthotropicKind& k) { return type == k.name; });
      if (kind == std::end(kOrthotropic))
        fail(column(0), fmt::format("material type {}", impinge::quoted(type)),
             "ENU, ORTHOTROPIC (and its variants) and MOONEYRIVLIN are known", "correct it");
      need_words(5 + kind->ratios + kind->shears + kind->rotation, kind->name);
      material.isotropic = false;
      material.density = positive(1, "density");
      for (std::size_t k = 2; k < 5; ++k) positive(k, "Young's modulus");
      for (std::size_t k = 0; k < kind->ratios; ++k) number<double>(5 + k, "Poisson's ratio");
      for (std::size_t k = 0; k < kind->shears; ++k) positive(5 + kind->ratios + k, "shear modulus");
      for (std::size_t k = 0; k < kind->rotation; ++k)
        number<double>(5 + kind->ratios + kind->shears + k, "a rotation's entry");
    }
    material_index_[material.name] = static_cast<int>(draft_.result.materials.size());
    draft_.result.materials.push_back(material);
    next_line();
    if (!end_ && line_[0] != '*')
      fail(1, quoted(line_), "a section should follow a material's one line", "remove the line");
  }

  void read_set() {
    need_mesh();
    const std::string name = section_name(4);
    if (name == "allElements" || sets_.count(name) != 0)
      fail(5, fmt::format("set {} a second time", impinge::quoted(name)),
           "every set has a name of its own (allElements is one)", "rename one of them");
    std::vector<int>& set = sets_[name];
    const long long elements = static_cast<long long>(draft_.result.mesh.tets.size());
    for (next_line(); !end_ && line_[0] != '*'; next_line()) {
      split();
      for (std::size_t k = 0; k < words_.size(); ++k) {
        const auto e = number<long long>(k, "an element's index");
        if (e < set_base_ || e >= set_base_ + elements)
          fail(column(k), fmt::format("element {}", e),
               fmt::format("there are elements {} to {} (counted from {})", set_base_, set_base_ + elements - 1,
                           set_base_),
               "correct the set");
        set.push_back(static_cast<int>(e - set_base_));
      }
    }
  }

  void read_region() {
    need_mesh();
    need("a set and a material");
    const std::string line = without_blanks(line_);
    const std::size_t comma = line.find(',');
    if (comma == std::string::npos || comma == 0 || comma + 1 == line.size() ||
        line.find(',', comma + 1) != std::string::npos)
      fail(1, quoted(line_), "'set, material' is wanted", "correct it");
    const std::string set = line.substr(0, comma), material = line.substr(comma + 1);
    if (set != "allElements" && sets_.count(set) == 0)
      fail(1, fmt::format("set {}", impinge::quoted(set)), "it must be defined above", "correct the name");
    const auto found = material_index_.find(material);
    if (found == material_index_.end())
      fail(1, fmt::format("material {}", impinge::quoted(material)), "it must be defined above", "correct the name");
    std::vector<int>& of = draft_.result.element_material;
    of.resize(draft_.result.mesh.tets.size(), -1);
    if (set == "allElements")
      std::fill(of.begin(), of.end(), found->second);
    else
      for (const int e : sets_[set]) of[e] = found->second;
    next_line();
    if (!end_ && line_[0] != '*')
      fail(1, quoted(line_), "a section should follow a region's one line", "remove the line");
  }

  /// Elements in no region get the last material; a file without any gets Vega's default.
  void assign_materials() {
    TetFile& file = draft_.result;
    file.element_material.resize(file.mesh.tets.size(), -1);
    const auto left = std::count(file.element_material.begin(), file.element_material.end(), -1);
    if (left == 0) return;
    if (file.materials.empty()) {
      file.materials.push_back({"default", 1000.0, true, 1e9, 0.45});
      file.notes.push_back("the file has no material: density 1000, E 1e9, Poisson's ratio 0.45 are taken");
    } else {
      file.notes.push_back(
          fmt::format("{} elements in no region have the last material, '{}'", left, file.materials.back().name));
    }
    std::replace(file.element_material.begin(), file.element_material.end(), -1,
                 static_cast<int>(file.materials.size()) - 1);
  }

  TetDraft draft_;
  std::filesystem::path directory_;
  const FileGuard& guard_;
  std::deque<std::string> texts_;
  std::vector<Source> sources_;
  std::string_view line_;
  FilePlace place_;
  bool end_ = false;
  std::vector<std::string_view> words_;
  long long base_ = 1, set_base_ = 1;
  std::map<std::string, int> material_index_;
  std::map<std::string, std::vector<int>> sets_;
};

}  // namespace

TetFile parse_veg(const std::string& name, std::string_view bytes, const std::filesystem::path& directory,
                  const FileGuard& guard) {
  return VegReader(name, bytes, directory, guard).read();
}

}  // namespace impinge
