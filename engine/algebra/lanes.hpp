// Numbers that are reckoned with at a time: what a loop is written once for, and compiled for each width that processors
// have. Product and sum are rounded by themselves (no fused operations), so the width never changes a bit.
#pragma once

namespace impinge {

struct One {
  using Vector = double;
};
struct Two {
  using Vector [[gnu::vector_size(16)]] = double;
};
struct Four {
  using Vector [[gnu::vector_size(32)]] = double;
};
struct Eight {
  using Vector [[gnu::vector_size(64)]] = double;
};

template <class Lanes>
inline constexpr int kWidth = sizeof(typename Lanes::Vector) / sizeof(double);

/// From anywhere in memory: a reference to a vector there would promise that it is aligned.
template <class Vector>
[[gnu::always_inline]] inline void load(Vector& v, const double* from) {
  __builtin_memcpy(&v, from, sizeof v);
}
template <class Vector>
[[gnu::always_inline]] inline void store(double* to, const Vector& v) {
  __builtin_memcpy(to, &v, sizeof v);
}

/// Of three ways to do the same, compiled for two, four and eight lanes, the widest that this processor has.
template <class Function>
Function* widest(Function* by_two, [[maybe_unused]] Function* by_four, [[maybe_unused]] Function* by_eight) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) return by_eight;
  if (__builtin_cpu_supports("avx2")) return by_four;
#endif
  return by_two;
}

#if defined(__x86_64__)
#define IMPINGE_FOUR_LANES [[gnu::target("avx2")]]
#define IMPINGE_EIGHT_LANES [[gnu::target("avx512f")]]
#else
#define IMPINGE_FOUR_LANES
#define IMPINGE_EIGHT_LANES
#endif

}  // namespace impinge
