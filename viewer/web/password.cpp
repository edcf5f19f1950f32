#include "viewer/web/password.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"

namespace impinge {
namespace {

constexpr std::size_t kLeast = 8, kMost = 128;
constexpr std::string_view kLetters = "abcdefghijkmnpqrstuvwxyz23456789";  // 32: every byte gives five bits evenly

}  // namespace

std::string random_password() {
  std::array<unsigned char, 16> bytes{};
  for (std::size_t have = 0; have < bytes.size();) {
    const ssize_t got = getrandom(bytes.data() + have, bytes.size() - have, 0);
    IMPINGE_ASSERT(got > 0);
    have += static_cast<std::size_t>(got);
  }
  std::string password;
  for (const unsigned char byte : bytes) password += kLetters[byte % kLetters.size()];
  return password;
}

std::string read_password(const std::filesystem::path& file) {
  const std::string text = read_file(file, 1 << 16);
  std::string line = text.substr(0, text.find_first_of("\r\n"));
  const bool printable = std::all_of(line.begin(), line.end(), [](char c) { return c > ' ' && c <= '~'; });
  if (line.size() < kLeast || line.size() > kMost || !printable)
    throw InputError(fmt::format(
        "{}:1: {} can't be a password; its first line is to have {} to {} printable ASCII characters and no "
        "blank; write another, or leave --password-file out and one is made",
        file.string(),
        line.empty() ? "an empty line"
        : !printable ? "a line with blanks or other characters than printable ASCII"
                     : fmt::format("a line of {} characters", line.size()),
        kLeast, kMost));
  return line;
}

bool is_same_password(std::string_view given, std::string_view wanted) {
  unsigned char differs = given.size() == wanted.size() ? 0 : 1;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    differs |= static_cast<unsigned char>(wanted[i] ^ (i < given.size() ? given[i] : 0));
  return differs == 0;
}

}  // namespace impinge
