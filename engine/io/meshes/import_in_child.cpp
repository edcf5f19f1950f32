#include "engine/io/meshes/import_in_child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "engine/core/archive.hpp"
#include "engine/io/child_process.hpp"
#include "engine/io/companion_error.hpp"

namespace impinge {

bool CompanionFiles::exists(const std::string& file) const {
  std::error_code error;
  return !guard_.refused(file) && std::filesystem::is_regular_file(file, error);
}

bool CompanionFiles::may_open(const std::string& file) {
  std::string problem;
  if (const auto target = guard_.refused(file))
    problem = fmt::format("names '{}', which leads out of the scene's folder ({})", file, target->string());
  else if (std::ssize(opened_) > kMostIncludes)  // the file itself is one
    problem = fmt::format("names more than {} files", kMostIncludes);
  if (refusal_.empty()) refusal_ = problem;
  return problem.empty();
}

void CompanionFiles::note(const std::string& file, bool opened) {
  if (opened)
    opened_.push_back(file);
  else
    note_missing(file);
}

void CompanionFiles::note_missing(const std::string& file) {
  if (missing_.empty()) missing_ = file;
}

void CompanionFiles::throw_refusal() const {
  if (!refusal_.empty()) throw RefusedCompanion(refusal_);
}

void CompanionFiles::throw_missing() const {
  if (!missing_.empty()) throw MissingCompanion(missing_);
}

namespace {

using Importer = std::function<Imported(const std::string&, CompanionFiles&)>;

// what the child sends: 'M' and the mesh, 'E' and why not, 'N' and a file that it needs and that can't be opened, or 'R'
// and what it asked for that it must not have
std::string sent(const std::string& path, const FileGuard& guard, const Importer& import) {
  CompanionFiles files(guard);
  try {
    const Imported read = import(path, files);
    ByteWriter out;
    out.put('M');
    out.put<double>(read.unit.value_or(0.0));
    out.put<std::uint64_t>(read.mesh.vertices.size());
    out.put<std::uint64_t>(read.mesh.triangles.size());
    for (const Vec3& x : read.mesh.vertices) out.put(x);
    for (const Triangle& t : read.mesh.triangles)
      for (const int v : t) out.put(v);
    for (const std::string& file : read.opened) {
      out.put<std::uint64_t>(file.size());
      out.put_bytes(file.data(), file.size());
    }
    return out.bytes();
  } catch (const RefusedCompanion& refusal) {
    return std::string("R") + refusal.what();
  } catch (const MissingCompanion& missing) {
    return std::string("N") + missing.what();
  } catch (const std::exception& error) {
    return std::string("E") + error.what();
  }
}

void limit_resources() {
  const rlimit no_core{0, 0}, seconds{120, 120};
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &seconds);
#ifndef __SANITIZE_ADDRESS__
  const rlimit memory{rlim_t{8} << 30, rlim_t{8} << 30};
  setrlimit(RLIMIT_AS, &memory);
#endif
}

[[noreturn]] void child(const std::string& path, const FileGuard& guard, const Importer& import, int out) {
  limit_resources();
  sigset_t none;  // what the parent blocks, to take care of it by itself, ends this one
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  // not by the streams: they would first write what the parent has put into them and will write itself
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere < 0 || dup2(nowhere, STDOUT_FILENO) < 0 || dup2(nowhere, STDERR_FILENO) < 0) _exit(1);
  const std::string bytes = sent(path, guard, import);
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ssize_t n = write(out, rest.data(), rest.size());
    if (n <= 0) _exit(1);
    rest.remove_prefix(static_cast<std::size_t>(n));
  }
  _exit(0);
}

std::string bytes_of_child(const std::string& name, const FileGuard& guard, const Importer& import) {
  int ends[2];
  if (pipe(ends) != 0)
    throw InputError(name + ": no pipe to the importer; the system is out of file handles; close some programs");
  const pid_t pid = fork();
  if (pid < 0)
    throw InputError(name + ": no process for the importer; the system is out of processes; close some programs");
  if (pid == 0) {
    close(ends[0]);
    child(name, guard, import, ends[1]);
  }
  close(ends[1]);
  ChildProcess importer(pid);
  const std::string bytes = ChildProcess::read_all(ends[0]);
  const int status = importer.wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || bytes.empty())
    throw InputError(name + ": the importer failed on it; a sound file is wanted; convert it to PLY");
  return bytes;
}

}  // namespace

TriangleMesh import_in_child(const std::filesystem::path& path, const FileGuard& guard, const Importer& import,
                             MeshOrigin& origin) {
  const std::string name = path.string(), bytes = bytes_of_child(name, guard, import);
  if (bytes[0] == 'R')
    throw CompanionError(
        name, fmt::format("{}; files inside it are read, {} at most; copy them there, or convert the mesh to PLY",
                          bytes.substr(1), kMostIncludes));
  if (bytes[0] == 'N')
    throw CompanionError(
        name, fmt::format("names '{}', which can't be opened; a mesh with all files that it names is wanted; "
                          "put it there, or convert the mesh to PLY",
                          bytes.substr(1)));
  if (bytes[0] == 'E')
    throw InputError(
        fmt::format("{}: can't be read ({}); a sound file is wanted; convert it to PLY", name, bytes.substr(1)));

  ByteReader in(bytes);
  in.get<char>();
  if (const auto metres = in.get<double>(); metres > 0.0) origin.unit = fmt::format("{:.6g} m, as it says", metres);
  TriangleMesh mesh;
  const auto vertices = in.get<std::uint64_t>(), triangles = in.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < vertices; ++i) mesh.vertices.push_back(in.get_vec3());
  for (std::uint64_t i = 0; i < triangles; ++i) {
    const int a = in.get<int>(), b = in.get<int>(), c = in.get<int>();
    mesh.triangles.push_back({a, b, c});
  }
  while (!in.at_end()) {
    std::string file(in.get<std::uint64_t>(), '\0');
    for (char& c : file) c = in.get<char>();
    if (file != name && std::find(origin.others.begin(), origin.others.end(), file) == origin.others.end())
      origin.others.emplace_back(file);
  }
  return mesh;
}

}  // namespace impinge
