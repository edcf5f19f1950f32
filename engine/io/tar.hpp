// Several files in one, as POSIX ustar: any tar lists and unpacks it, and nothing in it is packed, so that what it comes
// to is never more than what it is. Only files: no links, no owners, no times, so the same files give the same bytes.
// What is read must be what would be written, byte for byte: a byte that is wrong anywhere outside the files' own is
// found here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace impinge {

struct TarPart {
  std::string name;  ///< with slashes
  std::string_view bytes;
};

inline constexpr std::size_t kMostTarParts = 10'000;

/// Whether it may be the name of a part: below where it is unpacked, whatever it says. Plain words between slashes.
bool is_tar_name(std::string_view name);

/// Throws InputError where a name is too long (a folder of 155 and a file of 100 characters fit).
std::string format_tar(const std::vector<TarPart>& parts);

/// The parts of `bytes`, which must outlive them. Throws InputError `file: byte N: found; allowed; remedy` for what
/// format_tar doesn't write: other kinds of parts, names that lead elsewhere, two of one name, an end that is missing.
std::vector<TarPart> parse_tar(const std::string& file, std::string_view bytes);

/// The bytes of the first part, if `bytes` begin as format_tar writes a part of this name, whatever follows; else none.
std::string_view first_tar_part(std::string_view bytes, std::string_view name);

}  // namespace impinge
