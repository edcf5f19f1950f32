#include "viewer/compare/suite_worker.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstring>

#include "engine/core/archive.hpp"
#include "engine/core/memory.hpp"

namespace impinge {

namespace {

void put_text(ByteWriter& out, const std::string& text) {
  out.put<std::uint64_t>(text.size());
  out.put_bytes(text.data(), text.size());
}

std::string get_text(ByteReader& in) {
  std::string text(std::min<std::uint64_t>(in.get<std::uint64_t>(), in.left()), '\0');
  for (char& c : text) c = in.get<char>();
  return text;
}

SuiteResult read_result(const std::string& bytes) {
  ByteReader in(bytes);
  SuiteResult result;
  result.gave_up = get_text(in);
  TestOutcome& outcome = result.outcome;
  outcome.name = get_text(in);
  const int kind = in.get<int>();
  if (kind < TestOutcome::ok || kind > TestOutcome::error) throw InputError("no kind of outcome");
  outcome.kind = static_cast<TestOutcome::Kind>(kind);
  outcome.expectations = in.get<int>();
  outcome.pictures = in.get<int>();
  outcome.seconds = in.get<double>();
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) outcome.messages.push_back(get_text(in));
  return result;
}

std::string all_of(int file) {
  std::string text;
  char part[65536];
  for (ssize_t n = 0; (n = pread(file, part, sizeof part, static_cast<off_t>(text.size()))) > 0;)
    text.append(part, static_cast<std::size_t>(n));
  return text;
}

/// Of a process that didn't get as far as to say it itself.
SuiteResult without_result(const std::string& name, int status, const std::string& err) {
  SuiteResult result;
  result.outcome.name = name;
  result.outcome.kind = TestOutcome::error;
  std::vector<std::string>& messages = result.outcome.messages;
  messages.push_back(WIFSIGNALED(status)
                         ? fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))
                         : fmt::format("ended with exit code {}", WEXITSTATUS(status)));
  for (std::size_t begin = 0; begin < err.size();) {
    const std::size_t end = std::min(err.find('\n', begin), err.size());
    messages.push_back(err.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

}  // namespace

void print_result(const SuiteResult& result) {
  ByteWriter out;
  put_text(out, result.gave_up);
  const TestOutcome& outcome = result.outcome;
  put_text(out, outcome.name);
  out.put<int>(outcome.kind);
  out.put(outcome.expectations);
  out.put(outcome.pictures);
  out.put(outcome.seconds);
  out.put<std::uint64_t>(outcome.messages.size());
  for (const std::string& message : outcome.messages) put_text(out, message);
  std::fwrite(out.bytes().data(), 1, out.bytes().size(), stdout);
}

void belong_to_suite() {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
}

SuiteWorker::SuiteWorker(const SuiteOptions& options, const std::string& name, int threads)
    : name_(name), out_(memfd_create("outcome", MFD_CLOEXEC)), err_(memfd_create("messages", MFD_CLOEXEC)) {
  std::vector<std::string> words = {"/proc/self/exe",
                                    "test",
                                    options.folder.string(),
                                    "--worker=" + name,
                                    "--out",
                                    options.out.string(),
                                    "--size",
                                    fmt::format("{}x{}", options.width, options.height),
                                    "--threads",
                                    std::to_string(threads)};
  if (options.update) words.emplace_back("--update");
  if (given_memory_limit() > 0) words.insert(words.end(), {"--memory-limit", std::to_string(given_memory_limit())});
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_adddup2(&streams, out_, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&streams, err_, STDERR_FILENO);
  pid_t pid = -1;
  const int code = out_ < 0 || err_ < 0 ? errno : spawn(words, streams, pid);
  posix_spawn_file_actions_destroy(&streams);
  if (code != 0)
    throw InputError(fmt::format("command line: no process can be started ({}); fewer are wanted; lower --jobs",
                                 std::strerror(code)));
  child_.emplace(pid);
}

SuiteWorker::SuiteWorker(SuiteWorker&& other) noexcept
    : name_(std::move(other.name_)),
      out_(std::exchange(other.out_, -1)),
      err_(std::exchange(other.err_, -1)),
      child_(std::move(other.child_)) {}

SuiteWorker::~SuiteWorker() {
  for (const int file : {out_, err_})
    if (file >= 0) close(file);
}

std::optional<SuiteResult> SuiteWorker::poll() {
  const std::optional<int> status = child_->poll();
  if (!status) return std::nullopt;
  if (WIFEXITED(*status) && WEXITSTATUS(*status) == 0) {
    try {
      return read_result(all_of(out_));
    } catch (const InputError&) {  // something else was printed
    }
  }
  return without_result(name_, *status, all_of(err_));
}

void SuiteWorker::interrupt() const { kill(child_->pid(), SIGTERM); }

}  // namespace impinge
