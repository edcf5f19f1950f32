// Damaged files: every reader either gives a mesh whose indices are in range and whose coordinates are finite, or
// throws InputError. Anything else (a crash, another exception, a hang) fails. Seeds are fixed, so a failure repeats.
#include <catch2/catch.hpp>

#include <algorithm>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/core/utf8.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "engine/io/scene/toml.hpp"
#include "engine/io/scene/toml_prescan.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/random.hpp"
#include "viewer/bundle/bundle.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Sample {
  const char* name;
  std::string bytes;
};

std::vector<Sample> samples() {
  const TriangleMesh mesh = tetrahedron();
  return {{"a.off", off_text(mesh)},          {"a.obj", obj_text(mesh)},         {"a.ply", ply_ascii(mesh)},
          {"b.ply", ply_binary(mesh, false)}, {"c.ply", ply_binary(mesh, true)}, {"a.stl", stl_ascii(mesh)},
          {"b.stl", stl_binary(mesh)}};
}

// true if the mesh was taken
bool try_mesh(const std::string& name, const std::string& bytes) {
  try {
    const TriangleMesh mesh = parse_mesh(name, bytes);
    for (const Vec3& v : mesh.vertices) REQUIRE(v.allFinite());
    for (const Triangle& t : mesh.triangles)
      for (const int v : t) REQUIRE((v >= 0 && v < static_cast<int>(mesh.vertices.size())));
    return true;
  } catch (const InputError& error) {
    REQUIRE(std::string(error.what()).rfind(name + ":", 0) == 0);
    return false;
  }
}

std::string damaged(const std::string& bytes, Random& random) {
  std::string out = bytes;
  for (int n = 1 + random.below(4); n > 0; --n) {
    const std::size_t at = static_cast<std::size_t>(random.below(static_cast<int>(out.size())));
    switch (random.below(5)) {
      case 0:
        out[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        out[at] = static_cast<char>(out[at] ^ (1 << random.below(8)));
        break;
      case 2:
        out.erase(at, static_cast<std::size_t>(1 + random.below(8)));
        break;
      case 3:
        out.insert(at, out.substr(static_cast<std::size_t>(random.below(static_cast<int>(out.size()))),
                                  static_cast<std::size_t>(1 + random.below(16))));
        break;
      default:
        out[at] = "0123456789-+.e[]{}=#\"\n"[random.below(22)];
        break;
    }
    if (out.empty()) return out;
  }
  return out;
}

constexpr const char* kScene = R"([simulation]
frame_time = 0.0166
gravity = [0, -9.81, 0]   # m/s²
[[body]]
name = "floor"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
text = """several
lines""" 
[view]
camera = { eye = [3, 2, 4], target = [0, 0.5, 0] }
[a.b]
c.d = [ { e.f = 0x1F, 'gä' = "\u00E4" }, 1979-05-27T07:32:00Z ]
)";

std::string bundle() {
  BundleHead head;
  head.scene = "a scene.toml";
  head.frame = 85;
  head.stage = 7;
  head.state_hash = 0x0123456789abcdef;
  return format_bundle(head, {{"run.toml", kScene},
                              {"stats.csv", "frame\n0\n"},
                              {"snapshots/000085.bin", std::string(1500, '\xa5')},
                              {"meshes/2/a.off", off_text(tetrahedron())}});
}

/// Whether it was taken.
bool try_bundle(const std::string& bytes) {
  try {
    const Bundle bundle = parse_bundle("a.tar", bytes);
    for (const auto& [name, part] : bundle.parts) {
      REQUIRE(is_tar_name(name));
      REQUIRE(part.size() <= bytes.size());
    }
    return true;
  } catch (const InputError& error) {
    const std::string message = error.what();
    REQUIRE(message.rfind("a.tar", 0) == 0);
    REQUIRE(message.find('\n') == std::string::npos);
    REQUIRE(message.size() < 1000);
    return false;
  }
}

/// Levels of tables and arrays below a node.
int depth(const TomlNode& node) {
  int most = 0;
  for (const TomlNode& item : node.items) most = std::max(most, 1 + depth(item));
  for (const TomlEntry& entry : node.entries) most = std::max(most, 1 + depth(entry.value));
  return most;
}

bool is_utf8(const TomlNode& node) {
  const auto fine = [](const std::string& text) { return find_invalid_utf8(text) == std::string::npos; };
  return fine(node.string) && std::all_of(node.items.begin(), node.items.end(), is_utf8) &&
         std::all_of(node.entries.begin(), node.entries.end(),
                     [&](const TomlEntry& entry) { return fine(entry.key) && is_utf8(entry.value); });
}

}  // namespace

TEST_CASE("mesh files cut anywhere are refused or read, never more") {
  int refused = 0;
  for (const Sample& sample : samples())
    for (std::size_t n = 0; n < sample.bytes.size(); ++n) refused += !try_mesh(sample.name, sample.bytes.substr(0, n));
  CHECK(refused > 1000);
}

