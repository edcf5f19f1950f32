// What a run leaves behind, and that an interrupted one goes on bit for bit.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <map>
#include <regex>

#include "engine/geometry/triangle_mesh.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"([contact]
friction = 0.4
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [1, 0.5, 1] } }
position = [0, 0.6, 0]
rotation = [0, 30, 10]
[[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 0.3 } }
position = [0.1, 1.6, 0]
[[body]]
name = "tetra"
kind = "dynamic"
surface = "meshes/tetra.off"
scale = 0.5
position = [0.8, 1.2, 0.3]
[[body]]
name = "paddle"
kind = "scripted"
shape = { capsule = { radius = 0.1, length = 0.5 } }
motion = [ { time = 0, position = [-2, 0.3, 0], rotation = [90, 0, 0] }, { time = 0.5, position = [0, 0.3, 0] } ]
)";

constexpr const char* kScript = R"(# changes between frames
at 0 set contact.friction 0.5
at 3 set simulation.gravity [0, -15, 0]
from 5 to 9 ramp simulation.gravity [0, -15, 0] [1, -10, 0]
at 12 set body.ball.velocity 0 3 0
at 14 layer +normals -contacts
at 16 camera orbit 15 5
from 20 to 24 ramp lcp.max_iterations 100 200
)";

struct Files {
  TempFolder folder;
  Files() {
    folder.write("s.toml", kScene);
    folder.write("a.script", kScript);
    folder.write("meshes/tetra.off", off_text(tetrahedron()));
  }
  std::vector<std::string> run(const std::string& out, std::vector<std::string> more = {"--no-images"}) const {
    std::vector<std::string> words = {"run", "s.toml", "--script", "a.script", "--out", out, "--frames", "30"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
};

std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == mark)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::vector<std::map<std::string, std::string>> table(const fs::path& file) {
  const std::string text = slurp(file);
  REQUIRE(!text.empty());
  REQUIRE(text.back() == '\n');
  std::vector<std::string> lines = split(text.substr(0, text.size() - 1), '\n');
  const std::vector<std::string> names = split(lines[0], ',');
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> values = split(lines[i], ',');
    REQUIRE(values.size() == names.size());
    auto& row = rows.emplace_back();
    for (std::size_t k = 0; k < names.size(); ++k) row[names[k]] = values[k];
  }
  return rows;
}

// without the columns that measure time
std::vector<std::map<std::string, std::string>> timeless(const fs::path& file) {
  auto rows = table(file);
  for (auto& row : rows)
    std::erase_if(row, [](const auto& cell) {
      return cell.first.size() > 3 && cell.first.substr(cell.first.size() - 3) == "_ms";
    });
  return rows;
}

}  // namespace

