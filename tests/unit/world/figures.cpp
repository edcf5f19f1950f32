// The table of figures and what is made of it, held against the columns as they were agreed on, written out here.
#include "engine/world/figures.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <set>

#include "viewer/tables/stats_table.hpp"

using namespace impinge;

namespace {

const std::string kAgreed =
    "frame,time_s,substeps,bodies,dofs,broad_pairs,triangle_pairs,contacts,groups,max_penetration_m,residual,"
    "lcp_iterations,outer_iterations,kinetic_J,potential_J,elastic_J,momentum_x,momentum_y,momentum_z,"
    "angular_momentum_x,angular_momentum_y,angular_momentum_z,broad_ms,narrow_ms,assemble_ms,response_ms,integrate_ms,"
    "step_ms,render_ms,state_hash,unconverged,asleep";
const std::string kAgreedJudged = kAgreed + ",judged_penetration_m,judged_intersections";

/// Each figure another number.
FrameStats distinct() {
  FrameStats s;
  s.frame = 1, s.time = 2.5, s.substeps = 3, s.bodies = 4, s.dofs = 5;
  s.broad_pairs = 6, s.triangle_pairs = 7, s.contacts = 8, s.groups = 9;
  s.max_penetration = 10.5, s.residual = 1.1e-9, s.lcp_iterations = 12, s.outer_iterations = 13;
  s.kinetic = 14.5, s.potential = -15.5, s.elastic = 16.5;
  s.momentum = {17.5, 18.5, 19.5}, s.angular_momentum = {20.5, 21.5, 22.5};
  s.times = {23.5, 24.5, 25.5, 26.5, 27.5, 28.5, 29.5};
  s.state_hash = 0x1234abcdULL, s.unconverged = 31, s.asleep = 32;
  s.judged_penetration = 33.5, s.judged_intersections = 34;
  s.residual_coulomb = 1.25e-3, s.ended = SolveEnd::stalled;
  return s;
}

const std::string kRow =
    "1,2.5,3,4,5,6,7,8,9,10.5,1.1e-09,12,13,14.5,-15.5,16.5,17.5,18.5,19.5,20.5,21.5,22.5,23.5,24.5,25.5,26.5,27.5,28."
    "5,"
    "29.5,000000001234abcd,31,32";

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out = {""};
  for (const char c : line)
    if (c == ',')
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

std::string without(const std::string& line, std::size_t last) {
  std::string out;
  const std::vector<std::string> all = cells(line);
  for (std::size_t i = 0; i + last < all.size(); ++i) out += (i == 0 ? "" : ",") + all[i];
  return out;
}

}  // namespace

TEST_CASE("the columns agreed on keep their names, places and meaning") {
  // what has come since stands after them
  CHECK(StatsColumns(false).header().rfind(kAgreed, 0) == 0);
  CHECK(StatsColumns(true).header().rfind(kAgreedJudged, 0) == 0);
  CHECK(StatsColumns(false).row(distinct()).rfind(kRow, 0) == 0);
  CHECK(StatsColumns(true).row(distinct()).rfind(kRow + ",33.5,34", 0) == 0);
}

TEST_CASE("a figure has a name of its own, a meaning, and _ms if and only if it is a time") {
  std::set<std::string_view> names;
  for (const Figure& figure : figures()) {
    CAPTURE(figure.name);
    CHECK(names.insert(figure.name).second);
    CHECK(figure.doc.ends_with("."));
    CHECK(figure.name.ends_with("_ms") == (figure.kind == FigureKind::time));
    CHECK(figure.name.starts_with("judged_") == (figure.kind == FigureKind::judged));
    CHECK(find_figure(figure.name) == &figure);
  }
  CHECK(find_figure("frames") == nullptr);
}

