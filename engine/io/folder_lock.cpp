#include "engine/io/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "engine/core/interrupt.hpp"
#include "engine/io/file.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBegin = "process ";  // of what a lock file says
// whoever only looks (check_free) has the lock for a moment, and whoever has just taken it has not yet said who it is
constexpr int kTries = 20;
constexpr auto kPause = std::chrono::milliseconds(5);

std::string who_am_i() {
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{}{} on {} since {:%Y-%m-%d %H:%M:%S} UTC\n", kBegin, getpid(), host.data(), fmt::gmtime(now));
}

std::string text_of(int handle) {
  std::array<char, 512> text{};
  const ssize_t got = pread(handle, text.data(), text.size(), 0);
  return got > 0 ? std::string(text.data(), static_cast<std::size_t>(got)) : "";
}

/// Whether the name still stands for the file that was opened: whoever gives a lock back removes the file.
bool is_same(int handle, const fs::path& file) {
  struct stat opened {
  }, named{};
  return fstat(handle, &opened) == 0 && stat(file.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

bool lock(int handle) {
  while (flock(handle, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    // a file system that knows no locks must not keep anybody from working on it
    return errno != EWOULDBLOCK;
  }
  return true;
}

[[noreturn]] void refuse(const fs::path& folder, int handle) {
  std::string who;
  for (int i = 0; i < kTries && who.find('\n') == std::string::npos; ++i) {
    if (i > 0) std::this_thread::sleep_for(kPause);
    who = text_of(handle);
  }
  close(handle);
  who = who.substr(0, who.find('\n'));
  throw InputError(
      fmt::format("{}: is being written to by {}; one process at a time can; wait until it has ended, or choose "
                  "another --out",
                  folder.string(), who.starts_with(kBegin) ? who : "another process"));
}

}  // namespace

std::optional<FolderLock> FolderLock::try_take(const fs::path& folder) {
  const fs::path file = folder / kName;
  for (;;) {
    const int handle = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (handle < 0)
      throw OutputError(
          fmt::format("{}: can't be written ({}); a folder that may be written to is wanted; choose another --out",
                      file.string(), std::strerror(errno)));
    FolderLock taken(file, handle);
    if (!lock(handle)) {
      taken.handle_ = -1;
      close(handle);
      return std::nullopt;
    }
    if (!is_same(handle, file)) {  // given back, and removed, between the two
      taken.handle_ = -1;
      close(handle);
      continue;
    }
    if (const std::string before = text_of(handle); !before.empty() && !before.starts_with(kBegin)) {
      taken.handle_ = -1;
      close(handle);
      throw InputError(
          fmt::format("{}: is no lock of impinge; a folder without a file of that name is wanted; choose another --out",
                      file.string()));
    }
    const std::string text = who_am_i();
    if (ftruncate(handle, 0) != 0 || pwrite(handle, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()))
      throw OutputError(fmt::format("{}: can't be written ({}); free space or choose another --out", file.string(),
                                    std::strerror(errno)));
    return taken;
  }
}

FolderLock FolderLock::take(const fs::path& folder) {
  for (int i = 0; i < kTries; ++i) {
    if (i > 0) std::this_thread::sleep_for(kPause);
    if (std::optional<FolderLock> taken = try_take(folder)) return std::move(*taken);
  }
  for (;;) {
    check_free(folder);
    if (std::optional<FolderLock> taken = try_take(folder)) return std::move(*taken);
  }
}

FolderLock FolderLock::wait_for(const fs::path& folder) {
  for (;;) {
    if (std::optional<FolderLock> taken = try_take(folder)) return std::move(*taken);
    check_interrupt();
    std::this_thread::sleep_for(kPause);
  }
}

void FolderLock::check_free(const fs::path& folder) {
  const int handle = open((folder / kName).c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) return;  // taking it will say what is wrong with it, if anything is
  if (!lock(handle)) refuse(folder, handle);
  close(handle);
}

FolderLock::~FolderLock() { give_back(); }

FolderLock::FolderLock(FolderLock&& other) noexcept
    : file_(std::move(other.file_)), handle_(std::exchange(other.handle_, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(handle_, other.handle_);
  return *this;
}

void FolderLock::give_back() {
  if (handle_ < 0) return;
  // the name first: whoever opened the file and gets its lock sees that it is no longer there, and opens a new one
  if (is_same(handle_, file_)) unlink(file_.c_str());
  close(handle_);
}

}  // namespace impinge
