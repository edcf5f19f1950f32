// Writes a run's frames on a thread of its own: encoding takes about as long as drawing, so the next frame is drawn
// meanwhile. Where one thread is all there may be (set_thread_count), in the caller's.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

#include "viewer/image/image.hpp"
#include "viewer/image/png.hpp"

namespace impinge {

class PngSequence {
 public:
  /// Creates `folder` if need be. Throws InputError where that fails.
  explicit PngSequence(std::filesystem::path folder);
  /// Writes what was added and ends the thread; a failure is lost, so call finish() where it matters.
  ~PngSequence();
  PngSequence(const PngSequence&) = delete;
  PngSequence& operator=(const PngSequence&) = delete;

  /// Hands `image` over, to be written as folder/000000.png (six digits of `frame`, in the order of the calls). Waits
  /// while kMaxWaiting images are unwritten. Throws what writing an earlier one threw (InputError on a full disk),
  /// every time from then on: nothing is written after a failure.
  void add(int frame, Image&& image, PngText text);
  /// Returns once all are written. Throws as add() does. May be called again; add() may not be called after it.
  void finish();

  static std::filesystem::path file_name(int frame);  ///< 000000.png
  static constexpr std::size_t kMaxWaiting = 4;       ///< 11 MB at 1280 x 720

 private:
  struct Entry {
    int frame = 0;
    Image image;
    PngText text;
  };
  void work();
  void write_at_once(const Entry& entry);
  void end_thread();

  const std::filesystem::path folder_;
  std::mutex mutex_;  // guards the four below
  std::condition_variable changed_;
  std::deque<Entry> waiting_;
  std::exception_ptr failure_;
  bool ended_ = false;
  std::thread thread_;  // last, so that it starts with all the others made
};

}  // namespace impinge
