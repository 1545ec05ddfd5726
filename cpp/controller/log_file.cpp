#include "controller/log_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "viapoint/core/error.hpp"

namespace viapoint::controller {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& message,
                         const std::string& way_out) {
  Problem problem;
  problem.code = ErrorCode::kFile;
  problem.file = path;
  problem.message = message;
  problem.ways_out = {way_out};
  throw MotionError(std::move(problem));
}

[[noreturn]] void refuse(const std::string& path, int reason) {
  refuse(path, std::string("the log cannot be written there: ") + std::strerror(reason),
         "give a file in a folder that exists and may be written to");
}

}  // namespace

void check_log_can_be_written(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (path.empty() || path.back() == '/' || fs::is_directory(path, ignored)) refuse(path, EISDIR);
  // Trying is the only sure way: rights, quotas of files and read-only disks all have their say.
  // Whether there is room for the log is not known before it is there.
  std::string probe = path + ".XXXXXX";
  const int file = ::mkstemp(probe.data());
  if (file < 0) refuse(path, errno);
  ::close(file);
  ::unlink(probe.c_str());
}

void check_log_is_no_input(const std::string& log, const std::string& input) {
  namespace fs = std::filesystem;
  std::error_code not_there;
  // By what the names lead to, so that links and other ways of writing a path are seen through.
  if (!fs::is_regular_file(input, not_there) || !fs::equivalent(log, input, not_there)) return;
  refuse(log, "the log would overwrite " + input + ", which the run is read from",
         "give the log a name of its own: --log log.csv");
}

}  // namespace viapoint::controller
