#include "viewer/export/new_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "engine/io/file.hpp"

namespace impinge {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;  // bytes

}  // namespace

NewFile::NewFile(const fs::path& path) : path_(path), temporary_(temporary_name(path)), file_(temporary_, 0) {}

NewFile::~NewFile() {
  std::error_code error;
  if (!kept_) fs::remove(temporary_, error);
}

void NewFile::append(std::string_view text) {
  waiting_ += text;
  if (waiting_.size() >= kPiece) flush();
}

void NewFile::flush() {
  file_.append(waiting_);
  waiting_.clear();
}

void NewFile::read_back(const std::function<void(std::string_view)>& piece) {
  flush();
  std::ifstream in(temporary_, std::ios::binary);
  std::string bytes(kPiece, '\0');
  while (in) {
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    piece(std::string_view(bytes).substr(0, static_cast<std::size_t>(in.gcount())));
  }
  if (!in.eof()) throw OutputError(temporary_.string() + ": can't be read back; check the disk and run again");
}

void NewFile::keep() {
  flush();
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const char* reason = std::strerror(errno);
    throw OutputError(
        fmt::format("{}: can't be written ({}); free space or choose another --out", path_.string(), reason), reason);
  }
  kept_ = true;
}

}  // namespace impinge
