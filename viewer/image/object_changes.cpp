#include "viewer/image/object_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace impinge {

namespace {

using Key = std::tuple<std::string, std::string, std::string, std::string>;  // layer, mark, body, other
Key key_of(const IdObject& o) { return {o.layer, o.mark, o.body, o.other}; }

bool is_ground(const IdObject* object) {
  return object == nullptr || object->mark == "plane" || object->mark == "fixed surface";
}
bool is_solid(const std::string& mark) { return mark == "surface" || mark == "fixed surface" || mark == "plane"; }
bool is_mark(const IdObject& object) { return !is_solid(object.mark); }

/// The objects of a picture by kind, and the identities seen.
std::map<Key, std::set<std::uint64_t>> seen_in(const IdImage& ids) {
  std::vector<bool> seen(ids.objects.size() + 1, false);
  for (const std::uint32_t i : ids.object) seen[i] = true;
  std::map<Key, std::set<std::uint64_t>> all;
  for (std::size_t i = 0; i < ids.objects.size(); ++i)
    if (seen[i + 1]) all[key_of(ids.objects[i])].insert(ids.objects[i].identity);
  return all;
}

std::string plural(const std::string& mark, int count) { return count == 1 || mark.back() == 's' ? mark : mark + "s"; }

}  // namespace

std::string ObjectChange::text() const {
  const std::string where = body.empty()    ? ""
                            : other.empty() ? " of " + body
                                            : fmt::format(" between {} and {}", body, other);
  const std::string size = fmt::format("{} pixel{}", pixels, pixels == 1 ? "" : "s");
  const char* what = missing > 0 ? "missing" : added > 0 ? "new" : "changed";
  if (is_solid(mark)) return fmt::format("{}: {} {} ({})", layer, body, what, size);
  if (body.empty()) return fmt::format("{}: {} {} ({})", layer, mark, what, size);
  // all marks that a layer draws for a body are one object
  if (other.empty()) return fmt::format("{}: {}{} {} ({})", layer, plural(mark, 2), where, what, size);
  std::vector<std::string> parts;
  const auto say = [&](int count, const char* how) {
    if (count > 0) parts.push_back(fmt::format("{} {}{} {}", count, plural(mark, count), where, how));
  };
  say(missing, "missing"), say(added, "new"), say(changed, "changed");
  return fmt::format("{}: {} (of {} in A; {})", layer, fmt::join(parts, ", "), in_a, size);
}

std::vector<ObjectChange> object_changes(const Image& a, const Image& b, const IdImage& ids_a, const IdImage& ids_b,
                                         int tolerance, const Image* mask) {
  const auto fits = [&](int w, int h) { return w == a.width && h == a.height; };
  if (!fits(b.width, b.height) || !fits(ids_a.width, ids_a.height) || !fits(ids_b.width, ids_b.height)) return {};
  struct Touched {
    std::set<std::uint64_t> identities;
    std::int64_t pixels = 0;
  };
  std::map<Key, Touched> touched;
  const auto object_of = [](const IdImage& ids, std::size_t i) {
    return ids.object[i] == 0 ? nullptr : &ids.objects[ids.object[i] - 1];
  };
  const auto same_object = [&](std::size_t i) {
    const IdObject *in_a = object_of(ids_a, i), *in_b = object_of(ids_b, i);
    return in_a == nullptr || in_b == nullptr ? in_a == in_b : in_a->is_same_as(*in_b);
  };
  // soft rims and smooth edges reach a pixel farther than ids do: they belong to the change beside them
  const auto source_of = [&](std::size_t i) {
    if (!same_object(i)) return i;
    const int x = static_cast<int>(i) % a.width, y = static_cast<int>(i) / a.width;
    for (int v = std::max(0, y - 1); v <= std::min(a.height - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(a.width - 1, x + 1); ++u)
        if (const std::size_t k = static_cast<std::size_t>(v) * a.width + u; !same_object(k)) return k;
    return i;
  };
  for (std::size_t i = 0; i < ids_a.object.size(); ++i) {
    if (is_left_out(mask, i) || channel_difference(a.rgb.data() + 3 * i, b.rgb.data() + 3 * i) <= tolerance) continue;
    const std::size_t source = source_of(i);
    const IdObject *in_a = object_of(ids_a, source), *in_b = object_of(ids_b, source);
    const auto count = [&](const IdObject& object) {
      Touched& t = touched[key_of(object)];
      t.identities.insert(object.identity);
      ++t.pixels;
    };
    if (in_a != nullptr && in_b != nullptr && in_a->is_same_as(*in_b)) {
      count(*in_a);
      continue;
    }
    // a mark explains the change of what lies behind it, and a body that of the ground
    const bool mark = (in_a != nullptr && is_mark(*in_a)) || (in_b != nullptr && is_mark(*in_b));
    for (const IdObject* object : {in_a, in_b})
      if (object != nullptr && (mark ? is_mark(*object) : !is_ground(object) || (is_ground(in_a) && is_ground(in_b))))
        count(*object);
  }
  const auto seen_a = seen_in(ids_a), seen_b = seen_in(ids_b);
  const auto identities = [](const auto& seen, const Key& key) {
    const auto it = seen.find(key);
    return it == seen.end() ? std::set<std::uint64_t>() : it->second;
  };
  std::vector<ObjectChange> changes;
  for (const auto& [key, t] : touched) {
    const std::set<std::uint64_t> before = identities(seen_a, key), after = identities(seen_b, key);
    ObjectChange change{std::get<0>(key), std::get<1>(key), std::get<2>(key), std::get<3>(key)};
    change.in_a = static_cast<int>(before.size());
    change.pixels = t.pixels;
    for (const std::uint64_t identity : t.identities) {
      const bool was = before.contains(identity), is = after.contains(identity);
      change.missing += was && !is;
      change.added += is && !was;
      change.changed += was && is;
    }
    changes.push_back(std::move(change));
  }
  std::stable_sort(changes.begin(), changes.end(),
                   [](const ObjectChange& l, const ObjectChange& r) { return l.pixels > r.pixels; });
  return changes;
}

}  // namespace impinge
