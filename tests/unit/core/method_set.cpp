#include "engine/core/method_set.hpp"

#include <catch2/catch.hpp>

using namespace impinge;

namespace {

class Rule : public Method {
 public:
  virtual double apply(double x) const = 0;
};

class Twice : public Rule {
 public:
  double apply(double x) const override { return 2.0 * x; }
};

class Power : public Rule {
 public:
  void declare(const Rows& rows) override {
    rows.add("exponent", exponent_, {0, 9}, "", "how often").formerly("rule.power_exponent");
    rows.add("sign", sign_, {{Sign::plus, "plus"}, {Sign::minus, "minus"}}, "of what comes out");
    path_ = rows.path_of("exponent");
  }
  double apply(double x) const override {
    double product = sign_ == Sign::plus ? 1.0 : -1.0;
    for (int k = 0; k < exponent_; ++k) product *= x;
    return product;
  }
  std::string path_;

 private:
  int exponent_ = 2;
  enum class Sign { plus, minus } sign_ = Sign::plus;
};

const Registry<Rule>& rules() {
  static const Registry<Rule> list = {entry<Rule, Twice>("twice", "2 x"), entry<Rule, Power>("power", "x^n"),
                                      entry<Rule, Power>("other_power", "x^n with settings of its own")};
  return list;
}

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a set of methods: one in use, each with its own settings below its name") {
  MethodSet<Rule> set(rules());
  ParameterSet rows;
  const Rows of_rule = Rows(rows).below("rule");
  of_rule.add("method", set, "which rule");
  set.declare(of_rule);
  std::vector<std::string> paths;
  for (const Parameter& row : rows.all()) paths.push_back(row.path);
  CHECK(paths == std::vector<std::string>{"rule.method", "rule.power.exponent", "rule.power.sign",
                                          "rule.other_power.exponent", "rule.other_power.sign"});
  CHECK(rows.find("rule.method")->names == std::vector<std::string>{"twice", "power", "other_power"});

  CHECK(set.name() == "twice");
  CHECK(set->apply(3.0) == 6.0);
  rows.find("rule.method")->set(std::string("power"));
  rows.find("rule.power.exponent")->set(std::int64_t{3});
  CHECK(set->apply(3.0) == 27.0);
  CHECK(set.at("other_power").apply(3.0) == 9.0);
  set = "other_power";
  CHECK(format_value(rows.find("rule.method")->get()) == "other_power");
  CHECK((*set).apply(3.0) == 9.0);
  CHECK_THROWS_AS(set = "thrice", InternalError);
  CHECK(set.name() == "other_power");

  // one path of two methods, as one class is registered twice
  CHECK(*rows.renamed("rule.power_exponent") ==
        std::vector<std::string>{"rule.power.exponent", "rule.other_power.exponent"});
  CHECK(dynamic_cast<Power&>(set.at("power")).path_ == "rule.power.exponent");
}

TEST_CASE("a method by itself is configured by the names of its rows, and copied") {
  Power power, other;
  configure(power, std::vector<RowText>{{"exponent", "4"}, {"sign", "minus"}});
  CHECK(power.apply(2.0) == -16.0);
  copy_settings(power, other);
  CHECK(other.apply(2.0) == -16.0);
  CHECK(message_of([&] {
          configure(power, std::vector<RowText>{{"exponnt", "4"}});
        }) == "unknown parameter 'exponnt'; did you mean 'exponent'?");
  CHECK(message_of([&] {
          configure(power, std::vector<RowText>{{"exponent", "10"}});
        }) == "10 is out of range for exponent; allowed: an integer in [0, 9]");
}
