#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>

#include "viapoint/core/atomic_file.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/robot_description.hpp"

namespace viapoint {
namespace {

namespace fs = std::filesystem;

/// The directory set by the program, if any, guarded for use from any thread.
class ChosenDirectory {
 public:
  void set(fs::path path) {
    const std::lock_guard lock(mutex_);
    path_ = std::move(path);
  }
  [[nodiscard]] fs::path get() const {
    const std::lock_guard lock(mutex_);
    return path_;
  }

 private:
  mutable std::mutex mutex_;
  fs::path path_;
};

ChosenDirectory& chosen_directory() {
  static ChosenDirectory chosen;
  return chosen;
}

std::vector<fs::path> directories() {
  std::vector<fs::path> out;
  // getenv is safe here as long as nobody calls setenv at the same time, which viapoint never does.
  if (const char* variable = std::getenv("VIAPOINT_ROBOTS"); variable && *variable) {
    out.emplace_back(variable);
  }
  if (const fs::path chosen = chosen_directory().get(); !chosen.empty()) out.push_back(chosen);
  std::error_code failed;
  const fs::path executable = fs::read_symlink("/proc/self/exe", failed);
  if (!failed) {
    out.push_back(executable.parent_path().parent_path() / "share" / "viapoint" / "robots");
  }
  out.emplace_back(VIAPOINT_SOURCE_ROBOTS);
  return out;
}

fs::path find_builtin(const std::string& name) {
  for (const fs::path& directory : directories()) {
    const fs::path file = directory / (name + ".yaml");
    std::error_code failed;
    if (fs::is_regular_file(file, failed)) return file;
  }
  std::string known;
  for (const std::string& robot : builtin_robots()) known += (known.empty() ? "" : ", ") + robot;
  throw MotionError(ErrorCode::kBadRobot, "no robot is called \"" + name + "\"",
                    {"use one of: " + (known.empty() ? "(none found)" : known),
                     "give the path of a .yaml or .urdf file",
                     "set VIAPOINT_ROBOTS to the directory that holds the descriptions"});
}

}  // namespace

void set_robot_directory(const fs::path& directory) { chosen_directory().set(directory); }

std::vector<std::string> builtin_robots() {
  std::set<std::string> names;
  for (const fs::path& directory : directories()) {
    std::error_code failed;
    for (fs::directory_iterator entry(directory, failed), end; !failed && entry != end;
         entry.increment(failed)) {
      if (entry->path().extension() == ".yaml") names.insert(entry->path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

RobotDescription load_description(const std::string& name_or_path, const std::string& tip) {
  const fs::path path(name_or_path);
  if (path.extension() == ".yaml" || path.extension() == ".yml") {
    return description_from_yaml(read_file(path.string()), path.string());
  }
  if (path.extension() == ".urdf") {
    return description_from_urdf(read_file(path.string()), path.string(), tip);
  }
  if (name_or_path.empty() || name_or_path.find('/') != std::string::npos) {
    throw MotionError(
        ErrorCode::kBadRobot,
        "\"" + name_or_path + "\" is neither a built-in name nor a .yaml or .urdf file",
        {"name the file with its extension"});
  }
  const fs::path file = find_builtin(name_or_path);
  return description_from_yaml(read_file(file.string()), file.string());
}

}  // namespace viapoint
