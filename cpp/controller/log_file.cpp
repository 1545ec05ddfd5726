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

[[noreturn]] void refuse(const std::string& path, int reason) {
  Problem problem;
  problem.code = ErrorCode::kFile;
  problem.file = path;
  problem.message = std::string("the log cannot be written there: ") + std::strerror(reason);
  problem.ways_out = {"give a file in a folder that exists and may be written to"};
  throw MotionError(std::move(problem));
}

}  // namespace

void check_log_can_be_written(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (path.empty() || path.back() == '/' || fs::is_directory(path, ignored)) refuse(path, EISDIR);
  // Trying is the only sure way: rights, full and read-only disks and quotas all have their say.
  std::string probe = path + ".XXXXXX";
  const int file = ::mkstemp(probe.data());
  if (file < 0) refuse(path, errno);
  ::close(file);
  ::unlink(probe.c_str());
}

}  // namespace viapoint::controller
