#include "program/strict_json.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "viapoint/core/error.hpp"

namespace viapoint::program_json {
namespace {

[[noreturn]] void refuse(const std::string& source, std::string message,
                         std::vector<std::string> ways_out, std::optional<int> line = {}) {
  Problem problem;
  problem.code = ErrorCode::kBadProgram;
  problem.file = source;
  problem.line = line;
  problem.message = std::move(message);
  problem.ways_out = std::move(ways_out);
  throw MotionError(std::move(problem));
}

/// Follows the parser through the text, and knows where it is.
class Watch {
 public:
  explicit Watch(const std::string& source) : source_(source) {}

  void operator()(Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    switch (event) {
      case Event::object_start:
      case Event::array_start:
        enter(event == Event::array_start);
        break;
      case Event::key:
        name(parsed.get<std::string>());
        break;
      case Event::value:
        count();
        break;
      case Event::object_end:
      case Event::array_end:
        open_.pop_back();
        break;
    }
  }

 private:
  /// An object or array that is not closed yet.
  struct Open {
    bool array = false;
    int items = 0;
    std::string key;
    std::set<std::string> keys;
  };

  void enter(bool array) {
    count();
    if (open_.size() == static_cast<size_t>(kDeepest)) {
      refuse(source_,
             "brackets stand in one another more than " + std::to_string(kDeepest) +
                 " deep; a program has no place for that",
             {"check that this is a program file, as program.save(path) writes it"});
    }
    open_.push_back({array, 0, {}, {}});
  }

  void name(std::string key) {
    Open& object = open_.back();
    if (!object.keys.insert(key).second) {
      refuse(source_, place() + "member \"" + key + "\" is there twice",
             {"delete the one that is not meant"});
    }
    object.key = std::move(key);
  }

  void count() {
    if (!open_.empty()) ++open_.back().items;
  }

  /// The way to the innermost object, e.g. "steps[3].lin: ".
  [[nodiscard]] std::string place() const {
    std::string path;
    for (size_t i = 0; i + 1 < open_.size(); ++i) {
      path += open_[i].array ? "[" + std::to_string(open_[i].items - 1) + "]"
                             : (path.empty() ? "" : ".") + open_[i].key;
    }
    return path.empty() ? path : path + ": ";
  }

  const std::string& source_;
  std::vector<Open> open_;
};

}  // namespace

Json parse_strictly(const std::string& text, const std::string& source) {
  Watch watch(source);
  try {
    return Json::parse(text, [&](int, Json::parse_event_t event, const Json& parsed) {
      watch(event, parsed);
      return true;
    });
  } catch (const Json::parse_error& error) {
    const size_t before = std::min(error.byte, text.size());
    const auto lines = std::count(text.begin(), text.begin() + static_cast<long>(before), '\n');
    refuse(source, "not a JSON file, or cut short, at byte " + std::to_string(error.byte),
           {"check that the file was written whole; program.save(path) writes it anew"},
           static_cast<int>(lines) + 1);
  } catch (const Json::exception&) {  // a number beyond all doubles
    refuse(source, "a number in it is too large to be read",
           {"look for a number with an exponent above 308; program.save(path) writes it anew"});
  }
}

}  // namespace viapoint::program_json
