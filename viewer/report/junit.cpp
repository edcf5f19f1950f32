#include "viewer/report/junit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "viewer/report/html.hpp"

namespace impinge {

namespace {

/// XML 1.0 has no control characters but line ends and tabs.
std::string xml(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t') c = '?';
  return html_text(text);
}

}  // namespace

std::string junit_xml(const std::string& suite, const std::vector<TestOutcome>& outcomes) {
  const auto count = [&](TestOutcome::Kind kind) {
    return std::count_if(outcomes.begin(), outcomes.end(), [&](const TestOutcome& o) { return o.kind == kind; });
  };
  double seconds = 0.0;
  for (const TestOutcome& o : outcomes) seconds += o.seconds;
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" "
      "errors=\"{}\" time=\"{:.3f}\">\n",
      xml(suite), outcomes.size(), count(TestOutcome::failed), count(TestOutcome::error), seconds);
  for (const TestOutcome& o : outcomes) {
    out += fmt::format("<testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", xml(suite), xml(o.name), o.seconds);
    if (o.kind == TestOutcome::ok) {
      out += "/>\n";
      continue;
    }
    const char* tag = o.kind == TestOutcome::failed ? "failure" : "error";
    out += fmt::format(">\n<{0} message=\"{1}\">{2}</{0}>\n</testcase>\n", tag,
                       xml(o.messages.empty() ? "" : o.messages.front()),
                       xml(fmt::format("{}", fmt::join(o.messages, "\n"))));
  }
  return out + "</testsuite>\n</testsuites>\n";
}

}  // namespace impinge
