#include "tests/support/geometry/machine_parts.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/surface/mesh_checks.hpp"

namespace impinge::test {
namespace {

constexpr double kTwoPi = 2.0 * M_PI;

void add_quad(TriangleMesh& m, int a, int b, int c, int d) {
  m.triangles.insert(m.triangles.end(), {{a, b, c}, {a, c, d}});
}

/// Rows that climb with the angle: a surface over (angle, row) that goes on from the end of one turn in the row a pitch
/// above.
class Thread {
 public:
  static constexpr int kRows = 8;  // of a pitch
  explicit Thread(int turns) : rows_((turns + 1) * kRows + 1), turns_(turns) {}

  /// `radius_of` takes the place in the pitch, 0 to 1.
  template <class Radius>
  void add(TriangleMesh& m, bool is_inward, Radius&& radius_of) {
    first_.push_back(static_cast<int>(m.vertices.size()));
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < kThreadSides; ++i) {
        const double u = kTwoPi * i / kThreadSides, r = radius_of(j % kRows / static_cast<double>(kRows));
        m.vertices.emplace_back(r * std::cos(u), r * std::sin(u),
                                kPitch * (static_cast<double>(j) / kRows + u / kTwoPi));
      }
    const int n = static_cast<int>(first_.size()) - 1;
    for (int j = 0; j + 1 < rows_; ++j)
      for (int i = 0; i < kThreadSides; ++i) {
        if (i + 1 == kThreadSides && j + 1 + kRows >= rows_) continue;
        const int a = at(n, i, j), b = at(n, i + 1, j), c = at(n, i + 1, j + 1), d = at(n, i, j + 1);
        if (is_inward)
          add_quad(m, a, d, c, b);
        else
          add_quad(m, a, b, c, d);
      }
  }
  /// The vertices round the lower and the upper end, each beginning and ending with its step down.
  std::vector<int> lower(int n) const {
    std::vector<int> loop;
    for (int i = 0; i < kThreadSides; ++i) loop.push_back(at(n, i, 0));
    for (int j = kRows; j > 0; --j) loop.push_back(at(n, 0, j));
    return loop;
  }
  std::vector<int> upper(int n) const {
    std::vector<int> loop;
    for (int i = 0; i < kThreadSides; ++i) loop.push_back(at(n, i, rows_ - 1));
    for (int j = rows_ - 2; j >= rows_ - 1 - kRows; --j) loop.push_back(at(n, kThreadSides - 1, j));
    return loop;
  }
  double height() const { return kPitch * (static_cast<double>(rows_ - 1) / kRows + 1.0); }

 private:
  int at(int n, int i, int j) const {
    return first_[n] + (i < kThreadSides ? j : j + kRows) * kThreadSides + i % kThreadSides;
  }

  int rows_, turns_;
  std::vector<int> first_;
};

double thread_at(double place) { return kThreadDepth * (1.0 - 2.0 * std::abs(place - 0.5)); }

}  // namespace

TriangleMesh turned(const std::vector<std::pair<double, double>>& profile, int sides) {
  TriangleMesh m;
  m.vertices.emplace_back(0.0, 0.0, profile.front().second);
  for (std::size_t k = 1; k + 1 < profile.size(); ++k)
    for (int i = 0; i < sides; ++i) {
      const double u = kTwoPi * i / sides, r = profile[k].first;
      m.vertices.emplace_back(r * std::cos(u), r * std::sin(u), profile[k].second);
    }
  m.vertices.emplace_back(0.0, 0.0, profile.back().second);
  const int rings = static_cast<int>(profile.size()) - 2, last = static_cast<int>(m.vertices.size()) - 1;
  const auto at = [&](int ring, int i) { return 1 + ring * sides + i % sides; };
  for (int i = 0; i < sides; ++i) {
    m.triangles.push_back({0, at(0, i + 1), at(0, i)});
    for (int r = 0; r + 1 < rings; ++r) add_quad(m, at(r, i), at(r, i + 1), at(r + 1, i + 1), at(r + 1, i));
    m.triangles.push_back({last, at(rings - 1, i), at(rings - 1, i + 1)});
  }
  return m;
}

