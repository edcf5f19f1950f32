#include "engine/world/step_record_archive.hpp"

#include <algorithm>

#include "engine/world/figures.hpp"

namespace impinge {
namespace {

std::size_t get_count(ByteReader& in, std::size_t least_bytes) {
  const auto count = in.get<std::uint64_t>();
  if (count * least_bytes > in.left() || count > in.left())
    throw InputError("snapshot: ends early; it is damaged, remove it and run again");
  return static_cast<std::size_t>(count);
}

template <class Of>
void put_index(ByteWriter& out, Index<Of> index) {
  out.put(index.value());
}

BodyIndex get_body(ByteReader& in, const StepRecord& record) {
  const BodyIndex body(in.get<int>());
  if (body < 0 || body >= static_cast<int>(record.bodies.size()))
    throw InputError("snapshot: it names a body that the scene has not; remove it and run again");
  return body;
}

/// By pair of bodies, since there may be thousands of triangles of each.
void put_triangle_pairs(ByteWriter& out, const std::vector<TrianglePair>& pairs) {
  out.put<std::uint64_t>(pairs.size());
  for (std::size_t i = 0; i < pairs.size();) {
    std::size_t end = i;
    while (end < pairs.size() && pairs[end].a == pairs[i].a && pairs[end].b == pairs[i].b) ++end;
    put_index(out, pairs[i].a), put_index(out, pairs[i].b), out.put<std::uint64_t>(end - i);
    for (; i < end; ++i)
      put_index(out, pairs[i].triangle_a),
          out.put(2 * static_cast<std::int64_t>(pairs[i].triangle_b) + (pairs[i].intersecting ? 1 : 0));
  }
}

void get_triangle_pairs(ByteReader& in, StepRecord& record) {
  std::vector<TrianglePair>& pairs = record.triangle_pairs;
  pairs.resize(get_count(in, 12));
  for (std::size_t i = 0; i < pairs.size();) {
    const BodyIndex a = get_body(in, record), b = get_body(in, record);
    const auto count = in.get<std::uint64_t>();
    if (count == 0 || count > pairs.size() - i)
      throw InputError("snapshot: its pairs of triangles don't add up; it is damaged, remove it and run again");
    for (const std::size_t end = i + count; i < end; ++i) {
      const TriangleIndex triangle_a(in.get<int>());
      const auto packed = in.get<std::int64_t>();
      pairs[i] = {a, b, triangle_a, TriangleIndex(packed >> 1), (packed & 1) != 0};
    }
  }
}

void put_contact(ByteWriter& out, const ContactRecord& c) {
  put_index(out, c.body_a), put_index(out, c.body_b), put_index(out, c.triangle_a), put_index(out, c.triangle_b);
  out.put(c.point_a), out.put(c.point_b), out.put(c.normal);
  out.put(c.gap), out.put(c.gap0), out.put(c.lambda), out.put(c.friction);
  out.put(static_cast<std::uint8_t>(c.state)), put_index(out, c.group), out.put(c.pair_id);
  out.put(c.residual);
}

ContactRecord get_contact(ByteReader& in, const StepRecord& record) {
  ContactRecord c;
  c.body_a = get_body(in, record), c.body_b = get_body(in, record);
  c.triangle_a = TriangleIndex(in.get<int>()), c.triangle_b = TriangleIndex(in.get<int>());
  c.point_a = in.get_vec3(), c.point_b = in.get_vec3(), c.normal = in.get_vec3();
  c.gap = in.get<double>(), c.gap0 = in.get<double>(), c.lambda = in.get_vec3(), c.friction = in.get<double>();
  c.state = static_cast<ContactState>(std::min<int>(in.get<std::uint8_t>(), static_cast<int>(ContactState::slip)));
  c.group = GroupIndex(in.get<int>()), c.pair_id = in.get<std::uint64_t>();
  c.residual = in.get<double>();
  return c;
}

}  // namespace

void put_record(ByteWriter& out, const StepRecord& record) {
  put_figures(out, record.stats);
  out.put<std::uint64_t>(record.broad_pairs.size());
  for (const BodyPair& pair : record.broad_pairs) put_index(out, pair.a), put_index(out, pair.b), out.put(pair.margin);
  put_triangle_pairs(out, record.triangle_pairs);
  out.put<std::uint64_t>(record.contacts.size());
  for (const ContactRecord& contact : record.contacts) put_contact(out, contact);
  out.put<std::uint64_t>(record.attachments.size());
  for (const AttachmentRecord& attachment : record.attachments) out.put(attachment.impulse);
  out.put<std::uint64_t>(record.groups.size());
  for (const std::vector<BodyIndex>& group : record.groups) {
    out.put<std::uint64_t>(group.size());
    for (const BodyIndex body : group) put_index(out, body);
  }
}

void get_record(ByteReader& in, StepRecord& record) {
  get_figures(in, record.stats);
  record.broad_pairs.resize(get_count(in, 16));
  for (BodyPair& pair : record.broad_pairs)
    pair.a = get_body(in, record), pair.b = get_body(in, record), pair.margin = in.get<double>();
  get_triangle_pairs(in, record);
  record.contacts.resize(get_count(in, 157));
  for (ContactRecord& contact : record.contacts) contact = get_contact(in, record);
  if (get_count(in, 24) != record.attachments.size())
    throw InputError("snapshot: it belongs to a scene with another number of attachments");
  for (AttachmentRecord& attachment : record.attachments) attachment.impulse = in.get_vec3();
  record.groups.resize(get_count(in, 8));
  for (BodyRecord& body : record.bodies) body.group = {};
  for (std::size_t g = 0; g < record.groups.size(); ++g) {
    record.groups[g].resize(get_count(in, 4));
    for (BodyIndex& body : record.groups[g]) {
      body = get_body(in, record);
      record.bodies[body].group = GroupIndex(g);
    }
  }
}

}  // namespace impinge
