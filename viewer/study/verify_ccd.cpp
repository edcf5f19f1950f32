#include "viewer/study/verify_ccd.hpp"

#include <fmt/format.h>

#include <chrono>

#include "engine/core/interrupt.hpp"

namespace impinge {
namespace {

using Find = std::optional<Impact> (*)(const MovingCorners&, const ContinuousSettings&);

struct CcdMethod {
  const char* name;
  Find vertex_face, edge_edge;
};

constexpr CcdMethod kMethods[] = {{"inclusion", vertex_face_impact, edge_edge_impact},
                                  {"advancement", vertex_face_advancement, edge_edge_advancement}};

CcdScore score(const CcdSet& set, const CcdMethod& method, const ContinuousSettings& settings) {
  using Clock = std::chrono::steady_clock;
  CcdScore result{set.name, method.name};
  InterruptPoll poll;
  const Clock::time_point start = Clock::now();
  for (const CcdQuery& query : set.queries) {
    poll();
    const std::optional<Impact> impact = (query.edges ? method.edge_edge : method.vertex_face)(query.corners, settings);
    (query.meets ? result.meetings : result.others) += 1;
    if (query.meets && !impact) ++result.missed;
    if (!query.meets && impact) ++result.alarms;
    if (impact && !impact->certain) ++result.undecided;
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (!set.queries.empty()) result.microseconds = 1e6 * seconds / static_cast<double>(set.queries.size());
  return result;
}

double percent(int part, int all) { return all > 0 ? 100.0 * part / all : 0.0; }

}  // namespace

std::vector<CcdScore> score_ccd(const std::vector<CcdSet>& sets, const ContinuousSettings& settings) {
  std::vector<CcdScore> scores;
  for (const CcdMethod& method : kMethods) {
    CcdScore all{"all", method.name};
    double queries = 0.0;
    for (const CcdSet& set : sets) {
      const CcdScore own = scores.emplace_back(score(set, method, settings));
      all.meetings += own.meetings, all.missed += own.missed;
      all.others += own.others, all.alarms += own.alarms, all.undecided += own.undecided;
      const double count = own.meetings + own.others;
      all.microseconds += own.microseconds * count;
      queries += count;
    }
    if (queries > 0.0) all.microseconds /= queries;
    scores.push_back(all);
  }
  return scores;
}

std::string table_of(const std::vector<CcdScore>& scores) {
  std::size_t width = 3;
  for (const CcdScore& s : scores) width = std::max(width, s.set.size());
  std::string text =
      fmt::format("{:<{}}  {:<11}  {:>8}  {:>6}  {:>7}  {:>6}  {:>8}  {:>9}  {:>12}\n", "set", width, "method",
                  "meetings", "missed", "others", "alarms", "alarms %", "undecided", "us a query");
  for (const CcdScore& s : scores)
    text +=
        fmt::format("{:<{}}  {:<11}  {:>8}  {:>6}  {:>7}  {:>6}  {:>8.2f}  {:>9}  {:>12.2f}\n", s.set, width, s.method,
                    s.meetings, s.missed, s.others, s.alarms, percent(s.alarms, s.others), s.undecided, s.microseconds);
  return text;
}

}  // namespace impinge
