#include "viewer/state/tracks.hpp"

#include <algorithm>
#include <limits>

namespace impinge {
namespace {

constexpr std::size_t kMostBytes = std::size_t{128} << 20;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::optional<BodyIndex> body_of(std::string_view name, const std::vector<std::string>& bodies) {
  while (name.starts_with(' ')) name.remove_prefix(1);
  while (name.ends_with(' ')) name.remove_suffix(1);
  const auto it = std::find(bodies.begin(), bodies.end(), name);
  if (it == bodies.end()) return std::nullopt;
  return BodyIndex(it - bodies.begin());
}

/// What stands behind its parenthesis, the other one at the end.
std::optional<Quantity> parse_energy_from(std::string_view text, const std::vector<std::string>& bodies) {
  text.remove_suffix(1);
  const std::size_t comma = text.find(',');
  const std::optional<LedgerSource> source = find_ledger_source(text.substr(0, comma));
  if (!source) return std::nullopt;
  Quantity quantity{BodyFunction::energy_from, {}, {}, *source};
  if (comma == std::string_view::npos) return quantity;
  const std::optional<BodyIndex> body = body_of(text.substr(comma + 1), bodies);
  if (!body) return std::nullopt;
  quantity.a = *body;
  return quantity;
}

}  // namespace

std::optional<Quantity> parse_quantity(std::string_view text, const std::vector<std::string>& bodies) {
  const std::size_t open = text.find('(');
  if (open == std::string_view::npos || !text.ends_with(')')) return std::nullopt;
  const std::span<const BodyFigure> all = body_figures();
  const auto figure =
      std::find_if(all.begin(), all.end(), [&](const BodyFigure& f) { return f.name == text.substr(0, open); });
  if (figure == all.end() || !figure->in_plots()) return std::nullopt;
  if (figure->function == BodyFunction::energy_from) return parse_energy_from(text.substr(open + 1), bodies);
  const std::string_view inner = text.substr(open + 1, text.size() - open - 2);
  const std::size_t comma = inner.find(',');
  Quantity quantity{figure->function, {}, {}};
  const std::optional<BodyIndex> a = body_of(inner.substr(0, comma), bodies);
  if (!a) return std::nullopt;
  quantity.a = *a;
  if (comma == std::string_view::npos) return quantity;
  const std::optional<BodyIndex> b = body_of(inner.substr(comma + 1), bodies);
  if (!b || figure->bodies != 2) return std::nullopt;
  quantity.b = *b;
  if (quantity.b < quantity.a) std::swap(quantity.a, quantity.b);
  return quantity;
}

void Tracks::Touch::take(const ContactRecord& contact) {
  gap = contacts == 0 ? contact.gap : std::min(gap, contact.gap);
  ++contacts;
  impulse += contact.lambda.x();
}

std::size_t Tracks::Frame::bytes() const {
  constexpr std::size_t kNode = 48;  // what a map adds to each
  std::size_t vertices = 0;
  for (const OfBody& body : bodies) vertices += body.surface.size();
  return vertices * sizeof(Eigen::Vector3f) + bodies.size() * sizeof(OfBody) +
         (ledger ? ledger->bodies.size() * sizeof(BodyLedger) : 0) +
         (touched.size() + pairs.size()) * (sizeof(Touch) + kNode);
}

void Tracks::note(const StepRecord& record) {
  Frame frame;
  frame.substep_time = record.stats.substeps > 0 ? record.frame_time / record.stats.substeps : 0.0;
  for (const BodyRecord& body : record.bodies) {
    OfBody& own = frame.bodies.emplace_back(OfBody{body.pose, body.velocity, !body.deleted, body.asleep, {}});
    if (!keeps_surfaces_ || body.deformable == nullptr) continue;
    for (const Vec3& x : body.vertices) own.surface.push_back((x - body.pose.position).cast<float>());
  }
  for (const ContactRecord& c : record.contacts) {
    frame.touched[c.body_a].take(c);
    if (c.body_a != c.body_b) frame.touched[c.body_b].take(c);
    frame.pairs[{std::min(c.body_a, c.body_b), std::max(c.body_a, c.body_b)}].take(c);
  }
  Frame& kept = frames_[record.stats.frame];
  frame.ledger = record.stats.ledger ? record.stats.ledger : kept.ledger;  // a frame that was brought back has none
  if (frame.ledger != kept.ledger && record.stats.frame <= sum_.last) sum_ = {};
  bytes_ -= kept.bytes();
  kept = std::move(frame);
  bytes_ += kept.bytes();
  while (bytes_ > kMostBytes && frames_.size() > 1) {
    const auto oldest = frames_.begin()->first == record.stats.frame ? std::next(frames_.begin()) : frames_.begin();
    bytes_ -= oldest->second.bytes();
    frames_.erase(oldest);
  }
}

void Tracks::forget_after(int frame) {
  if (frame < sum_.last) sum_ = {};
  for (auto it = frames_.upper_bound(frame); it != frames_.end(); it = frames_.erase(it)) bytes_ -= it->second.bytes();
}

double Tracks::value(int number, const Quantity& quantity) const {
  const auto it = frames_.find(number);
  if (it == frames_.end()) return kNone;
  const Frame& frame = it->second;
  if (quantity.what == BodyFunction::energy_from)
    return impinge::energy_from(frame.ledger.get(), quantity.source, quantity.a.value());
  const auto body = static_cast<std::size_t>(quantity.a.value());
  if (info_of(quantity.what).bodies == 1)
    return frame.has(quantity.a)
               ? part_of_motion(quantity.what, frame.bodies[body].pose.position, frame.bodies[body].velocity)
               : kNone;
  const Touch* touch = nullptr;
  if (quantity.b.is_none()) {
    if (const auto of = frame.touched.find(quantity.a); of != frame.touched.end()) touch = &of->second;
  } else if (const auto of = frame.pairs.find({quantity.a, quantity.b}); of != frame.pairs.end()) {
    touch = &of->second;
  }
  switch (quantity.what) {
    case BodyFunction::contacts:
      return touch == nullptr ? 0.0 : touch->contacts;
    case BodyFunction::gap:
      return touch == nullptr ? kNone : touch->gap;
    case BodyFunction::depth:
      return touch == nullptr ? 0.0 : std::max(0.0, -touch->gap);
    default:
      return touch == nullptr ? 0.0 : frame.substep_time > 0.0 ? touch->impulse / frame.substep_time : kNone;
  }
}

const FrameLedger* Tracks::ledger(int frame) const {
  const auto it = frames_.find(frame);
  return it == frames_.end() ? nullptr : it->second.ledger.get();
}

const Tracks::LedgerSum& Tracks::ledger_sum(int frame) const {
  if (sum_.last > frame) sum_ = {};
  for (auto it = frames_.upper_bound(sum_.last); it != frames_.end() && it->first <= frame; ++it) {
    if (!it->second.ledger) continue;
    const std::vector<BodyLedger>& bodies = it->second.ledger->bodies;
    sum_.books.bodies.resize(bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) sum_.books.bodies[b] += bodies[b];
    ++sum_.frames;
  }
  sum_.last = frame;
  return sum_;
}

std::optional<Pose> Tracks::pose(int frame, BodyIndex body) const {
  const auto it = frames_.find(frame);
  if (it == frames_.end() || !it->second.has(body)) return std::nullopt;
  return it->second.bodies[static_cast<std::size_t>(body.value())].pose;
}

int Tracks::asleep_since(int frame, BodyIndex body) const {
  const auto i = static_cast<std::size_t>(body.value());
  for (auto it = frames_.find(frame - 1); it != frames_.end() && it->second.has(body) && it->second.bodies[i].asleep;
       it = frames_.find(frame - 1))
    --frame;
  return frame;
}

std::vector<Vec3> Tracks::surface(int frame, BodyIndex body) const {
  std::vector<Vec3> vertices;
  const auto it = frames_.find(frame);
  if (it == frames_.end() || !it->second.has(body)) return vertices;
  const OfBody& own = it->second.bodies[static_cast<std::size_t>(body.value())];
  for (const Eigen::Vector3f& x : own.surface) vertices.push_back(own.pose.position + x.cast<double>());
  return vertices;
}

}  // namespace impinge
