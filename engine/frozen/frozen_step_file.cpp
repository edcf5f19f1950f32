#include "engine/frozen/frozen_step_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "engine/io/file.hpp"
#include "engine/io/little_endian.hpp"

namespace impinge {
namespace {

constexpr std::string_view kMagic = "impinge frozen step\n";
constexpr std::uint32_t kVersion = 5, kOldest = 2;
constexpr std::size_t kHead = kMagic.size() + 24;
constexpr std::uint64_t kMostBytes = std::uint64_t{8} << 30;

void put_side(LittleEndianWriter& out, const ContactSide& side) {
  out.put(std::int32_t{side.rigid}), out.put(std::int32_t{side.deformable}), out.put(side.arm);
  out.put_count(side.nodes.size());
  for (const NodeWeight& n : side.nodes) out.put(std::int32_t{n.node}), out.put(n.weight);
}

void put_group(LittleEndianWriter& out, const FrozenGroup& group) {
  const GroupSystem& system = group.system;
  out.put_count(system.rigid.size());
  for (std::size_t b = 0; b < system.rigid.size(); ++b) {
    const RigidBlock& block = system.rigid[b];
    out.put(std::int32_t{group.rigid_bodies[b]}), out.put(block.inverse_mass), out.put(block.inverse_inertia);
    out.put(block.velocity), out.put(block.angular_velocity), out.put(block.rounding);
  }
  out.put_count(system.deformable.size());
  for (std::size_t s = 0; s < system.deformable.size(); ++s) {
    const DeformableBlock& block = system.deformable[s];
    const BlockMatrix& a = group.matrices[s];
    out.put(std::int32_t{group.deformable_bodies[s]}), out.put(block.is_diagonal), out.put(block.displacement_scale);
    out.put_count(static_cast<std::size_t>(a.pattern->rows));
    for (const int begin : a.pattern->begin) out.put_count(static_cast<std::size_t>(begin));
    for (const int column : a.pattern->column) out.put_count(static_cast<std::size_t>(column));
    for (const Mat3& value : a.values) out.put(value);
    out.put(block.velocity), out.put(block.displacement_velocity);
  }
  out.put_count(system.contacts.size());
  for (std::size_t i = 0; i < system.contacts.size(); ++i) {
    const ContactRows& rows = system.contacts[i];
    const FrozenContact& at = group.geometry[i];
    out.put(static_cast<std::uint8_t>(rows.kind));
    for (const int index : {at.body_a.value(), at.body_b.value(), at.triangle_a.value(), at.triangle_b.value()})
      out.put(std::int32_t{index});
    out.put(at.point_a), out.put(at.point_b), out.put(at.feature);
    out.put(rows.directions), out.put(rows.surface), out.put(rows.gap), out.put(rows.bound), out.put(rows.friction);
    out.put(rows.restitution), out.put(rows.velocity_before), out.put(rows.scale.length), out.put(rows.scale.speed);
    out.put(system.lambda[i]), out.put(group.answer.lambda[i]);
    put_side(out, rows.a), put_side(out, rows.b);
  }
  for (std::size_t b = 0; b < system.rigid.size(); ++b)
    out.put(group.answer.delta_velocity[b]), out.put(group.answer.delta_angular_velocity[b]);
  for (const VecX& v : group.answer.deformable_delta) out.put(v);
}

class Reader {
 public:
  Reader(std::string name, std::string_view bytes, std::size_t at) : name_(std::move(name)), bytes_(bytes), at_(at) {}

