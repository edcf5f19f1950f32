// Numbers that are reckoned with at a time: what a loop is written once for, and compiled for each width that processors
// have. Product and sum are rounded by themselves (no fused operations), so the width never changes a bit.
#pragma once

namespace impinge {

/// Vectors stand anywhere in memory.
struct One {
  using Vector = double;
};
struct Two {
  using Vector [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;
};
struct Four {
  using Vector [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
};
struct Eight {
  using Vector [[gnu::vector_size(64), gnu::aligned(8), gnu::may_alias]] = double;
};

template <class Lanes>
inline constexpr int kWidth = sizeof(typename Lanes::Vector) / sizeof(double);

template <class Lanes>
[[gnu::always_inline]] inline typename Lanes::Vector& vector_at(double* x) {
  return *reinterpret_cast<typename Lanes::Vector*>(x);
}
template <class Lanes>
[[gnu::always_inline]] inline const typename Lanes::Vector& vector_at(const double* x) {
  return *reinterpret_cast<const typename Lanes::Vector*>(x);
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
