#include "engine/detection/broadphase/pruned_sweep.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace impinge {
namespace {

/// Boxes that a column should hold: below this a sweep along x is cheaper than sorting into more columns (measured).
constexpr int kColumn = 256;
/// Entries a box after a cut that are worth it, on average; wide boxes would be entered in too many strips.
constexpr double kMaxCopies = 2.0;
/// Lower ends from which the quantiles are taken.
constexpr std::size_t kSample = 128;

float below(double x) {
  const float f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float above(double x) {
  const float f = static_cast<float>(x);
  return static_cast<double>(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

/// An unsigned key in the order of the floats; -0 and 0 get one key.
std::uint32_t radix_key(float f) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(f + 0.0f);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

}  // namespace

void PrunedSweep::sort_by_x(std::span<const Aabb> boxes) {
  const std::size_t count = boxes.size();
  sorted_.resize(count);
  scratch_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Aabb& b = boxes[i];
    scratch_[i] = {{below(b.min.x()), below(b.min.y()), below(b.min.z())},
                   {above(b.max.x()), above(b.max.y()), above(b.max.z())},
                   static_cast<std::uint32_t>(i),
                   3u};
  }
  if (count < 256) {
    std::sort(scratch_.begin(), scratch_.end(),
              [](const Entry& l, const Entry& r) { return l.min[0] != r.min[0] ? l.min[0] < r.min[0] : l.id < r.id; });
    sorted_.swap(scratch_);
    return;
  }
  // radix sort of (key, index), 11 bits a pass; the entries move once
  found_.resize(count);
  ordered_.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    found_[i] = static_cast<std::uint64_t>(radix_key(scratch_[i].min[0])) << 32 | i;
  for (int shift = 32; shift < 64; shift += 11) {
    std::array<std::uint32_t, 2048> place{};
    for (std::uint64_t v : found_) ++place[v >> shift & 2047];
    std::uint32_t sum = 0;
    for (std::uint32_t& p : place) {
      const std::uint32_t n = p;
      p = sum;
      sum += n;
    }
    for (std::uint64_t v : found_) ordered_[place[v >> shift & 2047]++] = v;
    found_.swap(ordered_);
  }
  for (std::size_t i = 0; i < count; ++i) sorted_[i] = scratch_[static_cast<std::uint32_t>(found_[i])];
}

void PrunedSweep::sweep(std::span<const Entry> entries) {
  for (std::size_t i = 0; i + 1 < entries.size(); ++i) {
    const Entry a = entries[i];
    for (std::size_t j = i + 1; j < entries.size() && entries[j].min[0] <= a.max[0]; ++j) {
      const Entry& b = entries[j];
      // of the columns that two boxes share, the one where the later of them starts, in y and z, reports the pair
      // (whole numbers, not conditions: branches that no one can predict would cost more than the comparisons)
      const int hit = int{a.min[1] <= b.max[1]} & int{b.min[1] <= a.max[1]} & int{a.min[2] <= b.max[2]} &
                      int{b.min[2] <= a.max[2]} & int{(a.starts | b.starts) == 3u};
      if (hit != 0) found_.push_back(static_cast<std::uint64_t>(std::min(a.id, b.id)) << 32 | std::max(a.id, b.id));
    }
  }
}

bool PrunedSweep::cut(std::span<const Entry> entries, int axis, int strips, Cut& cut) {
  const std::size_t count = entries.size();
  const std::size_t stride = std::max<std::size_t>(1, count / kSample);
  sample_.clear();
  for (std::size_t i = stride / 2; i < count; i += stride)
    if (std::isfinite(entries[i].min[axis])) sample_.push_back(entries[i].min[axis]);
  std::sort(sample_.begin(), sample_.end());
  cut.first.resize(count);
  cut.last.resize(count);
  for (;; strips /= 2) {
    cut.bounds.clear();
    for (int s = 1; s < strips && !sample_.empty(); ++s) {
      const float bound = sample_[sample_.size() * s / strips];
      if (cut.bounds.empty() || bound > cut.bounds.back()) cut.bounds.push_back(bound);
    }
    if (cut.bounds.empty()) return false;
    // where to start looking for a strip: a table over equal steps, since a binary search mispredicts at every level
    const float low = cut.bounds.front(), high = cut.bounds.back();
    const float scale = high > low ? static_cast<float>(kGuesses) / (high - low) : 0.0f;
    const int bounds = static_cast<int>(cut.bounds.size());
    for (int step = 0, s = 0; step < kGuesses; ++step) {
      while (s < bounds && (cut.bounds[s] - low) * scale < static_cast<float>(step)) ++s;
      guess_[step] = s;
    }
    const auto strip_of = [&](float x) {
      if (x < low) return 0;
      if (x >= high) return bounds;
      int s = guess_[std::min(static_cast<int>((x - low) * scale), kGuesses - 1)];
      while (s > 0 && x < cut.bounds[s - 1]) --s;  // rounding of the step
      while (s < bounds && x >= cut.bounds[s]) ++s;
      return s;
    };
    cut.begin.assign(cut.bounds.size() + 2, 0);
    std::size_t total = 0;
    for (std::size_t i = 0; i < count; ++i) {
      cut.first[i] = strip_of(entries[i].min[axis]);
      // an empty box (min > max) is kept in one strip, where it overlaps nothing
      cut.last[i] = std::max(cut.first[i], strip_of(entries[i].max[axis]));
      total += static_cast<std::size_t>(cut.last[i] - cut.first[i] + 1);
    }
    const double copies = static_cast<double>(total) / static_cast<double>(count);
    // two or three strips that all boxes reach part nothing
    if (copies > std::min(kMaxCopies, 0.6 * static_cast<double>(cut.bounds.size() + 1))) continue;

    for (std::size_t i = 0; i < count; ++i)
      for (int s = cut.first[i]; s <= cut.last[i]; ++s) ++cut.begin[s + 1];
    for (std::size_t s = 1; s < cut.begin.size(); ++s) cut.begin[s] += cut.begin[s - 1];
    cut.next.assign(cut.begin.begin(), cut.begin.end() - 1);
    cut.entries.resize(total);
    const std::uint32_t bit = axis == 1 ? 1u : 2u;
    for (std::size_t i = 0; i < count; ++i)
      for (int s = cut.first[i]; s <= cut.last[i]; ++s) {
        Entry& e = cut.entries[cut.next[s]++] = entries[i];
        if (s != cut.first[i]) e.starts &= ~bit;
      }
    return true;
  }
}

void PrunedSweep::divide(std::span<const Entry> entries, int axis, int depth, int failures) {
  if (entries.size() < 2 * kColumn || depth == kMaxDepth || failures == 2) {
    sweep(entries);
    return;
  }
  // the first cut leaves half of the work to the other axis, so that columns are square
  const double columns = static_cast<double>(entries.size()) / kColumn;
  const int strips = std::max(2, static_cast<int>(depth == 0 ? std::sqrt(columns) : columns));
  Cut& strips_of = cuts_[depth];
  if (!cut(entries, axis, strips, strips_of)) {
    divide(entries, 3 - axis, depth, failures + 1);
    return;
  }
  for (std::size_t s = 0; s + 1 < strips_of.begin.size(); ++s) {
    const std::size_t begin = static_cast<std::size_t>(strips_of.begin[s]),
                      end = static_cast<std::size_t>(strips_of.begin[s + 1]);
    divide(std::span<const Entry>(strips_of.entries).subspan(begin, end - begin), 3 - axis, depth + 1, 0);
  }
}

void PrunedSweep::output(std::span<const Aabb> boxes, std::vector<BoxPair>& pairs) {
  // exact test of what single precision found, in a loop of its own: the cache misses of its loads overlap
  std::size_t kept = 0;
  for (std::uint64_t v : found_) {
    found_[kept] = v;
    kept += overlap(boxes[v >> 32], boxes[v & 0xffffffffu]) ? 1 : 0;
  }
  found_.resize(kept);
  // counting sort by the first index; the few partners of a box by insertion
  row_.assign(boxes.size() + 1, 0);
  for (std::uint64_t v : found_) ++row_[(v >> 32) + 1];
  for (std::size_t i = 0; i < boxes.size(); ++i) row_[i + 1] += row_[i];
  pairs.resize(found_.size());
  for (std::uint64_t v : found_)
    pairs[row_[v >> 32]++] = {static_cast<int>(v >> 32), static_cast<int>(v & 0xffffffffu)};
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {  // row_[i] is now the end of row i
    const std::uint32_t end = row_[i];
    if (end - begin > 32) {
      std::sort(pairs.begin() + begin, pairs.begin() + end);
    } else {
      for (std::uint32_t k = begin + 1; k < end; ++k)
        for (std::uint32_t m = k; m > begin && pairs[m].second < pairs[m - 1].second; --m)
          std::swap(pairs[m], pairs[m - 1]);
    }
    begin = end;
  }
}

void PrunedSweep::find(std::span<const Aabb> boxes, std::vector<BoxPair>& pairs) {
  sort_by_x(boxes);
  found_.clear();
  divide(sorted_, 1, 0, 0);
  output(boxes, pairs);
}

}  // namespace impinge