  [[noreturn]] void fail(std::size_t at, const std::string& found, const std::string& allowed) const {
    throw InputError(
        fmt::format("{}: byte {}: {}; {}; write it anew with impinge run --freeze", name_, at, found, allowed));
  }
  template <class T>
  T get() {
    if (bytes_.size() - at_ < sizeof(T)) fail(bytes_.size(), "the file ends early", "a whole frozen step is wanted");
    const T value = little_endian_at<T>(bytes_, at_);
    if constexpr (std::is_floating_point_v<T>)
      if (!std::isfinite(value)) fail(at_, fmt::format("a number is {}", value), "finite numbers are wanted");
    at_ += sizeof(T);
    return value;
  }
  double positive(const char* what, bool or_zero) {
    const std::size_t at = at_;
    const double value = get<double>();
    if (!(value > 0.0 || (or_zero && value == 0.0)))
      fail(at, fmt::format("{} is {}", what, value), or_zero ? "0 or more is wanted" : "more than 0 is wanted");
    return value;
  }
  /// A number in [low, high).
  int index(const char* what, std::int64_t low, std::int64_t high) {
    const std::size_t at = at_;
    const auto value = get<std::int32_t>();
    if (value < low || value >= high)
      fail(at, fmt::format("{} is {}", what, value), fmt::format("{} to {} is wanted", low, high - 1));
    return value;
  }
  /// A number of things that take at least `size` bytes each: more than the file has room for are not believed.
  std::size_t count(const char* what, std::size_t size) {
    const std::size_t at = at_;
    const std::size_t n = get<std::uint32_t>();
    if (n > (bytes_.size() - at_) / size)
      fail(at, fmt::format("{} {}", n, what), "no more than the file has room for are wanted");
    return n;
  }
  std::string text() {
    const std::size_t n = count("letters", 1);
    at_ += n;
    return std::string(bytes_.substr(at_ - n, n));
  }
  Vec3 vec3() {
    const double x = get<double>(), y = get<double>(), z = get<double>();
    return {x, y, z};
  }
  Mat3 mat3() {
    Mat3 m;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) m(r, c) = get<double>();
    return m;
  }
  VecX numbers(std::size_t n) {
    VecX v(static_cast<Eigen::Index>(n));
    for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = get<double>();
    return v;
  }
  std::size_t at() const { return at_; }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::string name_;
  std::string_view bytes_;
  std::size_t at_;
};

BlockMatrix read_matrix(Reader& in) {
  const std::size_t n = in.count("free nodes", 4), start = in.at();
  std::vector<int> begin, column;
  for (std::size_t i = 0; i <= n; ++i)
    begin.push_back(in.index("a row's begin", i == 0 ? 0 : begin.back(), i == 0 ? 1 : std::int64_t{1} << 31));
  if (static_cast<std::size_t>(begin.back()) > n * n)
    in.fail(start, fmt::format("{} blocks", begin.back()), "a row has a block a column at most");
  for (std::size_t i = 0; i < n; ++i)
    for (int k = begin[i]; k < begin[i + 1]; ++k)
      column.push_back(
          in.index("a block's column", k == begin[i] ? 0 : column.back() + 1, static_cast<std::int64_t>(n)));
  BlockPattern pattern = block_pattern_of_rows(std::move(begin), std::move(column));
  for (const int at : pattern.diagonal)
    if (at < 0) in.fail(start, "a row without its diagonal block", "every row has one");
  for (const int at : pattern.mirror)
    if (at < 0) in.fail(start, "a block without its mirror image", "both triangles are wanted");
  BlockMatrix a(std::make_shared<const BlockPattern>(std::move(pattern)));
  for (Mat3& value : a.values) value = in.mat3();
  return a;
}

ContactSide read_side(Reader& in, const FrozenGroup& group) {
  ContactSide side;
  const std::size_t start = in.at();
  side.rigid = in.index("a side's rigid body", -1, static_cast<std::int64_t>(group.system.rigid.size()));
  side.deformable = in.index("a side's deformable body", -1, static_cast<std::int64_t>(group.matrices.size()));
  side.arm = in.vec3();
  const std::size_t nodes = in.count("nodes of a contact", 12);
  if ((side.rigid >= 0 && side.deformable >= 0) || (side.deformable < 0 && nodes > 0))
    in.fail(start, "a side with more than one body", "a rigid body, a deformable one or none is wanted");
  for (std::size_t k = 0; k < nodes; ++k) {
    const int node = in.index("a node", 0, group.matrices[side.deformable].pattern->rows);
    side.nodes.push_back({node, in.get<double>()});
  }
  return side;
}

void read_contact(Reader& in, std::uint32_t version, std::int64_t bodies, FrozenGroup& group) {
  ContactRows rows;
  FrozenContact at;
  const std::size_t start = in.at();
  const int kind = in.get<std::uint8_t>();
  if (kind > 2) in.fail(start, fmt::format("kind {}", kind), "0 to 2 is wanted");
  rows.kind = static_cast<RowKind>(kind);
  for (BodyIndex* body : {&at.body_a, &at.body_b}) *body = BodyIndex(in.index("a contact's body", -1, bodies));
  for (TriangleIndex* triangle : {&at.triangle_a, &at.triangle_b})
    *triangle = TriangleIndex(in.index("a triangle", -1, std::int64_t{1} << 31));
  at.point_a = in.vec3(), at.point_b = in.vec3(), at.feature = in.get<std::uint64_t>();
  rows.directions = in.mat3(), rows.surface = in.vec3(), rows.gap = in.get<double>(), rows.bound = in.get<double>();
  rows.friction = in.positive("friction", true);
  rows.restitution = in.positive("restitution", true), rows.velocity_before = in.get<double>();
  // before version 4 every threshold was a number
  if (version >= 4)
    rows.scale.length = in.positive("a length", false), rows.scale.speed = in.positive("a speed", false);
  group.system.lambda.push_back(in.vec3());
  group.answer.lambda.push_back(in.vec3());
  rows.a = read_side(in, group), rows.b = read_side(in, group);
  group.system.contacts.push_back(std::move(rows));
  group.geometry.push_back(at);
}

FrozenGroup read_group(Reader& in, std::uint32_t version, std::int64_t bodies) {
  FrozenGroup group;
  const std::size_t rigid = in.count("rigid bodies", version >= 5 ? 140 : 132);
  for (std::size_t b = 0; b < rigid; ++b) {
    group.rigid_bodies.emplace_back(in.index("a body", 0, bodies));
    RigidBlock block;
    block.inverse_mass = in.positive("1/m", false);
    block.inverse_inertia = in.mat3(), block.velocity = in.vec3(), block.angular_velocity = in.vec3();
    if (version >= 5) block.rounding = in.positive("a rounding", true);
    group.system.rigid.push_back(block);
  }
  const std::size_t deformable = in.count("deformable bodies", 17);
  for (std::size_t s = 0; s < deformable; ++s) {
    group.deformable_bodies.emplace_back(in.index("a body", 0, bodies));
    DeformableBlock block;
    block.is_diagonal = in.get<std::uint8_t>() != 0;
    block.displacement_scale = in.get<double>();
    group.matrices.push_back(read_matrix(in));
    const auto unknowns = static_cast<std::size_t>(group.matrices.back().rows());
    block.velocity = in.numbers(unknowns), block.displacement_velocity = in.numbers(unknowns);
    group.system.deformable.push_back(std::move(block));
  }
  const std::size_t contacts = in.count("contacts", version >= 4 ? 332 : 316);
  for (std::size_t i = 0; i < contacts; ++i) read_contact(in, version, bodies, group);
  for (std::size_t b = 0; b < rigid; ++b)
    group.answer.delta_velocity.push_back(in.vec3()), group.answer.delta_angular_velocity.push_back(in.vec3());
  for (const BlockMatrix& a : group.matrices)
    group.answer.deformable_delta.push_back(in.numbers(static_cast<std::size_t>(a.rows())));
  group.system.clear_delta();
  return group;
}

bool is_path(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  });
}

