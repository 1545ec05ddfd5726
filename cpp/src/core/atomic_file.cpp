#include "viapoint/core/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
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

/// A new file beside `target`: rename is atomic only within one file system. Gone with the object,
/// unless it was renamed. Its rights are those of any new file.
class Aside {
 public:
  Aside(const std::filesystem::path& target, const std::string& path)
      : name_(free_name(target)),
        file_(::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
    if (file_.get() < 0) fail("cannot create a file beside it", path);
  }
  ~Aside() { ::unlink(name_.c_str()); }
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;
  [[nodiscard]] int fd() const { return file_.get(); }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  /// Nobody else's: this process, and a count within it.
  static std::string free_name(const std::filesystem::path& target) {
    static std::atomic<unsigned> count{0};
    const std::string suffix = "." + std::to_string(::getpid()) + "-" + std::to_string(count++);
    std::string name =
        (target.parent_path() / ("." + target.filename().string() + suffix)).string();
    ::unlink(name.c_str());  // left behind by a process of that number that was killed
    return name;
  }

  std::string name_;
  Descriptor file_;
};

/// A device or a pipe has no old content to keep: it is written to, never replaced.
void write_through(const std::string& path, std::string_view content) {
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0) fail("cannot open", path);
  write_all(file.get(), content, path);
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view content) {
  struct stat old{};
  const bool exists = ::stat(path.c_str(), &old) == 0;
  if (exists && !S_ISREG(old.st_mode)) {
    write_through(path, content);
    return;
  }
  // A link stays a link: what it points to is replaced.
  std::error_code unresolved;
  std::filesystem::path target = std::filesystem::weakly_canonical(path, unresolved);
  if (unresolved) target = path;
  const std::filesystem::path folder =
      target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");

  const Aside aside(target, path);
  write_all(aside.fd(), content, path);
  if (exists && ::fchmod(aside.fd(), old.st_mode & 07777U) != 0)
    fail("cannot set the rights", path);
  if (::fsync(aside.fd()) != 0) fail("cannot flush to disk", path);
  if (::rename(aside.name().c_str(), target.c_str()) != 0) fail("cannot rename into place", path);
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