TEST_CASE("numbers by name are those of the row") {
  for (const bool judged : {false, true}) {
    const StatsColumns columns(judged);
    const std::vector<std::string> header = cells(columns.header()), row = cells(columns.row(distinct()));
    const std::vector<double> values = figure_values(distinct(), judged);
    REQUIRE(figure_names(judged).size() == header.size() - 1);  // all but the hash
    REQUIRE(values.size() == header.size() - 1);
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i] == "state_hash") continue;
      CAPTURE(header[i]);
      const double value = values[figure_index(header[i], judged)];
      if (header[i] == "ended") {
        CHECK((row[i] == "stalled" && value == 2.0));
      } else {
        CHECK(value == std::stod(row[i]));
      }
    }
    const StatsLine line = columns.parse(columns.row(distinct()));
    CHECK(line.figures == values);
    CHECK(line.state_hash == "000000001234abcd");
  }
  CHECK_THROWS_AS(figure_index("judged_penetration_m", false), InternalError);
}

TEST_CASE("why solves ended is a word in the table, and read back as its number") {
  FrameStats s = distinct();
  const StatsColumns columns(false);
  for (const SolveEnd end : kSolveEnds) {
    s.ended = end;
    CHECK(columns.parse(columns.row(s)).figures[figure_index("ended")] == static_cast<double>(end));
  }
  std::string odd = columns.row(s);
  odd.replace(odd.rfind(name_of(s.ended)), name_of(s.ended).size(), "tired");
  CHECK_THROWS_WITH(columns.parse(odd), Catch::Contains("'tired' in column ended"));
}

TEST_CASE("the worst solve of a frame is that of the largest residual among those without an answer") {
  FrameStats s;
  CHECK(s.ended == SolveEnd::converged);
  s.take_unsolved({SolveEnd::stalled, "", 1}, 1e-6);
  s.take_unsolved({SolveEnd::cap, "lcp.max_iterations", 1}, 1e-3);
  s.take_unsolved({SolveEnd::contradiction, "", 1}, 1e-5);
  CHECK((s.ended == SolveEnd::cap && s.unconverged == 3 && s.unsolved.size() == 3));
}

TEST_CASE("a table that an older version wrote lacks what has come since") {
  const StatsColumns older(without(kAgreed, 1), false);
  CHECK(older.header() == without(kAgreed, 1));
  CHECK(older.row(distinct()) == without(kRow, 1));  // a run that goes on keeps its columns
  const StatsLine line = older.parse(without(kRow, 1));
  CHECK(std::isnan(line.figures[figure_index("asleep")]));
  CHECK(line.figures[figure_index("unconverged")] == 31.0);

  const std::string text = without(kAgreed, 2) + "\n" + without(kRow, 2) + "\n2,2";
  const std::string file = "stats.csv";
  StatsReader reader(text, false, file);
  StatsLine row;
  CHECK(reader.next(row));
  CHECK(row.figures[0] == 1.0);
  CHECK_FALSE(reader.next(row));  // cut off within its line
}

TEST_CASE("a table of no version is refused, and a row of another shape") {
  const std::string file = "here.csv";
  const auto refused = [&](const std::string& text, bool judged, const std::string& what) {
    CAPTURE(text, judged);
    try {
      StatsReader reader(text, judged, file);
      for (StatsLine row; reader.next(row);) {
      }
      FAIL("it was taken");
    } catch (const InputError& error) {
      CHECK_THAT(error.what(), Catch::Contains(what));
    }
  };
  const std::string header = StatsColumns(false).header(), row = StatsColumns(false).row(distinct());
  refused("", false, "here.csv:1:1: another header");
  refused(header, false, "here.csv:1:1: another header");
  refused("time_s," + header + "\n", false, "here.csv:1:1: another header");
  refused(header + ",asleep\n", false, "here.csv:1:1: another header");
  refused(header + ",tomorrow\n", false, "here.csv:1:1: another header");
  refused("frame,state_hash\n", false, "here.csv:1:1: another header");
  refused(StatsColumns(true).header() + "\n", false, "here.csv:1:1: another header");
  refused(header + "\n", true, "here.csv:1:1: another header");
  refused(header + "\n" + row + "\n1,2\n", false, "here.csv:3:1: '' in column substeps; a number is wanted");
  refused(header + "\n" + row + ",7\n", false, "here.csv:2:1: '7' after column");
}