/// Lines `path = value`. What a value may be is known where the rows are.
std::vector<RowText> read_settings(Reader& in) {
  std::vector<RowText> settings;
  const std::size_t start = in.at();
  const std::string text = in.text();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos || !is_path(std::string_view(line).substr(0, equals)))
      in.fail(start + 4 + begin, "a setting of another form", "path = value is wanted");
    settings.emplace_back(line.substr(0, equals), line.substr(equals + 3));
    begin = end + 1;
  }
  return settings;
}

/// Of version 2, whose settings stood in an order of their own: by the paths that the rows had then.
std::vector<RowText> read_settings_2(Reader& in) {
  std::vector<RowText> settings;
  const auto text = [&](const char* path) { settings.emplace_back(path, in.text()); };
  const auto real = [&](const char* path) { settings.emplace_back(path, shortest(in.get<double>())); };
  const auto whole = [&](const char* path) {
    settings.emplace_back(path, std::to_string(in.index("a number of iterations", 0, std::int64_t{1} << 31)));
  };
  text("simulation.integrator"), text("simulation.linear_solver"), text("response.method"), text("response.form");
  text("response.stop"), text("lcp.method"), real("lcp.tolerance"), whole("lcp.max_iterations");
  whole("response.max_iterations"), real("contact.max_push_out"), real("contact.restitution_threshold");
  whole("response.impulse_iterations"), text("response.penalty_form"), real("response.penalty_stiffness");
  real("response.penalty_damping"), real("response.penalty_slip_speed"), real("response.soft_frequency");
  real("response.soft_damping_ratio"), whole("response.soft_iterations"), whole("response.soft_relax_iterations");
  return settings;
}

