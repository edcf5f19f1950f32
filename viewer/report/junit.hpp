// What `impinge test` found, as JUnit XML.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace impinge {

struct TestOutcome {
  enum Kind { ok, failed, error };
  std::string name;
  Kind kind = ok;
  int expectations = 0, pictures = 0;
  double seconds = 0.0;
  std::vector<std::string> messages;  ///< why; and what was rewritten
};

/// The format that Jenkins, GitLab and others read: a suite with a case each, <failure> or <error> with the messages.
std::string junit_xml(const std::string& suite, const std::vector<TestOutcome>& outcomes);

}  // namespace impinge