TEST_CASE("a run's folder holds what the contract says") {
  const Files files;
  const Outcome outcome =
      impinge_run(files.folder.path(), files.run("out", {"--no-images", "--contacts", "--export", "ply"}));
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.err.empty());
  const fs::path out = files.folder / "out";
  CHECK(fs::exists(out / "run.toml"));
  CHECK(fs::exists(out / "done"));
  CHECK_FALSE(fs::exists(out / "frames"));
  for (const auto& entry : fs::recursive_directory_iterator(out)) CHECK(entry.path().extension() != ".tmp");

  const std::string stats = slurp(out / "stats.csv");
  CHECK(stats.rfind("frame,time_s,substeps,bodies,dofs,broad_pairs,triangle_pairs,contacts,groups,max_penetration_m,"
                    "residual,lcp_iterations,outer_iterations,"
                    "kinetic_J,potential_J,elastic_J,momentum_x,momentum_y,momentum_z,angular_momentum_x,angular_"
                    "momentum_y,angular_momentum_z,"
                    "broad_ms,narrow_ms,assemble_ms,response_ms,integrate_ms,step_ms,render_ms,state_hash",
                    0) == 0);
  const auto rows = table(out / "stats.csv");
  REQUIRE(rows.size() == 31);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CHECK(rows[k].at("frame") == std::to_string(k));
    CHECK(std::stod(rows[k].at("time_s")) == Approx(k / 60.0).epsilon(1e-12));
    CHECK(std::regex_match(rows[k].at("state_hash"), std::regex("[0-9a-f]{16}")));
    CHECK(rows[k].at("bodies") == "5");
    CHECK(rows[k].at("dofs") == "18");
    CHECK(rows[k].at("elastic_J") == "0");
  }
  CHECK(rows[0].at("lcp_iterations") == "0");

  CHECK(slurp(out / "contacts.csv")
            .rfind("frame,body_a,body_b,triangle_a,triangle_b,pa_x,pa_y,pa_z,pb_x,pb_y,pb_z,n_x,n_y,n_z,gap_m,gap0_m,"
                   "lambda_n,lambda_t1,lambda_t2,mu,state,pair_id\n",
                   0) == 0);
  const auto contacts = table(out / "contacts.csv");
  REQUIRE(!contacts.empty());
  std::map<std::string, int> count;
  for (const auto& c : contacts) {
    ++count[c.at("frame")];
    const auto number = [&](const char* name) { return std::stod(c.at(name)); };
    const Vec3 a(number("pa_x"), number("pa_y"), number("pa_z")), b(number("pb_x"), number("pb_y"), number("pb_z")),
        n(number("n_x"), number("n_y"), number("n_z"));
    CHECK(n.norm() == Approx(1.0).epsilon(1e-12));
    CHECK(n.dot(a - b) == Approx(number("gap_m")).margin(1e-12));
    CHECK((c.at("state") == "open" || c.at("state") == "stick" || c.at("state") == "slip"));
  }
  for (const auto& row : rows) CHECK(row.at("contacts") == std::to_string(count[row.at("frame")]));

  CHECK(fs::exists(out / "surfaces/000030/paddle.ply"));
  CHECK_FALSE(fs::exists(out / "surfaces/000030/floor.ply"));
  const TriangleMesh tetra = read_mesh(out / "surfaces/000000/tetra.ply");
  CHECK(tetra.triangles == tetrahedron().triangles);
  for (int v = 0; v < 4; ++v)
    CHECK((tetra.vertices[v] - (0.5 * tetrahedron().vertices[v] + Vec3(0.8, 1.2, 0.3))).norm() < 1e-14);
  const TriangleMesh ball = read_mesh(out / "surfaces/000000/ball.ply");
  for (const Vec3& x : ball.vertices) CHECK((x - Vec3(0.1, 1.6, 0)).norm() == Approx(0.3).epsilon(1e-12));
  CHECK(make_topology(ball).is_closed());
}

TEST_CASE("a command at frame k shows first in frame k, and ramps reach both ends") {
  const Files files;
  // nothing touches for the first frames: potential energy is -m g·x with the gravity of the frame
  REQUIRE(impinge_run(files.folder.path(), files.run("out")).code == 0);
  const std::string log = slurp(files.folder / "out/commands.log");
  const std::vector<std::string> lines = split(log, '\n');
  CHECK(lines[0] == "at 0 set contact.friction 0.5");
  CHECK(lines[1] == "at 3 set simulation.gravity [0, -15, 0]");
  CHECK(lines[2] == "at 5 set simulation.gravity [0, -15, 0]");
  CHECK(lines[4] == "at 7 set simulation.gravity [0.5, -12.5, 0]");
  CHECK(lines[6] == "at 9 set simulation.gravity [1, -10, 0]");
  CHECK(log.find("at 14 layer +normals -contacts\nat 16 camera orbit 15 5\nat 20 set lcp.max_iterations 100\nat 21 set "
                 "lcp.max_iterations 125\n") != std::string::npos);
  CHECK(log.find("at 24 set lcp.max_iterations 200\n") != std::string::npos);

  files.folder.write("drop.toml",
                     "[[body]]\nname = \"a\"\nkind = \"dynamic\"\nmass = 2\nshape = { sphere = { radius = 1 } "
                     "}\nposition = [0, 5, 0]\n");
  files.folder.write("drop.script", "at 0 set simulation.gravity 0 -1 0\nat 2 set simulation.gravity 0 -3 0\n");
  REQUIRE(impinge_run(files.folder.path(),
                      {"run", "drop.toml", "--script", "drop.script", "--out", "drop", "--frames", "3", "--no-images"})
              .code == 0);
  const auto rows = table(files.folder / "drop/stats.csv");
  REQUIRE(rows.size() == 4);
  const auto velocity = [&](int k) { return std::stod(rows[k].at("momentum_y")) / 2.0; };
  CHECK(std::stod(rows[0].at("potential_J")) == Approx(2 * 1 * 5.0).epsilon(1e-12));
  CHECK(velocity(1) == Approx(-1 / 60.0).epsilon(1e-12));
  CHECK(velocity(2) == Approx(-4 / 60.0).epsilon(1e-12));
  CHECK(velocity(3) == Approx(-7 / 60.0).epsilon(1e-12));

  // the log is a script: it gives the same states
  REQUIRE(impinge_run(files.folder.path(), {"run", "s.toml", "--script", "out/commands.log", "--out", "again",
                                            "--frames", "30", "--no-images"})
              .code == 0);
  CHECK(timeless(files.folder / "again/stats.csv") == timeless(files.folder / "out/stats.csv"));
}

