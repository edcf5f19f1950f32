// Names that the command line promises for later versions: known, so that they aren't taken for typing errors.
#pragma once

#include <string_view>

namespace impinge {

/// Whether `name` is reserved as a value of the choice at `path` ("response.method", "lcp.method", ...). Names that are
/// built are reserved too: ask only about those that aren't among the row's own.
bool is_reserved_name(std::string_view path, std::string_view name);

}  // namespace impinge
