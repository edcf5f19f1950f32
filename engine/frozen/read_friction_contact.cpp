#include "engine/frozen/read_friction_contact.hpp"

#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/text_lines.hpp"

namespace impinge {
namespace {

constexpr std::uint64_t kMostOfFile = std::uint64_t(1) << 30;

/// The file as one row of numbers, each with its place.
class Numbers {
 public:
  Numbers(const std::string& name, std::string_view text) : lines_(name, text) {}
  double real(const char* what) {
    step(what);
    return lines_.real(at_);
  }
  std::int64_t whole(const char* what) {
    step(what);
    return lines_.integer(at_);
  }
  std::int64_t whole(const char* what, std::int64_t wanted) {
    const std::int64_t value = whole(what);
    if (value != wanted)
      fail(fmt::format("{} is {}", what, value), fmt::format("{} is wanted here", wanted), "export the file again");
    return value;
  }
  /// A count of things that take at least `bytes` characters each in what is left of the file.
  std::int64_t room(const char* what, std::int64_t bytes) {
    const std::int64_t value = whole(what);
    const auto left = static_cast<std::int64_t>(lines_.bytes_left()) + kLineSlack;
    if (value < 0 || value > left / bytes)
      fail(fmt::format("{} is {}", what, value), "no more than the file has room for", "export the file again");
    return value;
  }
  bool end() {
    if (at_ + 1 < lines_.count()) return false;
    at_ = 0;
    if (!lines_.next()) return true;
    pending_ = true;
    return false;
  }
  [[noreturn]] void fail(const std::string& found, const std::string& allowed, const std::string& remedy) {
    lines_.fail(at_, found, allowed, remedy);
  }
  void fail_next(const std::string& allowed, const std::string& remedy) {
    step("");
    fail(quoted(lines_.word(at_)), allowed, remedy);
  }

 private:
  static constexpr std::int64_t kLineSlack = 1 << 20;  // words of the line at hand are not among the bytes left
  void step(const char* what) {
    if (pending_) {
      pending_ = false;
      return;
    }
    if (++at_ < lines_.count()) return;
    lines_.need(what);
    at_ = 0;
  }
  TextLines lines_;
  std::size_t at_ = 0;
  bool pending_ = false;
};

using Block = BlockSparseDelassus::Block;

std::vector<Block> read_dense(Numbers& in, std::int64_t contacts) {
  in.whole("the number of rows", 3 * contacts);
  in.whole("the number of columns", 3 * contacts);
  std::vector<Mat3> values(static_cast<std::size_t>(contacts * contacts));
  for (std::int64_t c = 0; c < 3 * contacts; ++c)
    for (std::int64_t r = 0; r < 3 * contacts; ++r)
      values[r / 3 * contacts + c / 3](r % 3, c % 3) = in.real("a value of W");
  std::vector<Block> blocks;
  for (std::int64_t r = 0; r < contacts; ++r)
    for (std::int64_t c = 0; c < contacts; ++c) {
      const Mat3& value = values[r * contacts + c];
      if (r == c || !value.isZero(0.0)) blocks.push_back({static_cast<int>(r), static_cast<int>(c), value});
    }
  return blocks;
}

std::vector<Block> read_sparse(Numbers& in, std::int64_t contacts) {
  const std::int64_t count = in.room("the number of blocks", 20);
  in.whole("the number of block rows", contacts);
  in.whole("the number of block columns", contacts);
  for (const char* what : {"the end of a block row", "the end of a block column"})
    for (std::int64_t i = 1; i <= contacts; ++i) in.whole(what, 3 * i);
  in.whole("the length of index1", contacts + 1);
  in.whole("the length of index2", count);
  std::vector<std::int64_t> begin;
  for (std::int64_t i = 0; i <= contacts; ++i) {
    const std::int64_t last = begin.empty() ? 0 : begin.back();
    begin.push_back(in.whole("an entry of index1"));
    if (begin.back() < last || begin.back() > count || (i == 0 && begin.back() != 0) ||
        (i == contacts && begin.back() != count))
      in.fail(fmt::format("index1 goes on with {}", begin.back()), fmt::format("it rises from 0 to {}", count),
              "export the file again");
  }
  std::vector<Block> blocks;
  for (std::int64_t row = 0; row < contacts; ++row)
    for (std::int64_t k = begin[row]; k < begin[row + 1]; ++k) {
      const std::int64_t column = in.whole("an entry of index2");
      if (column < 0 || column >= contacts)
        in.fail(fmt::format("block column {}", column), fmt::format("there are columns 0 to {}", contacts - 1),
                "export the file again");
      if (k > begin[row] && column <= blocks.back().column)
        in.fail(fmt::format("block column {} after {}", column, blocks.back().column), "columns rise along a row",
                "export the file again");
      blocks.push_back({static_cast<int>(row), static_cast<int>(column), Mat3::Zero()});
    }
  for (std::int64_t k = 0; k < count; ++k) {
    in.whole("the number of a block", k);
    for (int e = 0; e < 9; ++e) blocks[k].value(e % 3, e / 3) = in.real("a value of W");
  }
  return blocks;
}

}  // namespace

FrictionContactProblem read_friction_contact(const std::filesystem::path& path) {
  const std::string text = read_file(path, kMostOfFile);
  Numbers in(path.string(), text);
  const std::int64_t dimension = in.whole("the dimension");
  if (dimension != 3)
    in.fail(fmt::format("dimension {}", dimension), "3, contacts in space, is read",
            "export a three-dimensional problem");
  const std::int64_t contacts = in.room("the number of contacts", 9);
  if (contacts == 0) in.fail("no contacts", "at least one is wanted", "export a problem that has contacts");
  const std::int64_t storage = in.whole("the storage of W");
  if (storage != 0 && storage != 1)
    in.fail(fmt::format("storage {}", storage), "0 (dense) or 1 (block sparse) is wanted", "export W in one of these");
  in.whole("the number of rows", 3 * contacts);
  in.whole("the number of columns", 3 * contacts);
  // a dense W has 9 contacts² values of two characters at least; told before the memory is asked for
  if (storage == 0 && static_cast<std::uint64_t>(contacts) * contacts * 18 > text.size() + 1)
    in.fail(fmt::format("{} contacts and a dense W", contacts), "no more than the file has room for",
            "export the file again");
  std::vector<Block> blocks = storage == 0 ? read_dense(in, contacts) : read_sparse(in, contacts);

  FrictionContactProblem read;
  read.w = std::make_unique<BlockSparseDelassus>(contacts, std::move(blocks));
  read.problem.w = read.w.get();
  for (std::int64_t i = 0; i < contacts; ++i) {
    const double n = in.real("a value of q"), t1 = in.real("a value of q"), t2 = in.real("a value of q");
    read.problem.q.emplace_back(n, t1, t2);
  }
  for (std::int64_t i = 0; i < contacts; ++i) {
    read.problem.mu.push_back(in.real("a coefficient of friction"));
    if (read.problem.mu.back() < 0.0)
      in.fail(fmt::format("friction {}", read.problem.mu.back()), "0 or more is wanted", "mend the value");
  }
  if (!in.end()) in.whole("a flag");
  if (!in.end()) in.fail_next("the file should end here", "mend the counts in its head");
  return read;
}

}  // namespace impinge