TEST_CASE("the number of threads changes no bit") {
  const Files files;
  REQUIRE(impinge_run(files.folder.path(), files.run("one", {"--no-images", "--contacts", "--threads", "1"})).code ==
          0);
  REQUIRE(impinge_run(files.folder.path(), files.run("two", {"--no-images", "--contacts", "--threads", "2"})).code ==
          0);
  CHECK(timeless(files.folder / "one/stats.csv") == timeless(files.folder / "two/stats.csv"));
  CHECK(slurp(files.folder / "one/contacts.csv") == slurp(files.folder / "two/contacts.csv"));
  CHECK(slurp(files.folder / "one/run.toml") == slurp(files.folder / "two/run.toml"));
}

TEST_CASE("a replay repeats every hash, and sees a changed one") {
  const Files files;
  REQUIRE(
      impinge_run(files.folder.path(), files.run("out", {"--no-images", "--set", "body.crate.material.density=300"}))
          .code == 0);
  const Outcome good = impinge_run("/", {"replay", (files.folder / "out").string()});
  INFO(good.err);
  CHECK(good.code == 0);
  CHECK(good.out.find("31 frames repeated") != std::string::npos);

  // run.toml is a scene: a run of it, script and all, is the same run
  REQUIRE(impinge_run("/", {"run", (files.folder / "out/run.toml").string(), "--out", (files.folder / "again").string(),
                            "--no-images"})
              .code == 0);
  CHECK(timeless(files.folder / "again/stats.csv") == timeless(files.folder / "out/stats.csv"));
  CHECK(slurp(files.folder / "again/run.toml") == slurp(files.folder / "out/run.toml"));

  const std::string stats = slurp(files.folder / "out/stats.csv");
  const std::string hash = table(files.folder / "out/stats.csv")[17].at("state_hash");
  std::string tampered = stats;
  char& digit = tampered[tampered.find(hash)];
  digit = digit == '0' ? '1' : '0';
  files.folder.write("out/stats.csv", tampered);
  const Outcome bad = impinge_run(files.folder.path(), {"replay", "out"});
  CHECK(bad.code == 1);
  CHECK(bad.out.find("frame 17: state hash " + hash) != std::string::npos);

  // a part of the table is not a finished run, and all there is of one that was stopped
  std::size_t end = 0;
  for (int line = 0; line < 6; ++line) end = stats.find('\n', end) + 1;
  files.folder.write("out/stats.csv", stats.substr(0, end));
  const Outcome part = impinge_run(files.folder.path(), {"replay", "out"});
  CHECK(part.code == 2);
  CHECK(part.err.find("ends with frame 4, but the run came to its end, frame 30") != std::string::npos);
  std::filesystem::remove(files.folder / "out/done");
  const Outcome stopped = impinge_run(files.folder.path(), {"replay", "out"});
  CHECK(stopped.code == 0);
  CHECK(stopped.out.find("5 frames repeated") != std::string::npos);
  CHECK(stopped.out.find("was to go on to frame 30") != std::string::npos);
  files.folder.write("out/stats.csv", stats);

  files.folder.write("meshes/tetra.off", off_text(tetrahedron()) + "\n");
  const Outcome changed = impinge_run(files.folder.path(), {"replay", "out"});
  CHECK(changed.code == 2);
  CHECK(changed.err.find("has changed since the run") != std::string::npos);
  CHECK(impinge_run(files.folder.path(), {"replay", "meshes"}).code == 2);
}

