#include "engine/io/scene/toml_scalar.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

namespace impinge {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_hex(char c) { return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }

void append_character(std::string& out, std::uint32_t c) {
  const auto byte = [&](std::uint32_t b) { out += static_cast<char>(static_cast<unsigned char>(b)); };
  if (c < 0x80) return byte(c);
  if (c < 0x800) return byte(0xC0 | c >> 6), byte(0x80 | (c & 0x3F));
  if (c < 0x10000) return byte(0xE0 | c >> 12), byte(0x80 | (c >> 6 & 0x3F)), byte(0x80 | (c & 0x3F));
  byte(0xF0 | c >> 18), byte(0x80 | (c >> 12 & 0x3F)), byte(0x80 | (c >> 6 & 0x3F)), byte(0x80 | (c & 0x3F));
}

// \u00E4, \U0001F600; the cursor is behind the u
void read_code(TomlCursor& in, int digits, std::string& out) {
  std::uint32_t code = 0;
  for (int i = 0; i < digits; ++i, in.skip()) {
    if (!is_hex(in.peek())) in.fail(fmt::format("{} instead of a hexadecimal digit of {}", in.found(), digits));
    std::uint32_t digit = 0;
    std::from_chars(&in.rest()[0], &in.rest()[0] + 1, digit, 16);
    code = code << 4 | digit;
  }
  if (code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) in.fail(fmt::format("U+{:04X} is no character", code));
  append_character(out, code);
}

void read_escape(TomlCursor& in, bool many_lines, std::string& out) {
  in.skip();  // the backslash
  constexpr std::string_view kLetters = "btnfr\"\\", kMeant = "\b\t\n\f\r\"\\";
  if (const std::size_t i = kLetters.find(in.peek()); !in.at_end() && i != std::string_view::npos) {
    out += kMeant[i];
    return in.skip();
  }
  if (in.peek() == 'u' || in.peek() == 'U') {
    const int digits = in.peek() == 'u' ? 4 : 8;
    in.skip();
    return read_code(in, digits, out);
  }
  // at the end of a line: it and all blanks and line ends after it are left out
  if (many_lines) {
    TomlCursor ahead = in;
    ahead.skip_blanks();
    if (ahead.at_line_end()) {
      in = ahead;
      while (in.at_line_end()) in.skip_line_end(), in.skip_blanks();
      return;
    }
  }
  in.fail(fmt::format("\\ before {}, which it can't escape; in '...' it is nothing special", in.found()));
}

/// Digits, single underscores between them; how many bytes, 0 where that is not what stands there.
template <class IsDigit>
std::size_t digits_in(std::string_view word, IsDigit is) {
  std::size_t i = 0;
  while (i < word.size() &&
         (is(word[i]) || (word[i] == '_' && i > 0 && is(word[i - 1]) && i + 1 < word.size() && is(word[i + 1]))))
    ++i;
  return i;
}

/// Nothing of an integer that 64 bits don't hold: TOML wants an error, and any other number is one that nobody wrote.
std::optional<TomlNode> integer_node(std::string_view digits, int base, bool negative) {
  std::string bare(negative ? "-" : "");
  std::copy_if(digits.begin(), digits.end(), std::back_inserter(bare), [](char c) { return c != '_'; });
  TomlNode node;
  node.kind = TomlNode::integer;
  if (std::from_chars(bare.data(), bare.data() + bare.size(), node.whole, base).ec != std::errc()) return std::nullopt;
  return node;
}

/// `bare`: without sign and underscores.
double real_value(const std::string& bare) {
  double value = 0.0;
  if (std::from_chars(bare.data(), bare.data() + bare.size(), value).ec == std::errc()) return value;
  // too large or too small: by the power of ten of the first digit that is not 0
  const std::size_t e = std::min(bare.find_first_of("eE"), bare.size()), point = std::min(bare.find('.'), e);
  const std::size_t first = bare.find_first_of("123456789");
  if (first >= e) return 0.0;
  long power = 0;
  if (e < bare.size()) {
    const char* begin = bare.data() + e + (bare[e + 1] == '+' ? 2 : 1);
    if (std::from_chars(begin, bare.data() + bare.size(), power).ec != std::errc())
      power = *begin == '-' ? -1'000'000 : 1'000'000;
  }
  return power + static_cast<long>(point) - static_cast<long>(first) > 0 ? std::numeric_limits<double>::infinity()
                                                                         : 0.0;
}

/// `is_too_large`: it is an integer, but beyond 64 bits; there is no node of it then.
std::optional<TomlNode> number_node(std::string_view word, bool& is_too_large) {
  TomlNode node;
  const auto integer = [&](std::string_view digits, int base, bool negative) {
    const std::optional<TomlNode> whole = integer_node(digits, base, negative);
    is_too_large = !whole;
    return whole;
  };
  const bool is_signed = !word.empty() && (word[0] == '+' || word[0] == '-'), negative = is_signed && word[0] == '-';
  const std::string_view bare = word.substr(is_signed ? 1 : 0);
  if (bare == "inf" || bare == "nan") {
    const double value =
        bare == "inf" ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    node.kind = TomlNode::real, node.number = negative ? -value : value;
    return node;
  }
  constexpr std::pair<std::string_view, int> kBases[] = {{"0x", 16}, {"0o", 8}, {"0b", 2}};
  for (const auto& [mark, base] : kBases) {
    if (is_signed || bare.substr(0, 2) != mark) continue;
    const std::string_view digits = bare.substr(2);
    const auto is = [base = base](char c) { return base == 16 ? is_hex(c) : c >= '0' && c < '0' + base; };
    if (digits.empty() || digits_in(digits, is) != digits.size()) return std::nullopt;
    return integer(digits, base, false);
  }
  const std::size_t whole = digits_in(bare, is_digit);
  if (whole == 0 || (whole > 1 && bare[0] == '0')) return std::nullopt;
  if (whole == bare.size()) return integer(bare, 10, negative);
  std::size_t at = whole;
  if (bare[at] == '.') {
    const std::size_t part = digits_in(bare.substr(at + 1), is_digit);
    if (part == 0) return std::nullopt;
    at += 1 + part;
  }
  if (at < bare.size() && (bare[at] == 'e' || bare[at] == 'E')) {
    ++at;
    if (at < bare.size() && (bare[at] == '+' || bare[at] == '-')) ++at;
    const std::size_t part = digits_in(bare.substr(at), is_digit);
    if (part == 0) return std::nullopt;
    at += part;
  }
  if (at != bare.size()) return std::nullopt;
  std::string digits;
  std::copy_if(bare.begin(), bare.end(), std::back_inserter(digits), [](char c) { return c != '_'; });
  node.kind = TomlNode::real;
  node.number = negative ? -real_value(digits) : real_value(digits);
  return node;
}

/// Whether `text` reads like `form`, where 0 stands for a digit; takes it away then.
bool take(std::string_view& text, std::string_view form) {
  if (text.size() < form.size()) return false;
  for (std::size_t i = 0; i < form.size(); ++i)
    if (form[i] == '0' ? !is_digit(text[i]) : text[i] != form[i]) return false;
  text.remove_prefix(form.size());
  return true;
}

int number_at(std::string_view text, std::size_t at, std::size_t count) {
  int value = 0;
  std::from_chars(text.data() + at, text.data() + at + count, value);
  return value;
}

bool is_day(std::string_view date) {
  const int year = number_at(date, 0, 4), month = number_at(date, 5, 2), day = number_at(date, 8, 2);
  const bool leaps = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return month >= 1 && month <= 12 && day >= 1 && day <= kDays[month - 1] + (month == 2 && leaps);
}

bool is_time_of_day(std::string_view time, std::size_t hours_at) {
  return number_at(time, hours_at, 2) < 24 && number_at(time, hours_at + 3, 2) < 60;
}

/// 1979-05-27, 07:32:00.5, 1979-05-27T07:32:00, ...Z, ...+01:00 (RFC 3339).
bool is_date_or_time(std::string_view word) {
  std::string_view left = word;
  const bool has_date = take(left, "0000-00-00");
  if (has_date && !is_day(word)) return false;
  if (has_date && left.empty()) return true;
  if (has_date && !(left[0] == 'T' || left[0] == 't' || left[0] == ' ')) return false;
  if (has_date) left.remove_prefix(1);
  const std::string_view time = left;
  if (!take(left, "00:00:00") || !is_time_of_day(time, 0) || number_at(time, 6, 2) > 60) return false;
  if (!left.empty() && left[0] == '.') {
    left.remove_prefix(1);
    if (left.empty() || !is_digit(left[0])) return false;
    while (!left.empty() && is_digit(left[0])) left.remove_prefix(1);
  }
  if (left.empty()) return true;
  if (!has_date) return false;
  if (left == "Z" || left == "z") return true;
  const std::string_view offset = left;
  return (take(left, "+00:00") || take(left, "-00:00")) && left.empty() && is_time_of_day(offset, 1);
}

}  // namespace

