#include "engine/ledger/ledger_table.hpp"

#include <fmt/format.h>

#include "engine/core/parameter.hpp"

namespace impinge {
namespace {

bool has_moved(const BodyLedger& body) {
  return body.turnover() > 0.0 || body.rise.kinetic != 0.0 || body.rise.potential != 0.0 || body.rise.elastic != 0.0;
}

void add_row(const BodyLedger& body, int frame, double time, std::string_view name, std::string& out) {
  out += fmt::format("{},{},{}", frame, shortest(time), name);
  const auto add = [&out](double value) { out += ',' + shortest(value); };
  const auto add_vectors = [&add](const Vec3& momentum, const Vec3& angular_momentum) {
    for (const Vec3& v : {momentum, angular_momentum})
      for (int k = 0; k < 3; ++k) add(v[k]);
  };
  add(body.rise.kinetic), add(body.rise.potential), add(body.rise.elastic);
  for (const LedgerSourceInfo& info : ledger_sources()) add(body.figure(info.source));
  add(body.closing_error());
  for (const LedgerEntry& entry : body.of) add_vectors(entry.momentum, entry.angular_momentum);
  add_vectors(body.momentum_error(), body.angular_momentum_error());
  out += '\n';
}

}  // namespace

std::string ledger_header() {
  std::string out = "frame,time_s,body,kinetic_rise_J,potential_rise_J,elastic_rise_J";
  for (const LedgerSourceInfo& info : ledger_sources()) out += fmt::format(",{}_J", info.name);
  out += ",closing_J";
  const auto add_vectors = [&out](std::string_view name) {
    for (const char* figure : {"px", "py", "pz", "lx", "ly", "lz"}) out += fmt::format(",{}_{}", name, figure);
  };
  for (const LedgerSourceInfo& info : ledger_sources()) add_vectors(info.name);
  add_vectors("closing");
  return out;
}

std::string ledger_rows(const FrameLedger& ledger, int frame, double time, std::span<const std::string> names) {
  std::string out;
  for (std::size_t b = 0; b < ledger.bodies.size(); ++b)
    if (has_moved(ledger.bodies[b])) add_row(ledger.bodies[b], frame, time, names[b], out);
  add_row(ledger.world(), frame, time, "*", out);
  return out;
}

}  // namespace impinge