TEST_CASE("expectations and breaks decide the exit code") {
  const Files files;
  const auto run_script = [&](const std::string& script) {
    files.folder.write("b.script", script);
    fs::remove_all(files.folder / "b");
    return impinge_run(files.folder.path(),
                       {"run", "s.toml", "--script", "b.script", "--out", "b", "--frames", "8", "--no-images"});
  };
  CHECK(run_script("expect bodies == 5 && !(time_s > 1) at 8\nexpect dofs / 6 - 1 == 2 at 0\n").code == 0);
  const Outcome failed = run_script("expect bodies == 5 at 3\nexpect contacts > 1000 at 4\n");
  CHECK(failed.code == 1);
  CHECK(failed.err.rfind("b.script:2:1: frame 4: expected contacts > 1000; found contacts = ", 0) == 0);
  CHECK(table(files.folder / "b/stats.csv").size() == 9);
  const Outcome stopped = run_script("break when frame >= 5\n");
  CHECK(stopped.code == 1);
  CHECK(table(files.folder / "b/stats.csv").size() == 6);
  CHECK(run_script("expect bodies == 7 at 100\n").err.find("not checked") != std::string::npos);
}

TEST_CASE("a run that diverges keeps the frames before it and says where") {
  const Files files;
  files.folder.write("wild.toml",
                     "[simulation]\ngravity = [0, 1e4, 0]\nframe_time = 10\n[[body]]\nname = \"rocket\"\nkind = "
                     "\"dynamic\"\nshape = { sphere = { radius = 1 } }\n");
  const Outcome outcome =
      impinge_run(files.folder.path(), {"run", "wild.toml", "--out", "wild", "--frames", "100000", "--no-images"});
  CHECK(outcome.code == 3);
  CHECK(outcome.error_lines() == 1);
  CHECK(outcome.err.find("rocket") != std::string::npos);
  CHECK(outcome.err.find("frame ") != std::string::npos);
  CHECK(table(files.folder / "wild/stats.csv").size() > 2);
  CHECK_FALSE(fs::exists(files.folder / "wild/done"));
}

TEST_CASE("the same run may be made again in place, another may not") {
  const Files files;
  REQUIRE(impinge_run(files.folder.path(), files.run("out")).code == 0);
  const auto first = timeless(files.folder / "out/stats.csv");
  files.folder.write("out/notes.txt", "mine");
  CHECK(impinge_run(files.folder.path(), files.run("out")).code == 0);
  CHECK(timeless(files.folder / "out/stats.csv") == first);
  CHECK(slurp(files.folder / "out/notes.txt") == "mine");
  const Outcome other =
      impinge_run(files.folder.path(), files.run("out", {"--no-images", "--set", "contact.friction=0.1"}));
  CHECK(other.code == 2);
  CHECK(other.err.find("holds another run (its run.toml differs in contact.friction); ") != std::string::npos);
  CHECK(timeless(files.folder / "out/stats.csv") == first);
}

TEST_CASE("a finished run can be continued to more frames") {
  const Files files;
  const auto run = [&](const char* out, const char* frames, bool resume) {
    std::vector<std::string> words = {"run", "s.toml",   "--script", "a.script",    "--out",
                                      out,   "--frames", frames,     "--no-images", "--contacts"};
    if (resume) words.emplace_back("--resume");
    return impinge_run(files.folder.path(), words).code;
  };
  CHECK(run("whole", "30", false) == 0);
  CHECK(run("parts", "13", true) == 0);
  CHECK(run("parts", "30", false) == 2);
  CHECK(run("parts", "30", true) == 0);
  CHECK(run("parts", "13", true) == 2);
  for (const char* name : {"run.toml", "commands.log", "contacts.csv"})
    CHECK(slurp(files.folder / "whole" / name) == slurp(files.folder / "parts" / name));
  CHECK(timeless(files.folder / "whole/stats.csv") == timeless(files.folder / "parts/stats.csv"));
}

