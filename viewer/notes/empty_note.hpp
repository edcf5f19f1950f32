// Pictures of a run in which nothing that moves is to be seen: what moved has left them.
#pragma once

#include <string>

namespace impinge {

class NoteArchive;
struct StepRecord;
struct ViewSettings;

class EmptyNote {
 public:
  /// The record of a frame and the view of its picture, whose size is in pixels.
  void add(const StepRecord& record, const ViewSettings& settings, int width, int height);
  /// A line with its end; "" if something that moves is in each picture.
  std::string text() const;
  void keep(NoteArchive& archive);

 private:
  int first_ = 0, count_ = 0;  // pictures
  std::string last_seen_;      // the body that was in the last picture before the first of them
};

}  // namespace impinge
