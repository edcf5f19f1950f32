#include "engine/io/file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace impinge {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path, std::uint64_t limit) {
  const std::string name = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    throw InputError(name + ": there is no such file; a readable file is wanted; check the path");
  if (!fs::is_regular_file(status))
    throw InputError(name + ": is not a regular file; a readable file is wanted; name a file");
  const std::uint64_t size = fs::file_size(path, error);
  if (error) throw InputError(fmt::format("{}: can't be read ({}); check its permissions", name, error.message()));
  if (size > limit)
    throw InputError(fmt::format("{}: has {} bytes; at most {} are taken; make it smaller", name, size, limit));
  std::FILE* file = std::fopen(name.c_str(), "rb");
  if (file == nullptr)
    throw InputError(fmt::format("{}: can't be opened ({}); check its permissions", name, std::strerror(errno)));
  std::string bytes(size, '\0');
  const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), file);
  std::fclose(file);
  if (got != size) throw InputError(name + ": can't be read to its end; check the disk and run again");
  return bytes;
}

void write_file(const fs::path& path, std::string_view bytes) {
  const std::string temporary = path.string() + ".tmp";
  const auto refuse = [&](int code) {
    std::remove(temporary.c_str());
    throw OutputError(fmt::format("{}: can't be written ({}); free space or choose another --out", path.string(),
                                  std::strerror(code)));
  };
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) refuse(errno);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int write_error = errno;
  // a full disk may show only when the last buffer goes out
  if (std::fclose(file) != 0 || !written) refuse(written ? errno : write_error);
  if (std::rename(temporary.c_str(), path.c_str()) != 0) refuse(errno);
}

}  // namespace impinge
