// impinge step with a published friction-contact problem: the reader, its messages, and the files it writes.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "engine/frozen/read_friction_contact.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/sweep_results.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

// one contact in either storage, W not symmetric so that an order of values shows; mu 0.5
constexpr const char* kDense = "3\n1\n0\n3\n3\n3 3\n4 1 2\n0.5 5 3\n0.25 0.125 6\n-1 2 3\n0.5\n";
constexpr const char* kSparse =
    "3\n1\n1\n3\n3\n1\n1\n1\n3\n3\n2\n1\n0 1\n0\n0\n4\n1\n2\n0.5\n5\n3\n0.25\n0.125\n6\n-1 2 3\n0.5\n1\n";

void check_refused(const TempFolder& folder, const std::string& text, const std::string& place,
                   const std::string& words) {
  const auto file = folder.write("p.dat", text);
  std::string message;
  try {
    read_friction_contact(file);
  } catch (const InputError& error) {
    message = error.what();
  }
  CAPTURE(text, message);
  CHECK(message.rfind(file.string() + ":" + place + ": ", 0) == 0);
  CHECK(message.find(words) != std::string::npos);
  CHECK(std::count(message.begin(), message.end(), ';') >= 2);
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("published friction-contact problems: both storages are read alike, column by column") {
  const TempFolder folder;
  const Mat3 w = (Mat3() << 4, 0.5, 0.25, 1, 5, 0.125, 2, 3, 6).finished();
  for (const char* text : {kDense, kSparse}) {
    const FrictionContactProblem read = read_friction_contact(folder.write("p.dat", text));
    REQUIRE(read.problem.q.size() == 1);
    CHECK(read.w->diagonal(0) == w);
    CHECK(read.w->dense() == MatX(w));
    CHECK(read.problem.q[0] == Vec3(-1, 2, 3));
    CHECK(read.problem.mu == std::vector<double>{0.5});
  }
}

TEST_CASE("published friction-contact problems: what is wrong is named with its place and a remedy") {
  const TempFolder folder;
  const std::string dense = kDense, sparse = kSparse;
  check_refused(folder, "", "1", "ends early");
  check_refused(folder, with(dense, "3\n1", "2\n1"), "1:1", "dimension 2");
  check_refused(folder, with(dense, "3\n1", "three\n1"), "1:1", "'three'");
  check_refused(folder, with(dense, "\n1\n", "\n0\n"), "2:1", "no contacts");
  check_refused(folder, with(dense, "\n1\n", "\n-4\n"), "2:1", "room");
  check_refused(folder, with(dense, "\n1\n", "\n4000000000\n"), "2:1", "room");
  check_refused(folder, with(dense, "\n0\n", "\n2\n"), "3:1", "storage 2");
  check_refused(folder, with(dense, "\n3\n3\n3", "\n6\n3\n3"), "4:1", "6; 3 is wanted");
  check_refused(folder, with(dense, "3 3\n", "3 4\n"), "6:3", "4; 3 is wanted");
  check_refused(folder, with(dense, "0.5 5 3", "0.5 nan 3"), "8:5", "'nan'");
  check_refused(folder, with(dense, "0.5 5 3", "0.5 1e999 3"), "8:5", "finite");
  check_refused(folder, with(dense, "\n0.5\n", "\n-0.5\n"), "11:1", "friction -0.5");
  check_refused(folder, with(dense, "-1 2 3\n0.5\n", "-1 2"), "11", "ends early");
  check_refused(folder, dense + "1\n7\n", "13:1", "end here");
  check_refused(folder, dense + "1.5\n", "12:1", "whole number");
  check_refused(folder, with(sparse, "0 1\n", "0 2\n"), "13:3", "index1");
  check_refused(folder, with(sparse, "0 1\n0\n", "0 1\n1\n"), "14:1", "block column 1");
  check_refused(folder, with(sparse, "0\n4\n", "3\n4\n"), "15:1", "number of a block is 3");
  // cut anywhere it is refused, never read as something else
  for (std::size_t length = 0; length + 6 < dense.size(); ++length) {
    const auto file = folder.write("p.dat", dense.substr(0, length));
    CHECK_THROWS_AS(read_friction_contact(file), InputError);
  }
}

TEST_CASE("impinge step: impulses that differ and do the same are told, and no distance is nothing that isn't") {
  // twice the same contact: whoever carries how much, their sum is (1, 0, 0)
  std::string text = "3\n2\n0\n6\n6\n6 6\n";
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) text += row % 3 == column % 3 ? "1 " : "0 ";
    text += "\n";
  }
  const TempFolder folder;
  folder.write("p.dat", text + "-1 0 0 -1 0 0\n0.5 0.5\n");
  const Outcome outcome = impinge_run(folder.path(), {"step", "p.dat", "--out", "result"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.code == 0);
  const auto first_carries = [&](const std::string& method) {
    const std::string solution = slurp(folder / fmt::format("result/solution_{}.csv", method));
    return std::stod(solution.substr(solution.find("\n0,0.5,") + 7));
  };
  const std::size_t named = outcome.out.find("reference: ") + 11;
  const double reference = first_carries(outcome.out.substr(named, outcome.out.find(' ', named) - named));
  int others = 0;
  for (const Row& row : csv_rows(folder / "result/methods.csv")) {
    CAPTURE(row.at("method"));
    if (row.at("residual").empty() || std::stod(row.at("residual")) > 1e-6) continue;
    const bool is_other = std::abs(first_carries(row.at("method")) - reference) > 1e-3;
    if (is_other) CHECK(std::stod(row.at("distance_to_exact")) > 0.0);
    CHECK(std::stod(row.at("distance_to_exact")) < 1e-5);
    others += is_other;
  }
  REQUIRE(others >= 1);
  CHECK(outcome.out.find("λ is not unique here") != std::string::npos);
}

