// One process at a time writes into a folder. The lock is the system's, on the file `lock` in it (flock): it ends with
// the process that holds it, however that ended, and with the machine; on a network it holds for all machines wherever
// the file system knows locks. The file says who holds it and goes when the lock is given back; one that a killed
// process left behind locks nothing.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace impinge {

class FolderLock {
 public:
  /// Holds nothing.
  FolderLock() = default;
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;

  /// Of a folder that is there. Throws InputError, which says who has it, where another process does; OutputError where
  /// the file can't be written.
  static FolderLock take(const std::filesystem::path& folder);
  /// Nothing where another process has it. Throws OutputError.
  static std::optional<FolderLock> try_take(const std::filesystem::path& folder);
  /// Waits until whoever has it gives it back. Throws OutputError and Interrupted.
  static FolderLock wait_for(const std::filesystem::path& folder);
  /// Throws as take() would where another process has it now; makes and takes nothing. A folder that isn't there is
  /// free.
  static void check_free(const std::filesystem::path& folder);

  /// The file's handle, for a child process that is to hold the lock too; -1 for none.
  int handle() const { return handle_; }
  /// The name of the file in the folder.
  static constexpr const char* kName = "lock";

 private:
  FolderLock(std::filesystem::path file, int handle) : file_(std::move(file)), handle_(handle) {}
  void give_back();

  std::filesystem::path file_;
  int handle_ = -1;
};

}  // namespace impinge