TEST_CASE("a run is not resumed from states that another version wrote, and what is there stays") {
  const Files files;
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", "s.toml", "--out", "a", "--no-images", "--frames", "9", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return impinge_run(files.folder.path(), words);
  };
  REQUIRE(run({}).code == 0);
  for (const auto& entry : fs::directory_iterator(files.folder / "a/snapshots")) {
    std::string bytes = slurp(entry.path());
    REQUIRE(bytes.rfind("impinge snapshot ", 0) == 0);
    std::ofstream(entry.path(), std::ios::binary) << bytes.replace(17, bytes.find('\n') - 17, "1");
  }
  const std::string before = slurp(files.folder / "a/stats.csv");
  const Outcome refused = run({"--resume"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("is a snapshot of version 1; one of version ") != std::string::npos);
  CHECK(slurp(files.folder / "a/stats.csv") == before);
  CHECK(run({}).code == 0);
}

TEST_CASE("a run that is killed at any moment resumes to the same bits") {
  const Files files;
  const auto words = [&](const std::string& out, bool resume) {
    std::vector<std::string> list = {"run", "s.toml",   "--script", "a.script",    "--out",
                                     out,   "--frames", "800",      "--no-images", "--contacts"};
    if (resume) list.emplace_back("--resume");
    return list;
  };
  double seconds = INFINITY;  // of the quicker of two: others may be at work
  for (const char* out : {"first", "whole"}) {
    const auto start = std::chrono::steady_clock::now();
    REQUIRE(impinge_run(files.folder.path(), words(out, false)).code == 0);
    seconds = std::min(seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  int stopped = 0;
  for (const int signal : {SIGKILL, SIGKILL, SIGINT}) {
    fs::remove_all(files.folder / "parts");
    for (int i = 1; i <= 4; ++i) {
      // all four together are less than the whole: on a machine whose speed changes the signals still fall inside
      const Outcome outcome =
          impinge_stopped(files.folder.path(), words("parts", true), seconds * (0.05 * i + 0.05), signal);
      if (outcome.code == 0) break;
      ++stopped;
      // an interrupt before main() runs ends the program as any other: a shell says 130 to both
      CHECK((outcome.code == -signal || (signal == SIGINT && outcome.code == 130)));
      CHECK_FALSE(fs::exists(files.folder / "parts/done"));
    }
    // what a kill in the middle of a write leaves, if it came after the run's first one
    if (fs::exists(files.folder / "parts/run.toml") && !fs::exists(files.folder / "parts/done")) {
      std::ofstream(files.folder / "parts/stats.csv", std::ios::app) << "799,6.6";
      std::ofstream(files.folder / "parts/contacts.csv", std::ios::app) << "799,floor,cr";
      std::ofstream(files.folder / "parts/snapshots/000790.bin") << "damaged";
    }
    const Outcome last = impinge_run(files.folder.path(), words("parts", true));
    INFO(last.err);
    CHECK(last.code == 0);
    for (const char* name : {"run.toml", "commands.log", "contacts.csv"})
      CHECK(slurp(files.folder / "whole" / name) == slurp(files.folder / "parts" / name));
    CHECK(timeless(files.folder / "whole/stats.csv") == timeless(files.folder / "parts/stats.csv"));
  }
  CHECK(stopped > 0);

  // at the end a signal may come after the mark and before the process is gone: what is marked must be whole by then
  for (const double part : {0.8, 0.9, 0.95, 1.0, 1.05}) {
    fs::remove_all(files.folder / "late");
    impinge_stopped(files.folder.path(), words("late", true), seconds * part, SIGKILL);
    if (!fs::exists(files.folder / "late/done"))
      REQUIRE(impinge_run(files.folder.path(), words("late", true)).code == 0);
    for (const char* name : {"run.toml", "commands.log", "contacts.csv"})
      CHECK(slurp(files.folder / "whole" / name) == slurp(files.folder / "late" / name));
    CHECK(timeless(files.folder / "whole/stats.csv") == timeless(files.folder / "late/stats.csv"));
  }
}

TEST_CASE("a run with pictures that is killed resumes to the same pixels, and pictures say what they show") {
  const Files files;
  const auto words = [&](const std::string& out) {
    return std::vector<std::string>{"run",      "s.toml", "--script", "a.script", "--out",   out,
                                    "--frames", "30",     "--size",   "96x54",    "--resume"};
  };
  const auto start = std::chrono::steady_clock::now();
  const Outcome whole = impinge_run(files.folder.path(), words("whole"));
  INFO(whole.err);
  REQUIRE(whole.code == 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const double part : {0.4, 0.6}) impinge_stopped(files.folder.path(), words("parts"), part * seconds, SIGKILL);
  REQUIRE(impinge_run(files.folder.path(), words("parts")).code == 0);
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(files.folder / "parts/frames")) {
    ++pictures;
    CHECK(slurp(entry.path()) == slurp(files.folder / "whole/frames" / entry.path().filename().string()));
  }
  CHECK(pictures == 31);
  CHECK(timeless(files.folder / "whole/stats.csv") == timeless(files.folder / "parts/stats.csv"));
  CHECK(impinge_run(files.folder.path(), {"diff", "whole", "parts", "--tolerance", "0"}).code == 0);
  CHECK(
      impinge_run(files.folder.path(), {"diff", "whole/frames/000000.png", "whole/frames/000030.png", "--out", "shown"})
          .code == 1);
  CHECK(fs::exists(files.folder / "shown/000000.png"));

  const std::string png = slurp(files.folder / "whole/frames/000014.png");
  for (const std::string& text :
       {std::string("impinge:scene") + '\0' + "s.toml", std::string("impinge:frame") + '\0' + "14",
        std::string("impinge:commands") + '\0' + "layer +normals -contacts",
        std::string("impinge:state_hash") + '\0' + table(files.folder / "whole/stats.csv")[14].at("state_hash"),
        std::string("impinge:renderer") + '\0'})
    CHECK(png.find(text) != std::string::npos);
  CHECK(png.find(files.folder.path().string()) == std::string::npos);

  // a picture that is missing in one of two folders is a difference
  fs::remove(files.folder / "parts/frames/000007.png");
  const Outcome missing = impinge_run(files.folder.path(), {"diff", "whole", "parts"});
  CHECK(missing.code == 1);
  CHECK(missing.out.find("000007.png: missing in parts") != std::string::npos);
  CHECK(missing.out.find("0 of 30 differ, 1 is missing in B; ") != std::string::npos);

  files.folder.write(
      "picture.script",
      "expect image whole/frames/000003.png tolerance 0 at 3\nexpect image whole/frames/000003.png at 25\n");
  const Outcome judged =
      impinge_run(files.folder.path(),
                  {"run", "s.toml", "--script", "picture.script", "--out", "judged", "--frames", "25", "--size",
                   "96x54", "--set", "contact.friction=0.5", "--set", "simulation.gravity=[0,-15,0]"});
  CHECK(judged.code == 1);
  CHECK(judged.err.find("picture.script:2:1: frame 25") != std::string::npos);
}

TEST_CASE("a full disk stops the run with a message, and what is there can be resumed") {
  // a limit on the size of files stands for the disk: stats.csv passes 12 kB after some 30 frames, and nothing else does
  const Files files;
  const std::string command = fmt::format(
      "cd {} && ulimit -f 12 && exec {} run s.toml --script a.script --out out --frames 60 --no-images 2> err",
      files.folder.path().string(), IMPINGE_PROGRAM);
  const int status = std::system(fmt::format("bash -c '{}'", command).c_str());
  CHECK(WEXITSTATUS(status) == 2);
  const std::string error = slurp(files.folder / "err");
  CHECK(error.rfind("out/stats.csv: can't be written (", 0) == 0);
  CHECK(std::count(error.begin(), error.end(), '\n') == 1);
  const std::size_t rows = table(files.folder / "out/stats.csv").size();
  CHECK(rows > 10);
  CHECK(rows < 60);
  const auto run = [&](const char* out) {
    return impinge_run(files.folder.path(), {"run", "s.toml", "--script", "a.script", "--out", out, "--frames", "60",
                                             "--no-images", "--resume"})
        .code;
  };
  CHECK(run("out") == 0);
  CHECK(run("whole") == 0);
  CHECK(timeless(files.folder / "out/stats.csv") == timeless(files.folder / "whole/stats.csv"));
}

TEST_CASE("the judge's columns are there only when asked for") {
  const Files files;
  files.folder.write("j.toml", R"([simulation]
gravity = [0, 0, 0]
[[body]]
name = "a"
kind = "dynamic"
shape = { sphere = { radius = 1 } }
[[body]]
name = "b"
kind = "static"
shape = { sphere = { radius = 1 } }
position = [1.75, 0, 0]
)");
  files.folder.write("j.script", "expect judged_penetration_m > 0.2 && judged_intersections == 0 at 0\n");
  REQUIRE(impinge_run(files.folder.path(), {"run", "j.toml", "--script", "j.script", "--out", "j", "--frames", "3",
                                            "--no-images", "--judge"})
              .code == 0);
  const std::string stats = slurp(files.folder / "j/stats.csv");
  CHECK(stats.substr(0, stats.find('\n'))
            .find(",state_hash,unconverged,asleep,judged_penetration_m,judged_intersections") != std::string::npos);
  CHECK(std::stod(table(files.folder / "j/stats.csv")[0].at("judged_penetration_m")) == Approx(0.25).epsilon(1e-12));
  CHECK(std::stod(table(files.folder / "j/stats.csv")[0].at("judged_depth_m")) == Approx(0.25).epsilon(1e-12));
  CHECK(impinge_run(files.folder.path(), {"replay", "j"}).code == 0);
  CHECK(impinge_run(files.folder.path(), {"check", "j.toml", "--script", "j.script"}).code == 0);
  const Outcome without = impinge_run(
      files.folder.path(), {"run", "j.toml", "--script", "j.script", "--out", "k", "--frames", "3", "--no-images"});
  CHECK(without.code == 2);
  CHECK(without.err.find("unknown figure 'judged_penetration_m'") != std::string::npos);
  REQUIRE(impinge_run(files.folder.path(), {"run", "j.toml", "--out", "k", "--frames", "1", "--no-images"}).code == 0);
  CHECK(slurp(files.folder / "k/stats.csv").find("judged") == std::string::npos);
}

TEST_CASE("without ffmpeg a run says so once, before its first picture, and makes the pictures all the same") {
  const Files files;
  fs::create_directory(files.folder / "bin");
  const std::string path = std::getenv("PATH") != nullptr ? std::getenv("PATH") : "/usr/bin:/bin";
  setenv("PATH", (files.folder / "bin").c_str(), 1);
  RunningProgram program(files.folder.path(),
                         {"run", "s.toml", "--out", "out", "--frames", "20", "--size", "64x48", "--video", "film.mp4"});
  bool told_first = false;
  while (!program.has_ended()) told_first |= !program.err().empty() && !fs::exists(files.folder / "out/done");
  const Outcome outcome = program.wait();
  setenv("PATH", path.c_str(), 1);
  INFO(outcome.err);
  CHECK(outcome.code == 0);
  CHECK(told_first);
  CHECK(outcome.err.starts_with("note: ffmpeg is not installed: "));
  CHECK(outcome.error_lines() == 1);
  CHECK(outcome.out.find("video") == std::string::npos);
  CHECK(fs::exists(files.folder / "out/frames/000020.png"));
  CHECK_FALSE(fs::exists(files.folder / "film.mp4"));
}
