// The pile of a thousand boxes, and ten thousand spheres, at a frame rate, beside Bullet's.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "engine/core/parallel.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/pile.hpp"
#include "tests/support/median.hpp"
#include "tests/support/program/bench_arguments.hpp"

#ifdef IMPINGE_HAS_BULLET
#include <btBulletDynamicsCommon.h>
#endif

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kFrame = 1.0 / 60.0, kFriction = 0.3;

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void add_scene(World& world, const std::string& scene, int bodies) {
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = 1;
  world.parameters.simulation.frame_time = kFrame;
  world.parameters.contact.friction = kFriction;
  Random random(4242);
  if (scene == "planes") {
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    add_pile(world, random, bodies);
    return;
  }
  const double side = scene == "spheres" ? 0.3 * std::sqrt(0.05 * bodies) + 0.3 : 3.2;
  const auto wall = [&](const char* name, const Vec3& half, const Vec3& at) {
    BodyDescription d = dynamic_body(name, Box{half}, at);
    d.kind = BodyKind::fixed;
    world.add_body(d);
  };
  wall("floor", Vec3(side + 1, 0.5, side + 1), Vec3(0, -0.5, 0));
  if (scene == "walls") {
    for (int k = 0; k < bodies; ++k) {
      const Vec3 at =
          Vec3(0.6 * (k % 10) - 2.7, 0.6 * (k / 100) + 0.35, 0.6 * (k / 10 % 10) - 2.7) + 0.02 * random.vector();
      BodyDescription box = cube("box" + std::to_string(k), 0.5, at);
      box.mass = 1.0;
      box.rotation = 16.5 * random.vector();
      world.add_body(box);
    }
  } else {
    const int row = static_cast<int>(2.0 * side / 0.45);
    for (int k = 0; k < bodies; ++k) {
      BodyDescription ball = dynamic_body(
          "ball" + std::to_string(k), Sphere{0.15},
          Vec3(0.45 * (k % row) - side + 0.25, 0.4 * (k / (row * row)) + 0.2, 0.45 * (k / row % row) - side + 0.25) +
              0.02 * random.vector());
      ball.mass = 1.0;
      world.add_body(ball);
    }
  }
  const double high = 30.0;
  wall("left", Vec3(0.5, high, side + 1), Vec3(-side - 0.5, high, 0));
  wall("right", Vec3(0.5, high, side + 1), Vec3(side + 0.5, high, 0));
  wall("back", Vec3(side + 1, high, 0.5), Vec3(0, high, -side - 0.5));
  wall("front", Vec3(side + 1, high, 0.5), Vec3(0, high, side + 0.5));
}

struct Run {
  std::vector<double> ms;
  double worst = 0.0, end = 0.0, speed = 0.0;  // overlap over the run and at its end, m; m/s
  std::vector<double> residual;
  StageTimes times;
};

struct Watch {
  Run& run;
  int frames;
  /// The judge looks at all pairs: not in every frame.
  void look(const Bodies& bodies, int frame) const {
    if ((frame % 5 != 4 || frame < 15) && frame + 1 != frames) return;
    const double depth = judge_overlap(bodies).penetration;
    run.worst = std::max(run.worst, depth);
    if (frame + 1 == frames) run.end = depth;
  }
};

/// "path=value,path=value".
std::vector<RowText> rows_in(const std::string& list) {
  std::vector<RowText> rows;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');)
    rows.emplace_back(word.substr(0, word.find('=')), word.substr(word.find('=') + 1));
  return rows;
}

std::string rows_fault(const std::string& list) {
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');)
    if (std::string fault = row_fault(word); !fault.empty()) return fault;
  return "";
}

std::string quick_fault(const std::string& method) {
  const std::size_t colon = method.find(':');
  std::vector<std::string> names = names_of(responses());
#ifdef IMPINGE_HAS_BULLET
  names.emplace_back("bullet");
#endif
  std::string fault = one_of(names)(method.substr(0, colon));
  if (fault.empty() && colon != std::string::npos) fault = whole_number_fault(method.substr(colon + 1));
  return fault;
}

