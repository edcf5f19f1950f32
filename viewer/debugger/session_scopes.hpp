// What is lent to a session for a while, and taken back however that ends.
#pragma once

#include <utility>
#include <vector>

#include "viewer/controller/session.hpp"

namespace impinge {

/// The view stays as it is, whatever becomes of the session.
class KeptView {
 public:
  explicit KeptView(const Session& session) {
    for (const Parameter& row : session.rows().all())
      if (row.path.starts_with("view.")) values_.emplace_back(&row, row.get());
  }
  ~KeptView() {
    for (const auto& [row, value] : values_) row->set(value);
  }
  KeptView(const KeptView&) = delete;
  KeptView& operator=(const KeptView&) = delete;

 private:
  std::vector<std::pair<const Parameter*, ParameterValue>> values_;
};

/// Somebody looks on while frames are made; null: nobody.
class WatchScope {
 public:
  WatchScope(Session& session, StepWatcher* watcher) : session_(session) { session.watch(watcher); }
  ~WatchScope() { session_.watch(nullptr); }
  WatchScope(const WatchScope&) = delete;
  WatchScope& operator=(const WatchScope&) = delete;

 private:
  Session& session_;
};

}  // namespace impinge