TEST_CASE("a scene's own columns stand last, are read back exactly, and no others are taken for them") {
  const StatsShape shape(false, std::vector<std::string>{"x", "push"});
  const StatsColumns columns(shape);
  CHECK(columns.header() == StatsColumns(false).header() + ",x,push");
  const std::vector<double> own = {0.1, -std::numeric_limits<double>::quiet_NaN()};
  const std::string line = columns.row(distinct(), own);
  CHECK(line == StatsColumns(false).row(distinct()) + ",0.1,nan");
  const StatsLine read = columns.parse(line);
  CHECK(read.figures == figure_values(distinct(), false));
  REQUIRE(read.own.size() == 2);
  CHECK((read.own[0] == 0.1 && std::isnan(read.own[1])));
  CHECK_THROWS_WITH(columns.parse(line + ",7"), Catch::Contains("'7' after column push"));
  CHECK_THROWS_WITH(columns.parse(StatsColumns(false).row(distinct()) + ",0.1,y"),
                    Catch::Contains("'y' in column push"));
  CHECK_THROWS_AS(columns.row(distinct()), InternalError);

  const std::string header = columns.header();
  CHECK(StatsColumns(header, shape).own() == *shape.own);
  CHECK(StatsColumns(header, StatsShape(false, std::nullopt)).own() == *shape.own);  // whatever there is
  for (const std::string& other : {StatsColumns(false).header(), header + ",y",
                                   StatsColumns(false).header() + ",push,x", StatsColumns(false).header() + ",x,x"})
    CHECK_THROWS_AS(StatsColumns(other, shape), InputError);
  CHECK_THROWS_AS(StatsColumns(header, false), InputError);
  // none between the figures
  CHECK_THROWS_AS(StatsColumns("frame,x" + header.substr(5), StatsShape(false, std::nullopt)), InputError);
}

TEST_CASE("a snapshot keeps every figure but times and judgements") {
  const FrameStats from = distinct();
  ByteWriter out;
  put_figures(out, from);
  FrameStats to;
  to.times.step_ms = 99.0, to.judged_penetration = 98.0;
  ByteReader in(out.bytes());
  get_figures(in, to);
  CHECK(in.at_end());
  CHECK((to.times.step_ms == 99.0 && to.judged_penetration == 98.0));
  CHECK((to.frame == 1 && to.time == 2.5 && to.substeps == 3 && to.bodies == 4 && to.dofs == 5 && to.asleep == 32));
  CHECK((to.broad_pairs == 6 && to.triangle_pairs == 7 && to.contacts == 8 && to.groups == 9));
  CHECK((to.max_penetration == 10.5 && to.residual == 1.1e-9 && to.lcp_iterations == 12 && to.outer_iterations == 13));
  CHECK((to.kinetic == 14.5 && to.potential == -15.5 && to.elastic == 16.5 && to.unconverged == 31));
  CHECK((to.momentum == from.momentum && to.angular_momentum == from.angular_momentum));
  CHECK(to.state_hash == from.state_hash);

  const auto number = [](std::uint64_t n) { return std::string(reinterpret_cast<const char*>(&n), sizeof n); };
  FrameStats older;
  older.asleep = 7;
  const std::string two = number(2) + out.bytes().substr(8, 16);
  ByteReader few(two);
  get_figures(few, older);
  CHECK((few.at_end() && older.frame == 1 && older.time == 2.5 && older.substeps == 0 && older.asleep == 7));
  const std::string more = number(200) + out.bytes().substr(8) + std::string(2000, 'x');
  ByteReader later(more);
  CHECK_THROWS_AS(get_figures(later, older), InputError);
}
