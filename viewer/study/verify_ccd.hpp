// How continuous detection answers queries whose answers are known: what it misses, what it calls a meeting that is none,
// and what it takes.
#pragma once

#include "viewer/study/ccd_queries.hpp"

namespace impinge {

/// One method on one set.
struct CcdScore {
  std::string set, method;
  int meetings = 0, missed = 0;  ///< of those that meet
  int others = 0, alarms = 0;    ///< of those that don't
  int undecided = 0;             ///< answers that the bound on work gave
  double microseconds = 0.0;     ///< a query, mean
};

/// Each method on each set, and on all of them as set "all".
std::vector<CcdScore> score_ccd(const std::vector<CcdSet>& sets, const ContinuousSettings& settings);

/// As a table for a terminal.
std::string table_of(const std::vector<CcdScore>& scores);

}  // namespace impinge
