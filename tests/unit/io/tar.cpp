// Several files in one: what is written is a tar to every tar, and what is read is only what is written.
#include "engine/io/tar.hpp"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cstdlib>

#include "engine/core/error.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A tar of one part as others write it: any name, size and kind, the sum right.
std::string one(std::string name, const std::string& bytes, char kind = '0', std::string size = "") {
  std::string block = format_tar({{std::string(name.size(), 'x'), bytes}});
  std::copy(name.begin(), name.end(), block.begin());
  block[156] = kind;
  if (!size.empty()) std::copy(size.begin(), size.end(), block.begin() + 124);
  for (int i = 148; i < 156; ++i) block[static_cast<std::size_t>(i)] = ' ';
  unsigned sum = 0;
  for (int i = 0; i < 512; ++i) sum += static_cast<unsigned char>(block[static_cast<std::size_t>(i)]);
  char digits[8];
  std::snprintf(digits, sizeof digits, "%06o", sum);
  std::copy(digits, digits + 7, block.begin() + 148);
  return block;
}

bool is_refused(const std::string& bytes) {
  try {
    parse_tar("x.tar", bytes);
    return false;
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).rfind("x.tar: byte ", 0) == 0);
    return true;
  }
}

}  // namespace

TEST_CASE("tar unpacks what is written, and what is written comes back") {
  const std::string long_name = fmt::format("{:a<90}/{:b<60}/{:c<80}", "", "", "");
  const std::string zeros(1024, '\0'), text = "text\n", exact(512, 'e');
  const std::vector<TarPart> parts = {{"f/zeros", zeros}, {"f/empty", ""}, {long_name, text}, {"f/g/exact", exact}};
  const std::string bytes = format_tar(parts);
  CHECK(bytes.size() % 512 == 0);
  const std::vector<TarPart> back = parse_tar("x.tar", bytes);
  REQUIRE(back.size() == parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    CHECK(back[i].name == parts[i].name);
    CHECK(back[i].bytes == parts[i].bytes);
  }
  const TempFolder folder;
  folder.write("x.tar", bytes);
  REQUIRE(std::system(("tar xf " + (folder / "x.tar").string() + " -C " + folder.path().string()).c_str()) == 0);
  for (const TarPart& part : parts) CHECK(slurp(folder / part.name) == part.bytes);
}

TEST_CASE("a tar's names lead nowhere else") {
  for (const char* name : {"a", "a/b", "a b/c.d", "...", "-", "\xc3\xa4"}) CHECK(is_tar_name(name));
  for (const char* name :
       {"", "/", "/a", "a/", "a//b", ".", "..", "../a", "a/../b", "a/..", "./a", "a/.", "a\\b", "a\nb", "\x7f"}) {
    CAPTURE(name);
    CHECK_FALSE(is_tar_name(name));
    if (*name != 0) CHECK(is_refused(one(name, "x")));
    CHECK_THROWS_AS(format_tar({{name, "x"}}), InputError);
  }
  CHECK_FALSE(is_refused(one("a", "x")));
  CHECK(is_refused(format_tar({{"a", "x"}, {"a", "y"}})));
  CHECK(is_refused(format_tar({{"a/b", "x"}, {"a", "y"}})));
  CHECK(is_refused(format_tar({{"a", "x"}, {"a/b", "y"}})));
  CHECK_THROWS_AS(format_tar({{std::string(101, 'a'), "x"}}), InputError);
}

TEST_CASE("links, folders and sizes that aren't there are no parts of a tar") {
  for (const char kind : {'1', '2', '3', '5', '6', 'L', 'x', 'g', 'S', '\0'}) CHECK(is_refused(one("a", "x", kind)));
  for (const char* size : {"77777777777", "00000100000", "-0000000001", "\x80\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff"})
    CHECK(is_refused(one("a", "x", '0', size)));
  CHECK(is_refused(""));
  CHECK(is_refused(std::string(512, '\0')));
  CHECK(is_refused(std::string(1536, '\0')));
}