Run run_ours(const std::string& scene, int bodies, int frames, const std::string& method, const std::string& rows,
             bool judges) {
  World world;
  const std::size_t colon = method.find(':');
  add_scene(world, scene, bodies);
  if (colon != std::string::npos) world.parameters.simulation.substeps = std::atoi(method.c_str() + colon + 1);
  world.parameters.response.method = method.substr(0, colon);
  for (const auto& [path, value] : rows_in(rows)) set(world, path, value);
  world.start();
  Run run;
  const Watch watch{run, frames};
  for (int i = 0; i < frames; ++i) {
    const double begin = now_ms();
    world.step();
    run.ms.push_back(now_ms() - begin);
    const FrameStats& stats = world.record().stats;
    run.residual.push_back(stats.residual_coulomb);
    run.times.broad_ms += stats.times.broad_ms / frames, run.times.narrow_ms += stats.times.narrow_ms / frames;
    run.times.assemble_ms += stats.times.assemble_ms / frames,
        run.times.response_ms += stats.times.response_ms / frames;
    run.times.integrate_ms += stats.times.integrate_ms / frames;
    if (judges) watch.look(world.bodies(), i);
  }
  for (const Body& b : world.bodies())
    if (b.kind() == BodyKind::dynamic) run.speed = std::max(run.speed, b.fastest_point());
  return run;
}

#ifdef IMPINGE_HAS_BULLET
/// The world's bodies in Bullet, each by its own shape.
class Bullet {
 public:
  Bullet(World& world, int iterations) : world_(world) {
    dynamics_.setGravity(btVector3(0, -9.81, 0));
    dynamics_.getSolverInfo().m_numIterations = iterations;
    for (const Body& body : world.bodies()) {
      std::unique_ptr<btCollisionShape> shape;
      btTransform at = btTransform::getIdentity();
      if (const auto* plane = body.shape->as<Plane>()) {
        shape = std::make_unique<btStaticPlaneShape>(vector(plane->normal), plane->offset);
      } else {
        if (const auto* box = body.shape->as<Box>())
          shape = std::make_unique<btBoxShape>(vector(box->half));
        else
          shape = std::make_unique<btSphereShape>(body.shape->as<Sphere>()->radius);
        const Eigen::Quaterniond q(body.pose.rotation);
        at = btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), vector(body.pose.position));
      }
      const bool moves = body.kind() == BodyKind::dynamic;
      btVector3 inertia(0, 0, 0);
      if (moves) shape->calculateLocalInertia(body.mass, inertia);
      btRigidBody::btRigidBodyConstructionInfo info(moves ? body.mass : 0.0, nullptr, shape.get(), inertia);
      info.m_startWorldTransform = at;
      info.m_friction = std::sqrt(kFriction);  // Bullet multiplies those of a pair
      bodies_.push_back(std::make_unique<btRigidBody>(info));
      bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
      shapes_.push_back(std::move(shape));
      dynamics_.addRigidBody(bodies_.back().get());
    }
  }
  ~Bullet() {
    for (const auto& body : bodies_) dynamics_.removeRigidBody(body.get());
  }

  void step() { dynamics_.stepSimulation(kFrame, 0); }
  /// The world's bodies where Bullet's are.
  const Bodies& placed() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i]->isStaticObject()) continue;
      const btTransform& at = bodies_[i]->getWorldTransform();
      Body& body = world_.bodies()[static_cast<int>(i)];
      const btQuaternion q = at.getRotation();
      body.pose.rotation = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
      body.pose.position = Vec3(at.getOrigin().x(), at.getOrigin().y(), at.getOrigin().z());
    }
    return world_.bodies();
  }
  double speed() const {
    double fastest = 0.0;
    for (const auto& b : bodies_)
      if (!b->isStaticObject())
        fastest = std::max<double>(
            fastest, b->getLinearVelocity().length() + b->getAngularVelocity().length() * 0.5 * std::sqrt(0.75));
    return fastest;
  }

 private:
  static btVector3 vector(const Vec3& v) {
    return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
  }
  World& world_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld dynamics_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

