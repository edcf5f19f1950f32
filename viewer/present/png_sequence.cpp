#include "viewer/present/png_sequence.hpp"

#include <fmt/format.h>

#include <utility>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "engine/io/paths.hpp"

namespace impinge {

namespace {

std::filesystem::path made(std::filesystem::path folder) {
  make_folder(folder);
  return folder;
}

}  // namespace

PngSequence::PngSequence(std::filesystem::path folder)
    : folder_(made(std::move(folder))), thread_(thread_count() > 1 ? std::thread([this] { work(); }) : std::thread()) {}

PngSequence::~PngSequence() { end_thread(); }

std::filesystem::path PngSequence::file_name(int frame) { return fmt::format("{:06}.png", frame); }

void PngSequence::add(int frame, Image&& image, PngText text) {
  std::unique_lock lock(mutex_);
  IMPINGE_ASSERT(!ended_);
  if (!thread_.joinable()) return write_at_once({frame, std::move(image), std::move(text)});
  changed_.wait(lock, [&] { return failure_ || waiting_.size() < kMaxWaiting; });
  if (failure_) std::rethrow_exception(failure_);
  waiting_.push_back({frame, std::move(image), std::move(text)});
  changed_.notify_all();
}

void PngSequence::write_at_once(const Entry& entry) {
  if (failure_) std::rethrow_exception(failure_);
  try {
    write_png(folder_ / file_name(entry.frame), entry.image, entry.text);
  } catch (...) {
    failure_ = std::current_exception();  // the next call throws it, as with a thread
  }
}

void PngSequence::finish() {
  end_thread();
  if (failure_) std::rethrow_exception(failure_);
}

void PngSequence::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ended_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    // stays in the queue while it is written: the bound counts it too, and add() doesn't move a deque's elements
    const Entry& entry = waiting_.front();
    lock.unlock();
    std::exception_ptr failure;
    try {
      write_png(folder_ / file_name(entry.frame), entry.image, entry.text);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    waiting_.pop_front();
    if (failure) {
      failure_ = failure;
      waiting_.clear();
    }
    changed_.notify_all();
    if (failure) return;
  }
}

void PngSequence::end_thread() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

}  // namespace impinge
