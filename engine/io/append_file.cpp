#include "engine/io/append_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "engine/io/file.hpp"

namespace impinge {

namespace {

[[noreturn]] void refuse(const std::string& name, int code) {
  throw OutputError(
      fmt::format("{}: can't be written ({}); free space or choose another --out", name, std::strerror(code)));
}

}  // namespace

AppendFile::AppendFile(const std::filesystem::path& path, std::uint64_t keep) : name_(path.string()) {
  handle_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (handle_ < 0) refuse(name_, errno);
  if (ftruncate(handle_, static_cast<off_t>(keep)) != 0) {
    const int code = errno;
    close(handle_);
    refuse(name_, code);
  }
}

AppendFile::~AppendFile() {
  if (handle_ >= 0) close(handle_);
}

AppendFile::AppendFile(AppendFile&& other) noexcept
    : name_(std::move(other.name_)), handle_(std::exchange(other.handle_, -1)) {}

AppendFile& AppendFile::operator=(AppendFile&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(handle_, other.handle_);
  return *this;
}

void AppendFile::append(std::string_view text) {
  const off_t before = lseek(handle_, 0, SEEK_END);
  while (!text.empty()) {
    const ssize_t n = write(handle_, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int code = errno;
      if (ftruncate(handle_, before) != 0) refuse(name_, errno);
      refuse(name_, code);
    }
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

}  // namespace impinge