Run run_bullet(const std::string& scene, int bodies, int frames, int iterations, bool judges) {
  World world;
  add_scene(world, scene, bodies);
  world.start();
  Bullet bullet(world, iterations);
  Run run;
  const Watch watch{run, frames};
  for (int i = 0; i < frames; ++i) {
    const double begin = now_ms();
    bullet.step();
    run.ms.push_back(now_ms() - begin);
    if (judges && (i % 5 == 4 || i + 1 == frames)) watch.look(bullet.placed(), i);
  }
  run.speed = bullet.speed();
  return run;
}
#endif

double mean(const std::vector<double>& of) {
  double sum = 0.0;
  for (const double v : of) sum += v;
  return of.empty() ? 0.0 : sum / static_cast<double>(of.size());
}

}  // namespace

int main(int argc, char** argv) {
  std::string scene = "planes";
  int bodies = 1000, frames = 300, rounds = 3, threads = thread_count();
  std::string rows;
  std::vector<std::string> methods = {"quick"};
#ifdef IMPINGE_HAS_BULLET
  methods.insert(methods.begin(), "bullet");
#endif
  BenchArguments arguments(
      "bench_quick",
      "The pile of a thousand boxes, and ten thousand spheres, at a frame rate: ms of a whole step (wall)\n"
      "beside Bullet's in the same run, the worst overlap by the judge over the run and at its end, speeds\n"
      "at the end. One sub-step of 1/60 s, friction 0.3, restitution 0, nothing sleeps. Bullet is run as it\n"
      "comes (btSequentialImpulseConstraintSolver, 10 iterations or as given, split impulses, one thread),\n"
      "if it was found when this was built.");
  arguments.word("scene", scene, one_of({"planes", "walls", "spheres"}), "boxes between planes or walls, or spheres");
  arguments.number("bodies", bodies, {1}, "how many");
  arguments.number("frames", frames, {1}, "of 1/60 s");
  arguments.number("rounds", rounds, {1}, "all methods in turn, so often");
  arguments.words("method", methods, quick_fault, "a response[:substeps] or bullet[:iterations]");
  arguments.number("--threads", threads, {1}, "how many");
  arguments.word("--rows", rows, rows_fault,
                 "path=value, with commas between: parameters of our runs; none unless given");
  arguments.read_or_exit(argc, argv);
  set_thread_count(threads);
  std::vector<std::vector<double>> means(methods.size());
  std::printf(
      "%s, %d bodies, %d frames\n%-28s %9s %9s %9s %10s %10s %9s %9s   stages ms (broad narrow assemble response "
      "integrate)\n",
      scene.c_str(), bodies, frames, "", "mean ms", "median", "most", "worst m", "end m", "m/s", "residual");
  for (int round = 0; round < rounds; ++round)
    for (std::size_t m = 0; m < methods.size(); ++m) {
      Run run;
      const bool judges = round + 1 == rounds && bodies <= 2000;
#ifdef IMPINGE_HAS_BULLET
      if (methods[m].starts_with("bullet"))
        run = run_bullet(scene, bodies, frames, methods[m].size() > 7 ? std::atoi(methods[m].c_str() + 7) : 10, judges);
      else
#endif
        run = run_ours(scene, bodies, frames, methods[m], rows, judges);
      means[m].push_back(mean(run.ms));
      std::printf("%-28s %9.2f %9.2f %9.2f %10.1e %10.1e %9.1e %9.1e   %.2f %.2f %.2f %.2f %.2f\n", methods[m].c_str(),
                  means[m].back(), median(run.ms), *std::max_element(run.ms.begin(), run.ms.end()), run.worst, run.end,
                  run.speed, median(run.residual), run.times.broad_ms, run.times.narrow_ms, run.times.assemble_ms,
                  run.times.response_ms, run.times.integrate_ms);
      std::fflush(stdout);
    }
  for (std::size_t m = 1; m < methods.size(); ++m) {
    std::vector<double> ratios;
    for (int r = 0; r < rounds; ++r) ratios.push_back(means[m][r] / means[0][r]);
    std::printf("%s / %s: %.2f (median of %d pairs)\n", methods[m].c_str(), methods[0].c_str(), median(ratios), rounds);
  }
}
