#include "engine/response/pair_colours.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace impinge {
namespace {

constexpr int kColours = 64;  // of either kind; the last one takes the rest

class Colouring {
 public:
  Colouring(std::span<const BodyPlaces> pairs, int bodies) : pairs_(pairs), taken_(bodies), colour_(pairs.size()) {}

  void give(bool of_grounded) {
    std::fill(taken_.begin(), taken_.end(), 0);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const auto& [a, b] = pairs_[i];
      if ((a < 0 || b < 0) != of_grounded) continue;
      const std::uint64_t taken = (a < 0 ? 0 : taken_[a]) | (b < 0 ? 0 : taken_[b]);
      const int free = std::countr_one(taken);
      if (free >= kColours - 1) {
        colour_[i] = kRest;
        continue;
      }
      colour_[i] = free + (of_grounded ? kColours : 0);
      for (const int body : {a, b})
        if (body >= 0) taken_[body] |= std::uint64_t{1} << free;
    }
  }

  PairColours sorted() const {
    PairColours result;
    std::vector<int> count(kRest + 2, 0);
    for (const int c : colour_) ++count[c + 1];
    result.begin.push_back(0);
    for (int c = 0; c <= kRest; ++c) {
      if (count[c + 1] > 0) result.begin.push_back(result.begin.back() + count[c + 1]);
      result.last_is_rest = count[c + 1] > 0 && c == kRest;
      count[c + 1] += count[c];
    }
    result.order.resize(pairs_.size());
    for (std::size_t i = 0; i < pairs_.size(); ++i) result.order[count[colour_[i]]++] = static_cast<int>(i);
    return result;
  }

 private:
  static constexpr int kRest = 2 * kColours;
  std::span<const BodyPlaces> pairs_;
  std::vector<std::uint64_t> taken_;  // by body: colours of its pairs
  std::vector<int> colour_;
};

}  // namespace

PairColours colour_pairs(std::span<const BodyPlaces> pairs, int bodies) {
  Colouring colouring(pairs, bodies);
  colouring.give(false);
  colouring.give(true);
  return colouring.sorted();
}

}  // namespace impinge
