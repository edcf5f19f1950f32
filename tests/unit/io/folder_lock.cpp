// One process at a time writes into a folder, and what a process leaves that was killed stops nobody.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "engine/core/interrupt.hpp"
#include "engine/io/file.hpp"
#include "engine/io/folder_lock.hpp"
#include "engine/io/paths.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A process of its own that does this and ends.
pid_t beside(const std::function<void()>& work) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  try {
    work();
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

int status_of(pid_t pid) {
  int status = 0;
  waitpid(pid, &status, 0);
  return status;
}

}  // namespace

TEST_CASE("a folder's lock is held once, says by whom, and leaves nothing") {
  const TempFolder folder;
  {
    const FolderLock lock = FolderLock::take(folder.path());
    CHECK_FALSE(FolderLock::try_take(folder.path()).has_value());
    const std::string who = "process " + std::to_string(getpid()) + " on ";
    CHECK_THROWS_WITH(FolderLock::take(folder.path()), Catch::Contains(folder.path().string()) &&
                                                           Catch::Contains(who) && Catch::Contains(" since ") &&
                                                           Catch::Contains("; "));
    CHECK_THROWS_AS(FolderLock::check_free(folder.path()), InputError);
    const std::string text = slurp(folder / "lock");
    CHECK(text.starts_with(who));
    CHECK(text.ends_with(" UTC\n"));
  }
  CHECK(names_in(folder.path()).empty());
  CHECK_NOTHROW(FolderLock::check_free(folder.path()));
  CHECK_NOTHROW(FolderLock::check_free(folder / "not there"));
  CHECK(names_in(folder.path()).empty());
  FolderLock first = FolderLock::take(folder.path());
  FolderLock moved = std::move(first);
  first = FolderLock();
  CHECK_FALSE(FolderLock::try_take(folder.path()).has_value());
  moved = FolderLock();
  CHECK(FolderLock::try_take(folder.path()).has_value());
}

TEST_CASE("the lock of a killed process is none") {
  const TempFolder folder;
  for (int k = 0; k < 20; ++k) {
    const pid_t pid = beside([&] {
      const FolderLock lock = FolderLock::take(folder.path());
      for (;;) pause();
    });
    while (!slurp(folder / "lock").starts_with("process " + std::to_string(pid))) std::this_thread::yield();
    CHECK_THROWS_WITH(FolderLock::check_free(folder.path()),
                      Catch::Contains("process " + std::to_string(pid) + " on "));
    kill(pid, SIGKILL);
    status_of(pid);
    CHECK(is_file(folder / "lock"));  // it could not remove it
    CHECK_NOTHROW(FolderLock::check_free(folder.path()));
    CHECK_NOTHROW(FolderLock::take(folder.path()));
    CHECK_FALSE(is_file(folder / "lock"));
  }
  // of another machine, or from before this one was started
  folder.write("lock", "process 1 on elsewhere since 2001-01-01 00:00:00 UTC\n");
  CHECK_NOTHROW(FolderLock::take(folder.path()));
}

TEST_CASE("a child that has the handle holds the lock too") {
  const TempFolder folder;
  FolderLock lock = FolderLock::take(folder.path());
  const pid_t pid = fork();
  if (pid == 0) {  // another program, as exec makes one: it has the handle and nothing of the object
    for (;;) pause();
  }
  const int handle = dup(lock.handle());
  CHECK_FALSE(FolderLock::try_take(folder.path()).has_value());
  close(handle);
  kill(pid, SIGKILL);
  status_of(pid);
  lock = FolderLock();
  CHECK(FolderLock::try_take(folder.path()).has_value());
}

TEST_CASE("a file of that name that is none of ours is not touched") {
  const TempFolder folder;
  folder.write("lock", "a note of mine\n");
  CHECK_THROWS_AS(FolderLock::take(folder.path()), InputError);
  CHECK(slurp(folder / "lock") == "a note of mine\n");
}

TEST_CASE("of many processes one at a time is inside") {
  const TempFolder folder;
  const std::filesystem::path inside = folder / "inside", count = folder.write("count", "");
  constexpr int kProcesses = 6, kRounds = 40;
  std::vector<pid_t> all;
  for (int p = 0; p < kProcesses; ++p)
    all.push_back(beside([&] {
      for (int k = 0; k < kRounds; ++k) {
        const FolderLock lock = FolderLock::wait_for(folder.path());
        const int file = open(inside.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0600);
        if (file < 0) _exit(1);  // somebody else is there
        close(file);
        const int add = open(count.c_str(), O_WRONLY | O_APPEND);
        if (write(add, "x", 1) != 1) _exit(2);
        close(add);
        if (unlink(inside.c_str()) != 0) _exit(3);
      }
    }));
  for (const pid_t pid : all) CHECK(status_of(pid) == 0);
  CHECK(slurp(count).size() == kProcesses * kRounds);
  CHECK(names_in(folder.path()) == std::vector<std::string>{"count"});
}

TEST_CASE("who waits for a lock can be interrupted") {
  const TempFolder folder;
  const FolderLock lock = FolderLock::take(folder.path());
  std::atomic<bool> flag{false};
  std::thread raiser([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    flag = true;
  });
  const InterruptScope scope(&flag);
  CHECK_THROWS_AS(FolderLock::wait_for(folder.path()), Interrupted);
  raiser.join();
}
