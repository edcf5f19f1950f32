#include "engine/io/tets/tetrahedralize.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/io/child_process.hpp"
#include "engine/io/file.hpp"
#include "engine/io/tets/tet_file.hpp"

namespace impinge {

namespace fs = std::filesystem;

namespace {

constexpr const char* kProgram = "impinge-tetrahedralize";

/// A folder of our own that is gone afterwards, whatever happens.
class Workshop {
 public:
  Workshop() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "impinge_tetrahedralize_XXXXXX").string();
    if (error || mkdtemp(name.data()) == nullptr)
      throw InputError(fmt::format("no temporary folder for the surface ({}); a writable one is wanted; set TMPDIR",
                                   std::strerror(errno)));
    path_ = name;
  }
  ~Workshop() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  std::string operator/(const char* name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

bool is_program(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

std::string off_text(const TriangleMesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  auto out = std::back_inserter(text);
  for (const Vec3& v : mesh.vertices) fmt::format_to(out, "{} {} {}\n", v.x(), v.y(), v.z());
  for (const Triangle& t : mesh.triangles) fmt::format_to(out, "3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

/// Runs the program with its output in `log`; its wait status.
int run(const std::vector<std::string>& words, const std::string& log) {
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_addopen(&streams, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&streams, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&streams, STDOUT_FILENO, STDERR_FILENO);
  pid_t pid = 0;
  const int code = spawn(words, streams, pid);
  posix_spawn_file_actions_destroy(&streams);
  if (code != 0)
    throw InputError(fmt::format("{} can't be started ({}); a program is wanted there; build or install it again",
                                 words[0], std::strerror(code)));
  return ChildProcess(pid).wait();
}

/// The last line with something in it.
std::string last_line(const std::string& text) {
  std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return "";
  const std::size_t start = text.find_last_of('\n', end);
  return text.substr(start == std::string::npos ? 0 : start + 1,
                     end - (start == std::string::npos ? 0 : start + 1) + 1);
}

}  // namespace

fs::path find_tetrahedralizer() {
  if (const char* named = std::getenv("IMPINGE_TETRAHEDRALIZE"); named != nullptr && *named != '\0')
    return is_program(named) ? fs::path(named) : fs::path();
  std::error_code error;
  const fs::path own = fs::read_symlink("/proc/self/exe", error);
  if (!error && is_program(own.parent_path() / kProgram)) return own.parent_path() / kProgram;
  const char* path = std::getenv("PATH");
  for (std::string rest = path == nullptr ? "" : path; !rest.empty();) {
    const std::size_t colon = rest.find(':');
    const fs::path folder = rest.substr(0, colon);
    // an empty or relative entry would run what lies in the present folder
    if (folder.is_absolute() && is_program(folder / kProgram)) return folder / kProgram;
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return {};
}

TetMesh tetrahedralize(const TriangleMesh& surface, const TetrahedralizeSettings& settings) {
  const fs::path program = find_tetrahedralizer();
  if (program.empty())
    throw InputError(
        fmt::format("the program {} is not there; what IMPINGE_TETRAHEDRALIZE names, the folder of impinge and PATH "
                    "are looked in; build it (apt install libcgal-dev; cmake --build build "
                    "--target {}), or use a cage",
                    kProgram, kProgram));
  const Workshop folder;
  write_file(folder / "surface.off", off_text(surface));
  const int status = run({program.string(), folder / "surface.off", folder / "volume.msh", "--max-size",
                          shortest(settings.max_size), "--min-angle", shortest(settings.min_angle)},
                         folder / "log");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    const std::string said = last_line(read_file(folder / "log", std::uint64_t{1} << 24));
    const std::string how = WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                                                : fmt::format("failed{}{}", said.empty() ? "" : ": ", said);
    throw InputError(fmt::format("{} {}; a volume mesh is wanted; try another max_size, or use a cage", kProgram, how));
  }
  return read_tet_file(folder / "volume.msh").mesh;
}

}  // namespace impinge
