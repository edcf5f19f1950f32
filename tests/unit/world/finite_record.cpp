// A frame with a figure that is no number is not published, and the figure is named.
#include <catch2/catch.hpp>

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/response/group_judge.hpp"
#include "engine/world/finite_record.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/pictures/hand_made_record.hpp"
#include "viewer/tables/stats_table.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

template <class F>
std::string divergence(F act) {
  try {
    act();
  } catch (const DivergenceError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& word) { return text.find(word) != std::string::npos; }

}  // namespace

TEST_CASE("each figure of stats.csv and contacts.csv that is no number is refused by its column's name") {
  HandMadeRecord made;
  const int floor = made.add("floor", BodyKind::fixed, Box{Vec3(1, 1, 1)}, Vec3::Zero());
  const int crate = made.add("crate", BodyKind::dynamic, Box{Vec3(1, 1, 1)}, Vec3(0, 2, 0));
  StepRecord good = made.record();
  good.stats.frame = 7;
  good.contacts.emplace_back();
  good.contacts[0].body_a = BodyIndex(floor), good.contacts[0].body_b = BodyIndex(crate);
  Bodies none;
  check_finite(good, none);

  const std::vector<std::string>& columns = figure_names(false);
  std::vector<double FrameStats::*> numbers = {&FrameStats::time,      &FrameStats::max_penetration,
                                               &FrameStats::residual,  &FrameStats::kinetic,
                                               &FrameStats::potential, &FrameStats::elastic};
  const char* names[] = {"time_s", "max_penetration_m", "residual", "kinetic_J", "potential_J", "elastic_J"};
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL}) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      StepRecord record = good;
      record.stats.*numbers[i] = bad;
      CHECK(contains(divergence([&] { check_finite(record, none); }), fmt::format("frame 7: {} is ", names[i])));
      CHECK(std::count(columns.begin(), columns.end(), names[i]) == 1);
    }
    for (int k = 0; k < 3; ++k) {
      StepRecord record = good;
      record.stats.momentum[k] = bad;
      CHECK(contains(divergence([&] { check_finite(record, none); }), fmt::format("frame 7: momentum_{} ", "xyz"[k])));
      record = good;
      record.stats.angular_momentum[k] = bad;
      CHECK(contains(divergence([&] { check_finite(record, none); }), fmt::format(": angular_momentum_{} ", "xyz"[k])));
    }
    const auto check_contact = [&](const std::string& column, auto spoil) {
      StepRecord record = good;
      spoil(record.contacts[0]);
      const std::string message = divergence([&] { check_finite(record, none); });
      CAPTURE(message, column);
      CHECK(contains(message, fmt::format("frame 7, body 'crate': {} of a contact with 'floor' is ", column)));
    };
    check_contact("gap_m", [&](ContactRecord& c) { c.gap = bad; });
    check_contact("gap0_m", [&](ContactRecord& c) { c.gap0 = bad; });
    check_contact("mu", [&](ContactRecord& c) { c.friction = bad; });
    check_contact("pa_y", [&](ContactRecord& c) { c.point_a.y() = bad; });
    check_contact("pb_z", [&](ContactRecord& c) { c.point_b.z() = bad; });
    check_contact("n_x", [&](ContactRecord& c) { c.normal.x() = bad; });
    check_contact("lambda_n", [&](ContactRecord& c) { c.lambda.x() = bad; });
    check_contact("lambda_t1", [&](ContactRecord& c) { c.lambda.y() = bad; });
    check_contact("lambda_t2", [&](ContactRecord& c) { c.lambda.z() = bad; });
  }
  // what is not of the model has the table's own check, for any column
  FrameStats judged = good.stats;
  judged.judged_penetration = HUGE_VAL;
  CHECK(contains(divergence([&] { check_figures(judged, true); }), "frame 7: judged_penetration_m is inf"));
  CHECK(divergence([&] { check_figures(judged, false); }).empty());
}

TEST_CASE("a frame whose energy overflows is not published, the one before stays, and the body is named") {
  World world;
  world.parameters.simulation.gravity.setZero();
  world.add_body(cube("light", 1.0, Vec3(0, 0, 0)));
  world.add_body(cube("heavy", 1.0, Vec3(5, 0, 0)));
  world.start();
  world.step();
  world.bodies()[1].mass = 1e300;
  rigid(world, 1).velocity = Vec3(1e10, 0, 0);
  const std::string message = divergence([&] { world.step(); });
  CAPTURE(message);
  CHECK(contains(message, "frame 2, body 'heavy': kinetic_J is inf"));
  CHECK(world.record().stats.frame == 1);
  CHECK(world.record().stats.kinetic == 0.0);
  CHECK(world.record().bodies.size() == 2);
}

TEST_CASE("a box as thin as no scene may have it still has finite energies") {
  World world;
  BodyDescription d = dynamic_body("speck", Box{Vec3(5e-201, 0.5, 0.5)}, Vec3::Zero());
  d.angular_velocity = Vec3(1, 2, 3);
  world.add_body(d);
  world.start();
  run(world, 2);
  CHECK(std::isfinite(world.record().stats.kinetic));
  CHECK(world.record().stats.kinetic > 0.0);
}

TEST_CASE("a turn that can't be followed names frame and body") {
  World world;
  BodyDescription d = dynamic_body("top", Box{Vec3(0.1, 0.2, 0.3)}, Vec3::Zero());
  d.angular_velocity = Vec3(1e12, 1e12, 0);
  world.add_body(d);
  world.start();
  const std::string message = divergence([&] { world.step(); });
  CAPTURE(message);
  CHECK(contains(message, "frame 1, group -1, body 'top': it turns by "));
  CHECK(world.record().stats.frame == 0);
}

TEST_CASE("the judge doesn't lose what is no number") {
  GroupSystem group;
  group.rigid.push_back({1.0, Mat3::Identity(), Vec3::Zero(), Vec3::Zero()});
  for (int i = 0; i < 2; ++i) {
    ContactRows rows;
    rows.directions = Mat3::Identity();
    rows.a.rigid = 0;
    group.contacts.push_back(rows);
  }
  group.lambda.assign(2, Vec3::Zero());
  group.clear_delta();
  CHECK(judge_group(group).residual() == 0.0);
  group.lambda[0].x() = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(judge_group(group).residual()));
  group.lambda[0].setZero();
  group.delta_velocity[0] = Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0);
  CHECK(std::isnan(judge_group(group).residual()));
}