TEST_CASE("mesh files with damaged bytes are refused or read, never more") {
  int refused = 0, taken = 0;
  for (const Sample& sample : samples()) {
    Random random(20240 + sample.bytes.size());
    for (int i = 0; i < 4000; ++i) (try_mesh(sample.name, damaged(sample.bytes, random)) ? taken : refused)++;
  }
  CHECK(refused > 1000);
  CHECK(taken > 1000);
}

TEST_CASE("a damaged scene text is refused or read, never more") {
  const std::string scene = kScene;
  int refused = 0, taken = 0;
  const auto attempt = [&](const std::string& text) {
    try {
      const TomlNode root = parse_toml("scene.toml", text);
      // a plain key is no level that is counted, so that a level may hold two
      REQUIRE(depth(root) <= 2 * kMostTomlDepth + 1);
      REQUIRE(is_utf8(root));
      ++taken;
    } catch (const InputError& error) {
      const std::string message = error.what();
      REQUIRE(message.rfind("scene.toml:", 0) == 0);
      REQUIRE(find_invalid_utf8(message) == std::string::npos);
      REQUIRE(message.find('\n') == std::string::npos);
      REQUIRE(message.size() < 1000);
      ++refused;
    }
  };
  for (std::size_t n = 0; n < scene.size(); ++n) attempt(scene.substr(0, n));
  Random random(77);
  for (int i = 0; i < 3000; ++i) attempt(damaged(scene, random));
  // what nests, and bytes that are not UTF-8, at any place
  const std::string parts[] = {"[",
                               "{",
                               "]",
                               "}",
                               "a.",
                               "[a.",
                               "[[",
                               "'''",
                               "\"\"\"",
                               "{a.b=",
                               "[[[[[[[[",
                               "a.a.a.a.a.a.a.a.",
                               "\xE4",
                               "\xC3",
                               "\xED\xA0\x80",
                               "\xF0\x9F\x98\x80",
                               "\xEF\xBB\xBF",
                               "\\",
                               "1e999",
                               "\r",
                               "x"};
  for (int i = 0; i < 6000; ++i) {
    std::string text = scene;
    for (int n = 1 + random.below(3); n > 0; --n) {
      const std::string& part = parts[random.below(static_cast<int>(std::size(parts)))];
      std::string many = part;
      for (int k = random.below(3) == 0 ? random.below(2000) : 0; k > 0; --k) many += part;
      text.insert(static_cast<std::size_t>(random.below(static_cast<int>(text.size()))), many);
    }
    attempt(text);
  }
  CHECK(refused > 3000);
  CHECK(taken > 500);
}

TEST_CASE("a bundle with a byte missing or wrong anywhere is refused, and never more than that") {
  const std::string whole = bundle();
  REQUIRE(try_bundle(whole));
  for (std::size_t n = 0; n < whole.size(); ++n) REQUIRE_FALSE(try_bundle(whole.substr(0, n)));
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const int bit : {0, 5, 7}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
      CAPTURE(at, bit);
      REQUIRE_FALSE(try_bundle(bytes));
    }
  Random random(1606);
  int refused = 0;
  for (int i = 0; i < 6000; ++i)
    if (const std::string bytes = damaged(whole, random); bytes != whole) refused += !try_bundle(bytes) ? 1 : 0;
  CHECK(refused > 5900);
}

TEST_CASE("a bundle whose head is wrong and says the right hash of itself is refused or read, never more") {
  const std::string whole = bundle();
  Random random(1607);
  int refused = 0, taken = 0;
  for (int i = 0; i < 6000; ++i) {
    std::vector<TarPart> parts = parse_tar("a.tar", whole);
    const std::string begin = "hash = \"", end = "\"\n";
    std::string head(parts[0].bytes.substr(begin.size() + 16 + end.size()));
    head = damaged(head, random);
    head = begin + hex64(hash_bytes(head)) + end + head;
    parts[0].bytes = head;
    (try_bundle(format_tar(parts)) ? taken : refused)++;
  }
  CHECK(refused > 3000);
  CHECK(taken > 20);
}

TEST_CASE("what would exhaust the TOML parser is stopped before it") {
  const auto refused = [](const std::string& text) {
    try {
      parse_toml("s.toml", text);
      return false;
    } catch (const InputError&) {
      return true;
    }
  };
  CHECK(refused("a = " + std::string(100'000, '[')));
  CHECK(refused("a = " + std::string(100'000, '{')));
  for (const int count : {1000, 12'000, 30'000}) {
    std::string key = "a";
    for (int i = 1; i < count; ++i) key += ".a";
    CHECK(refused(key + " = 1\n"));
    CHECK(refused("[" + key + "]\n"));
    CHECK(refused("x = {" + key + " = 1}\n"));
  }
  CHECK(refused("a = [" + std::string(200'000, '1') + "]"));
  CHECK(refused("# " + std::string(200'000, 'x')));
  CHECK(refused("a = \"" + std::string(200'000, 'x') + "\""));
  CHECK(refused(std::string(40u << 20, '\n')));
  CHECK_FALSE(refused("a = \"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[\" # [[[[[\n"));
}