TEST_CASE("impinge step: a table, and with --out the files, wrong input ends with 2") {
  const TempFolder folder;
  folder.write("p.dat", kSparse);
  const Outcome table = impinge_run(folder.path(), {"step", "p.dat", "--out", "result"});
  CAPTURE(table.out, table.err);
  REQUIRE(table.code == 0);
  CHECK(table.out.find("pivoting does not apply") != std::string::npos);
  const std::string methods = slurp(folder / "result/methods.csv");
  CHECK(methods.rfind("method,iterations,ms,residual,stop_reason", 0) == 0);
  for (const char* method : {"projected_gauss_seidel", "nonsmooth_nonlinear_conjugate_gradient",
                             "accelerated_projected_gradient", "semismooth_newton"}) {
    CHECK(table.out.find(method) != std::string::npos);
    CHECK(methods.find(fmt::format("\n{},", method)) != std::string::npos);
    const std::string solution = slurp(folder / fmt::format("result/solution_{}.csv", method));
    CHECK(solution.rfind("contact,mu,r_n,r_t1,r_t2\n0,0.5,", 0) == 0);
    CHECK(std::count(solution.begin(), solution.end(), '\n') == 2);
    CHECK(slurp(folder / fmt::format("result/history_{}.csv", method)).rfind("iteration,residual\n0,", 0) == 0);
  }
  const Outcome one = impinge_run(
      folder.path(), {"step", "p.dat", "--lcp", "semismooth_newton", "--tolerance", "1e-12", "--max-iterations", "50"});
  CHECK(one.code == 0);
  CHECK(one.out.find("projected_gauss_seidel") == std::string::npos);

  const std::pair<std::vector<std::string>, std::string> wrong[] = {
      {{"step", "none.dat"}, "none.dat: there is no such file"},
      {{"step", "p.dat", "--lcp", "semismoth_newton"}, "did you mean 'semismooth_newton'?"},
      {{"step", "p.dat", "--lcp", "a,,b"}, "commas"},
      {{"step", "p.dat", "--lcp", "pivoting"}, "no chosen solver applies"},
      {{"step", "p.dat", "--tolerance", "0"}, "--tolerance"},
      {{"step", "p.dat", "--max-iterations", "x"}, "--max-iterations"},
      {{"step", "p.dat", "--response", "constraint_anticipation"}, "has no bodies"},
      {{"step"}, "FILE"}};
  for (const auto& [words, expected] : wrong) {
    const Outcome outcome = impinge_run(folder.path(), words);
    CAPTURE(words, outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.error_lines() == 1);
    CHECK(outcome.err.find(expected) != std::string::npos);
  }
}
