// Numbers as exact sums of doubles: what a sign is decided by where rounding would decide it otherwise. [Shewchuk97 §2]
#pragma once

#include <vector>

namespace impinge {

/// Doubles that do not overlap, smallest first; their sum is the number. Exact while nothing over- or underflows.
using Expansion = std::vector<double>;

/// Adds x.
void grow(Expansion& e, double x);
/// a - b
Expansion difference(double a, double b);
/// Adds sign · e · f; sign is +1 or -1.
void add_product(Expansion& sum, const Expansion& e, const Expansion& f, double sign);
/// +1, 0 or -1
int sign_of(const Expansion& e);

}  // namespace impinge
