#include "engine/io/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "engine/io/paths.hpp"

namespace impinge {

namespace fs = std::filesystem;

namespace {

/// An open file, closed at the end.
class OpenFile {
 public:
  // without waiting: a pipe that takes the file's place, or a file of the kernel's without news, must not hold us up
  explicit OpenFile(const std::string& name)
      : number_(open(name.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {}
  ~OpenFile() {
    if (number_ >= 0) close(number_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  bool is_open() const { return number_ >= 0; }
  bool stat(struct stat& facts) const { return fstat(number_, &facts) == 0; }
  /// Reads up to `count` bytes; fewer only at the file's end. −1 where it can't be read.
  std::ptrdiff_t read(char* to, std::size_t count) const {
    std::size_t got = 0;
    while (got < count) {
      const ssize_t n = ::read(number_, to + got, count - got);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return -1;
      if (n == 0) break;
      got += static_cast<std::size_t>(n);
    }
    return static_cast<std::ptrdiff_t>(got);
  }

 private:
  int number_;
};

}  // namespace

std::string read_file(const fs::path& path, std::uint64_t limit) {
  const std::string name = path.string();
  const auto cant = [&](const char* what) -> InputError {
    return InputError(fmt::format("{}: can't be {} ({}); check its permissions", name, what, std::strerror(errno)));
  };
  const PathKind kind = path_kind(path);
  if (kind == PathKind::nothing)
    throw InputError(name + ": there is no such file; a readable file is wanted; check the path");
  if (kind != PathKind::file)
    throw InputError(name + ": is not a regular file; a readable file is wanted; name a file");
  const OpenFile file(name);
  if (!file.is_open()) throw cant("opened");
  struct stat facts;
  if (!file.stat(facts)) throw cant("read");
  const auto size = static_cast<std::uint64_t>(facts.st_size);
  if (size > limit)
    throw InputError(fmt::format("{}: has {} bytes; at most {} are taken; make it smaller", name, size, limit));
  std::string bytes(size, '\0');
  const std::ptrdiff_t got = file.read(bytes.data(), size);
  if (got < 0) throw cant("read");
  if (static_cast<std::uint64_t>(got) != size)
    throw InputError(name + ": can't be read to its end; check the disk and run again");
  // what the kernel makes up while it is read (/proc, /sys) says that it has no bytes: it must not pass for an empty file
  char more = 0;
  if (size == 0 && file.read(&more, 1) != 0)
    throw InputError(name +
                     ": says that it is empty and is not (a file of the system's?); a file on disk is wanted; "
                     "copy it first");
  return bytes;
}

fs::path temporary_name(const fs::path& path, bool keeps_ending) {
  static std::atomic<unsigned> count{0};
  const std::string ending = keeps_ending ? path.extension().string() : "";
  const std::string stem = keeps_ending ? path.stem().string() : path.filename().string();
  for (;;) {
    fs::path name = path.parent_path() / fmt::format("{}.{}-{}.tmp{}", stem, getpid(), count++, ending);
    std::error_code error;
    // else it is of a process killed long ago
    if (fs::symlink_status(name, error).type() != fs::file_type::regular) return name;
  }
}

bool is_temporary_name(std::string_view name) {
  const auto drop_digits = [&] {
    const std::size_t last = name.find_last_not_of("0123456789");
    const bool any = last + 1 < name.size();
    name = name.substr(0, last + 1);
    return any;
  };
  const auto drop = [&](std::string_view end) {
    const bool there = name.ends_with(end);
    if (there) name.remove_suffix(end.size());
    return there;
  };
  if (!name.ends_with(".tmp")) name = name.substr(0, name.rfind('.'));
  return drop(".tmp") && drop_digits() && drop("-") && drop_digits() && drop(".") && !name.empty();
}

void write_file(const fs::path& path, std::string_view bytes) {
  std::string temporary;
  const auto refuse = [&](int code) {
    std::remove(temporary.c_str());
    const char* reason = std::strerror(code);
    throw OutputError(
        fmt::format("{}: can't be written ({}); free space or choose another --out", path.string(), reason), reason);
  };
  std::FILE* file = nullptr;
  do {  // x: another machine may share the folder and know a process of the same number
    temporary = temporary_name(path).string();
    file = std::fopen(temporary.c_str(), "wbx");
  } while (file == nullptr && errno == EEXIST);
  if (file == nullptr) refuse(errno);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int write_error = errno;
  // a full disk may show only when the last buffer goes out
  if (std::fclose(file) != 0 || !written) refuse(written ? errno : write_error);
  if (std::rename(temporary.c_str(), path.c_str()) != 0) refuse(errno);
}

}  // namespace impinge