/// What is unknown to this build but one that others have gives way to the automatic one: the same answer to rounding.
LinearSolverChoice linear_solver_of(Reader& in, std::size_t at, std::vector<RowText>& settings) {
  for (auto& [path, value] : settings) {
    if (path != "simulation.linear_solver") continue;
    if (value == "cholmod" && find_entry(linear_solvers(), value) == nullptr) value = LinearSolverChoice().name();
    const std::vector<std::string> known = LinearSolverChoice().names();
    if (std::find(known.begin(), known.end(), value) == known.end())
      in.fail(at, fmt::format("linear solver '{}'", value), "see impinge list linear_solvers");
    return LinearSolverChoice(value);
  }
  return {};
}

}  // namespace

std::string format_frozen_step(const FrozenStep& step) {
  LittleEndianWriter out, head;
  out.put_text(step.scene), out.put(std::int32_t{step.frame}), out.put(step.time), out.put(step.time_step),
      out.put(step.gravity);
  std::string settings;
  for (const auto& [path, value] : step.settings) settings += fmt::format("{} = {}\n", path, value);
  out.put_text(settings);
  out.put_count(step.bodies.size());
  for (const std::string& name : step.bodies) out.put_text(name);
  out.put_count(step.groups.size());
  for (const FrozenGroup& group : step.groups) put_group(out, group);
  head.put(kVersion), head.put(std::uint32_t{0}), head.put(std::uint64_t{out.bytes().size()}),
      head.put(fnv1a(out.bytes()));
  return std::string(kMagic) + head.bytes() + out.bytes();
}

void write_frozen_step(const std::filesystem::path& path, const FrozenStep& step) {
  write_file(path, format_frozen_step(step));
}

FrozenStep read_frozen_step(const std::filesystem::path& path) {
  const std::string bytes = read_file(path, kMostBytes);
  Reader in(path.string(), bytes, std::min(kMagic.size(), bytes.size()));
  if (std::string_view(bytes).substr(0, kMagic.size()) != kMagic)
    in.fail(0, "the file is no frozen step", "'impinge frozen step' is wanted at its beginning");
  const auto version = in.get<std::uint32_t>();
  if (version < kOldest || version > kVersion)
    in.fail(kMagic.size(), fmt::format("version {} of the format", version),
            fmt::format("version {} to {} is wanted", kOldest, kVersion));
  if (in.get<std::uint32_t>() != 0) in.fail(kMagic.size() + 4, "the file is damaged", "0 is wanted here");
  const auto length = in.get<std::uint64_t>(), checksum = in.get<std::uint64_t>();
  if (bytes.size() - kHead != length)
    in.fail(std::min<std::uint64_t>(bytes.size(), kHead + length),
            bytes.size() - kHead < length ? "the file ends early" : "the file goes on behind its end",
            fmt::format("{} bytes behind the head are wanted, {} are there", length, bytes.size() - kHead));
  if (const std::uint64_t found = fnv1a(std::string_view(bytes).substr(kHead)); found != checksum)
    in.fail(kMagic.size() + 16, "the file is damaged",
            fmt::format("checksum {:016x} is wanted, {:016x} was found", checksum, found));

  FrozenStep step;
  step.scene = in.text(), step.frame = in.index("the frame", 0, std::int64_t{1} << 31), step.time = in.get<double>();
  step.time_step = in.positive("Δt", false), step.gravity = in.vec3();
  const std::size_t settings_at = in.at();
  step.settings = version > 2 ? read_settings(in) : read_settings_2(in);
  step.linear_solver = linear_solver_of(in, settings_at, step.settings);
  for (std::size_t n = in.count("bodies", 4); n > 0; --n) step.bodies.push_back(in.text());
  for (std::size_t n = in.count("groups", 12); n > 0; --n)
    step.groups.push_back(read_group(in, version, static_cast<std::int64_t>(step.bodies.size())));
  if (!in.at_end()) in.fail(in.at(), "more behind the last group", "the file ends there");
  return step;
}

bool is_frozen_step(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(kMagic.size(), '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return file.gcount() == static_cast<std::streamsize>(head.size()) && head == kMagic;
}

}  // namespace impinge
