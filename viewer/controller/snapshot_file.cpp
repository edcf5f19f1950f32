#include "viewer/controller/snapshot_file.hpp"

#include <fmt/format.h>

#include "engine/core/archive.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"

namespace impinge {

namespace {

constexpr std::string_view kName = "impinge snapshot ", kHead = "impinge snapshot 5\n";
constexpr std::string_view kBeforeNotes = "impinge snapshot 4\n";  // the same without notes: still read
constexpr std::uint64_t kMostOfSnapshot = std::uint64_t{8} << 30;

bool is_before_notes(std::string_view bytes) { return bytes.starts_with(kBeforeNotes); }

// the state and the notes between head and checksum; empty if the file is damaged
std::string_view body_of(std::string_view bytes) {
  static_assert(kBeforeNotes.size() == kHead.size());
  if (bytes.size() < kHead.size() + 8 || !(bytes.starts_with(kHead) || is_before_notes(bytes))) return {};
  const std::string_view body = bytes.substr(kHead.size(), bytes.size() - kHead.size() - 8);
  ByteReader checksum(bytes.substr(bytes.size() - 8));
  return checksum.get<std::uint64_t>() == hash_bytes(body) ? body : std::string_view();
}

}  // namespace

std::string format_snapshot(const Session& session, std::string_view notes) {
  ByteWriter state, checksum;
  session.save(state);
  state.put(static_cast<std::uint64_t>(notes.size()));
  state.put_bytes(notes.data(), notes.size());
  checksum.put(hash_bytes(state.bytes()));
  return std::string(kHead) + state.bytes() + checksum.bytes();
}

std::size_t write_snapshot(const std::filesystem::path& path, const Session& session, std::string_view notes) {
  const std::string bytes = format_snapshot(session, notes);
  write_file(path, bytes);
  return bytes.size();
}

bool is_valid_snapshot(const std::filesystem::path& path) {
  std::error_code error;
  if (!is_file(path)) return false;
  return !body_of(read_file(path, kMostOfSnapshot)).empty();
}

void refuse_other_version(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return;
  const std::string bytes = read_file(path, kMostOfSnapshot);
  const std::string_view head = std::string_view(bytes).substr(0, bytes.find('\n') + 1);
  if (head.starts_with(kName) && head != kHead && head != kBeforeNotes)
    throw InputError(
        fmt::format("{}: is a snapshot of version {}; one of version {} is wanted; run the scene again "
                    "without --resume, or resume it with the program that wrote it",
                    path.string(), head.substr(kName.size(), head.size() - kName.size() - 1),
                    kHead.substr(kName.size(), kHead.size() - kName.size() - 1)));
}

std::string restore_snapshot(const std::filesystem::path& path, Session& session) {
  const std::string bytes = read_file(path, kMostOfSnapshot);
  const std::string_view body = body_of(bytes);
  if (body.empty())
    throw InputError(path.string() + ": is damaged; a whole snapshot is wanted; remove it and run again with --resume");
  ByteReader in(body);
  session.restore(in);
  const bool has_notes = !is_before_notes(bytes) && in.left() >= sizeof(std::uint64_t);
  const std::uint64_t size = has_notes ? in.get<std::uint64_t>() : 0;
  if (in.left() != size || has_notes == is_before_notes(bytes))
    throw InputError(path.string() + ": belongs to another scene; remove it and run again with --resume");
  return std::string(body.substr(body.size() - size));
}

}  // namespace impinge
