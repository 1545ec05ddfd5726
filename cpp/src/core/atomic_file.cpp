#include "viapoint/core/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  Problem problem;
  problem.code = ErrorCode::kFile;
  problem.file = path;
  problem.message = what + ": " + std::strerror(errno);
  throw MotionError(std::move(problem));
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

void write_all(int fd, std::string_view content, const std::string& path) {
  while (!content.empty()) {
    const ssize_t written = ::write(fd, content.data(), content.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot write", path);
    }
    content.remove_prefix(static_cast<size_t>(written));
  }
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view content) {
  const std::filesystem::path target(path);
  const std::filesystem::path folder =
      target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
  // The same folder: rename is atomic only within one file system.
  std::string aside = (folder / ("." + target.filename().string() + ".XXXXXX")).string();
  const Descriptor file(::mkstemp(aside.data()));
  if (file.get() < 0) fail("cannot create a file beside it", path);
  try {
    write_all(file.get(), content, path);
    // mkstemp makes the file private; keep the rights of the one replaced, else the usual ones.
    struct stat old{};
    const mode_t mode = ::stat(path.c_str(), &old) == 0 ? old.st_mode & 07777U : 0644U;
    if (::fchmod(file.get(), mode) != 0) fail("cannot set the rights", path);
    if (::fsync(file.get()) != 0) fail("cannot flush to disk", path);
    if (::rename(aside.c_str(), path.c_str()) != 0) fail("cannot rename into place", path);
  } catch (...) {
    ::unlink(aside.c_str());
    throw;
  }
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.get() < 0 || ::fsync(directory.get()) != 0) {
    fail("written, but the folder could not be flushed to disk", path);
  }
}

std::string read_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    errno = EISDIR;
    fail("cannot read", path);
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail("cannot open", path);
  std::ostringstream content;
  content << file.rdbuf();
  if (file.bad()) fail("cannot read", path);
  return std::move(content).str();
}

}  // namespace viapoint
