// Which frames of a run: A, A:B or A:B:S, both ends included.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace impinge {

class FrameRange {
 public:
  /// All frames.
  FrameRange() = default;
  /// As written after `option`; what is left out is the first, the last, every one. Throws InputError.
  FrameRange(const std::string& text, const std::string& option);

  /// Of a run whose last frame is `last`. Throws InputError for frames that it has not.
  std::vector<int> frames(int last) const;
  int stride() const { return stride_; }

 private:
  std::string text_, option_;
  std::optional<int> first_, last_;
  int stride_ = 1;
};

}  // namespace impinge
