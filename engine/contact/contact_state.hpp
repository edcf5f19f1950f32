// What a solved contact does.
#pragma once

#include <cstdint>

#include "engine/core/types.hpp"

namespace impinge {

enum class ContactState : std::uint8_t { open, stick, slip };
const char* state_name(ContactState state);

/// By its impulse (n, t1, t2) and the pair's coefficient.
ContactState state_of(const Vec3& lambda, double friction);

}  // namespace impinge