TriangleMesh bar_of_loops(const Bar& bar, const std::vector<BarLoop>& loops) {
  TriangleMesh m;
  const double c = 0.5 * bar.length, w = 0.5 * bar.width;
  const bool is_open = loops.front().radius == 0.0;
  const int n = static_cast<int>(loops.size());
  for (const double side : {-1.0, 1.0}) {  // two halves; where they meet, at +c from the end's middle, there is no wall
    const int first = static_cast<int>(m.vertices.size());
    std::vector<char> is_seam;
    for (int i = 0; i < bar.sides; ++i) {
      const double u = kTwoPi * i / bar.sides, x = std::cos(u), y = std::sin(u);
      const double to_y = std::abs(y) > 1e-12 ? w / std::abs(y) : INFINITY;
      const double to_x = x > 1e-12 ? c / x : x < -1e-12 ? w / -x : INFINITY;
      const double out = bar.is_round && x <= 1e-12 ? w : std::min(to_x, to_y);
      is_seam.push_back(x > 1e-12 && to_x <= to_y ? 1 : 0);
      for (const BarLoop& loop : loops) {
        const double r = loop.radius.value_or(out);
        m.vertices.emplace_back(!loop.radius && is_seam.back() != 0 ? 0.0 : side * (c - r * x), r * y, loop.z);
      }
    }
    const auto at = [&](int i, int k) { return first + n * (i % bar.sides) + k % n; };
    for (int i = 0; i < bar.sides; ++i)
      for (int k = 0; k + (is_open ? 1 : 0) < n; ++k) {
        const BarLoop &from = loops[k], &to = loops[(k + 1) % n];
        if (!from.radius && !to.radius && is_seam[i] != 0 && is_seam[(i + 1) % bar.sides] != 0) continue;
        int p = at(i, k), q = at(i, k + 1), r = at(i + 1, k + 1), s = at(i + 1, k);
        if (side < 0.0) std::swap(p, s), std::swap(q, r);  // mirrored
        if (from.radius == 0.0)
          m.triangles.push_back({p, q, r});
        else if (to.radius == 0.0)
          m.triangles.push_back({p, q, s});
        else
          add_quad(m, p, q, r, s);
      }
  }
  return weld(m).mesh;
}

TriangleMesh bolt(int turns) {
  TriangleMesh m;
  Thread thread(turns);
  thread.add(m, false, [](double p) { return kThreadRadius + thread_at(p); });
  m.vertices.emplace_back(0.0, 0.0, 0.5 * kPitch);
  m.vertices.emplace_back(0.0, 0.0, thread.height() - 0.5 * kPitch);
  const int low = static_cast<int>(m.vertices.size()) - 2, high = low + 1;
  const std::vector<int> down = thread.lower(0), up = thread.upper(0);
  for (std::size_t k = 0; k < down.size(); ++k) m.triangles.push_back({low, down[(k + 1) % down.size()], down[k]});
  for (std::size_t k = 0; k < up.size(); ++k) m.triangles.push_back({high, up[k], up[(k + 1) % up.size()]});
  return m;
}

TriangleMesh nut(int turns) {
  TriangleMesh m;
  Thread thread(turns);
  thread.add(m, true, [](double p) { return kThreadRadius + kThreadPlay + thread_at(p); });
  thread.add(m, false, [](double) { return 2.0 * kThreadRadius; });
  const auto close = [&](const std::vector<int>& inner, const std::vector<int>& outer, bool is_lower) {
    for (std::size_t k = 0; k < inner.size(); ++k) {
      const std::size_t l = (k + 1) % inner.size();
      if (is_lower)
        add_quad(m, inner[k], inner[l], outer[l], outer[k]);
      else
        add_quad(m, inner[k], outer[k], outer[l], inner[l]);
    }
  };
  close(thread.lower(0), thread.lower(1), true);
  close(thread.upper(0), thread.upper(1), false);
  return m;
}

}  // namespace impinge::test
