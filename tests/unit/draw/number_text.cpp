#include "viewer/draw/number_text.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <map>

#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// What the text says, read as a person would.
double read(const NumberText& text, const std::string& unit) {
  static const std::map<std::string, double> kPowers = {{"f", 1e-15}, {"p", 1e-12}, {"n", 1e-9}, {"µ", 1e-6},
                                                        {"m", 1e-3},  {"", 1.0},    {"k", 1e3},  {"M", 1e6},
                                                        {"G", 1e9},   {"T", 1e12}};
  REQUIRE(text.unit.ends_with(unit));
  return std::stod(text.digits) * kPowers.at(text.unit.substr(0, text.unit.size() - unit.size()));
}

}  // namespace

TEST_CASE("a number has three figures, one to three of them before the point, and is as large as it was") {
  Random random(5);
  for (int k = 0; k < 3000; ++k) {
    const double value = (k % 2 ? -1.0 : 1.0) * std::pow(10.0, random.in(-14.0, 14.0));
    const NumberText text = number_text(value, "N");
    CAPTURE(value, text.digits, text.unit);
    CHECK(std::abs(read(text, "N") - value) <= 0.00501 * std::abs(value));  // half of the third figure of 1.00
    const std::string digits = text.digits.substr(value < 0.0 ? 1 : 0);
    const std::size_t point = std::min(digits.find('.'), digits.size());
    CHECK((text.digits[0] == '-') == (value < 0.0));
    CHECK(point >= 1);
    CHECK(point <= 3);
    CHECK(digits.size() - (digits.find('.') != std::string::npos) == 3);
    CHECK(digits[0] != '0');
  }
}

TEST_CASE("numbers are rounded before their prefix is chosen") {
  CHECK(number_text(0.9996, "m").whole() == "1.00 m");
  CHECK(number_text(999.6, "m").whole() == "1.00 km");
  CHECK(number_text(999.4, "m").whole() == "999 m");
  CHECK(number_text(-6.69e-11, "m").whole() == "-66.9 pm");
  CHECK(number_text(1.5e-6, "m/s").whole() == "1.50 µm/s");
  CHECK(number_text(-0.0, "m").whole() == "0 m");
  CHECK(number_text(1e-40, "m").whole() == "1e-40 m");
  CHECK(number_text(NAN, "m").whole() == "nan m");
  CHECK(number_text(0.25, "").whole() == "0.25");
  CHECK(number_text(6.7e-8, "").whole() == "6.7e-8");
}

TEST_CASE("masses are grams below a kilogram, and never megagrams") {
  CHECK(number_text(0.0123, "kg").whole() == "12.3 g");
  CHECK(number_text(2400.0, "kg").whole() == "2400 kg");
  CHECK(number_text(3.5, "kg m/s").whole() == "3.5 kg m/s");
}

TEST_CASE("a vector has one prefix and as many decimals in each component") {
  CHECK(vector_text({-0.299, 0.0, 0.641}, "m") == "-299.0  0.0  641.0 mm");
  CHECK(vector_text({0.0, -1.0, 0.0}, "") == "0.000  -1.000  0.000");
  CHECK(vector_text({0.0, 0.0, 0.0}, "m/s") == "0  0  0 m/s");
}

TEST_CASE("round numbers have no zeros that say nothing") {
  CHECK(round_text(20.0, "N") == "20 N");
  CHECK(round_text(1200.0, "N") == "1.2 kN");
  CHECK(round_text(0.5, "N") == "500 mN");
  CHECK(round_text(4.905, "N") == "4.905 N");
  CHECK(round_text(100.0, "rad/s") == "100 rad/s");
  CHECK(round_text(0.0, "N") == "0 N");
  CHECK(round_text(1e6, "") == "1e6");
}