std::string read_toml_text(TomlCursor& in, bool many_lines) {
  const TomlCursor::Spot begin = in.spot();
  const char mark = in.peek();
  const std::string three(3, mark);
  const bool long_text = many_lines && in.starts_with(three);
  in.skip(long_text ? 3 : 1);
  if (long_text && in.at_line_end()) in.skip_line_end();
  std::string out;
  for (;;) {
    if (in.at_end())
      in.fail_at(begin, fmt::format("a text that is not closed by {}", long_text ? three : std::string(1, mark)));
    if (long_text && in.starts_with(three)) {
      // one or two marks before the three that close the text belong to it
      in.skip(3);
      for (int more = 0; more < 2 && in.peek() == mark; ++more, in.skip()) out += mark;
      return out;
    }
    if (!long_text && in.peek() == mark) return in.skip(), out;
    if (in.at_line_end()) {
      if (!long_text) in.fail_at(begin, fmt::format("a text that is not closed by {} on its line", mark));
      out += '\n';
      in.skip_line_end();
    } else if (in.peek() == '\\' && mark == '"') {
      read_escape(in, long_text, out);
    } else {
      in.refuse_control();
      out += in.peek();
      in.skip();
    }
  }
}

TomlNode read_toml_word(TomlCursor& in) {
  const auto belongs = [](char c) {
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '.' || c == '+' ||
           c == '-' || c == ':';
  };
  const std::string_view rest = in.rest();
  std::size_t length = 0;
  while (length < rest.size() && belongs(rest[length])) ++length;
  // a blank may stand between a date and a time
  std::string_view date = rest;
  if (take(date, "0000-00-00") && length == 10 && take(date, " 00:"))
    for (length = 11; length < rest.size() && belongs(rest[length]);) ++length;
  const std::string_view word = rest.substr(0, length);
  TomlNode node;
  bool is_too_large = false;
  if (word.empty()) in.fail(in.found() + " where a value should stand");
  if (word == "true" || word == "false") {
    node.kind = TomlNode::boolean, node.flag = word == "true";
  } else if (const auto number = number_node(word, is_too_large)) {
    node = *number;
  } else if (is_too_large) {
    in.fail(fmt::format("'{}' is out of range: integers have 64 bits, real numbers a point or an exponent",
                        shortened(word, 40)));
  } else if (is_date_or_time(word)) {
    node.kind = TomlNode::other, node.string = std::string(word);
  } else if (is_digit(word[0]) || word[0] == '+' || word[0] == '-' || word[0] == '.') {
    in.fail(fmt::format("'{}' is no number", shortened(word, 40)));
  } else {
    in.fail(fmt::format("'{}' is no value; texts stand in quotes", shortened(word, 40)));
  }
  in.skip(length);
  return node;
}

}  // namespace impinge
