// Cells of a uniform grid and the hash that finds their table entry. [Teschner03] [Haapaoja16 §3.2.2]
#pragma once

#include <cstdint>

namespace impinge {

/// Integer coordinates of a cell.
struct Cell {
  std::int32_t i, j, k;
  friend bool operator==(const Cell& l, const Cell& r) { return l.i == r.i && l.j == r.j && l.k == r.k; }
};

inline std::uint32_t hash_of(const Cell& c) {
  return static_cast<std::uint32_t>(c.i) * 73856093u ^ static_cast<std::uint32_t>(c.j) * 19349663u ^
         static_cast<std::uint32_t>(c.k) * 83492791u;
}

/// x mod n for 32-bit numbers by two multiplications [Lemire19]: the division would be the dearest part of a look-up
struct Modulo {
  std::uint64_t factor = 0;
  std::uint32_t n = 1;
  explicit Modulo(std::uint32_t divisor) : factor(~std::uint64_t{0} / divisor + 1), n(divisor) {}
  std::uint32_t operator()(std::uint32_t x) const {
    const std::uint64_t low = factor * x;
    return static_cast<std::uint32_t>((static_cast<unsigned __int128>(low) * n) >> 64);
  }
};

}  // namespace impinge
