/// @file
/// Which state of a run may follow which, as the documentation draws it.
#pragma once

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>

namespace viapoint {

/// The arrows of the state diagram in docs/realtime.md: what users are told is what is held.
class StateTable {
 public:
  explicit StateTable(const std::string& document) {
    std::ifstream file(document);
    std::string line;
    while (std::getline(file, line) && line != "stateDiagram-v2") {
    }
    while (std::getline(file, line) && line != "```") {
      std::istringstream words(line);
      std::string from, arrow, to;
      words >> from >> arrow >> to;
      if (arrow != "-->") continue;
      if (!to.empty() && to.back() == ':') to.pop_back();
      arrows_.emplace(from, to);
    }
  }

  [[nodiscard]] bool allows(const std::string& from, const std::string& to) const {
    return from == to || arrows_.contains({from, to});
  }
  [[nodiscard]] const std::set<std::pair<std::string, std::string>>& arrows() const {
    return arrows_;
  }

 private:
  std::set<std::pair<std::string, std::string>> arrows_;
};

}  // namespace viapoint
