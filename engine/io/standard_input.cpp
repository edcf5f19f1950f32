#include "engine/io/standard_input.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"

namespace impinge {
namespace {

constexpr int kBetweenLooks = 50;  // milliseconds, at whether somebody wants an end

std::string read_all(std::uint64_t limit) {
  std::string all;
  std::array<char, 65536> piece;
  const auto give_up = [] {
    throw InputError(fmt::format("-: standard input can't be read ({}); a script is wanted; name a file",
                                 std::generic_category().message(errno)));
  };
  for (;;) {
    check_interrupt();
    pollfd input{STDIN_FILENO, POLLIN, 0};
    const int ready = poll(&input, 1, kBetweenLooks);
    if (ready < 0 && errno != EINTR) give_up();
    if (ready <= 0) continue;
    const ssize_t count = read(STDIN_FILENO, piece.data(), piece.size());
    if (count < 0 && errno != EINTR && errno != EAGAIN) give_up();
    if (count == 0) return all;
    if (count > 0) all.append(piece.data(), static_cast<std::size_t>(count));
    if (all.size() > limit)
      throw InputError(fmt::format("-: more than {} bytes; a script is wanted; shorten it", limit));
  }
}

}  // namespace

const std::string& standard_input(std::uint64_t limit) {
  static const std::string text = read_all(limit);
  return text;
}

}  // namespace impinge
