#include "engine/core/memory.hpp"

#include <catch2/catch.hpp>

#include "engine/core/error.hpp"

using namespace impinge;

TEST_CASE("sizes in bytes are read as people write them, and nothing else is") {
  CHECK(parse_bytes("1") == 1u);
  CHECK(parse_bytes("2048K") == 2048u * 1024u);
  CHECK(parse_bytes("1.5G") == 1610612736u);
  CHECK(parse_bytes("1T") == 1099511627776u);
  for (const char* text : {"", "0", "-1", "G", "4 G", "4GB", "4g", "1e3", "nan", "inf", "1e400", "99999999T"})
    CHECK_FALSE(parse_bytes(text).has_value());
  CHECK(describe_bytes(4.83 * 1073741824.0) == "4.83 GiB");
}

TEST_CASE("what does not fit beside what is held is refused with the number, the limit and the remedy") {
  REQUIRE(memory_in_use() > 1000000);
  const std::uint64_t before = given_memory_limit();
  set_memory_limit(std::uint64_t{1} << 30);
  CHECK_NOTHROW(check_memory("", "it", 1e6, "use less"));
  std::string message;
  try {
    check_memory("s.toml:3:4", "a cage", 3.0 * 1073741824.0, "use fewer cells");
  } catch (const InputError& error) {
    message = error.what();
  }
  CHECK(message.rfind("s.toml:3:4: a cage needs about 3", 0) == 0);
  CHECK(message.find("GiB of memory; 1 GiB are allowed (--memory-limit); use fewer cells, or raise --memory-limit") !=
        std::string::npos);
  set_memory_limit(before);
}
