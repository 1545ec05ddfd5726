#include "viapoint/core/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

std::string way_out(int reason) {
  switch (reason) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "make room on the disk, or give a file on another one";
    case EISDIR:
      return "give a file, this is a folder";
    case EACCES:
    case EPERM:
    case EROFS:
      return "give a file and a folder that this user has the rights for";
    default:
      return "check the path: the file, and every folder on the way to it";
  }
}

/// What follows a NUL is lost on the way to the system: another file would be read or replaced.
void require_whole(const std::string& path) {
  const size_t end = path.find('\0');
  if (end == std::string::npos) return;
  Problem problem;
  problem.code = ErrorCode::kFile;
  problem.file = path.substr(0, end) + "\\0" + path.substr(end + 1);
  problem.file.erase(std::remove(problem.file.begin(), problem.file.end(), '\0'),
                     problem.file.end());
  problem.message = "the name of a file cannot hold a NUL character";
  problem.ways_out = {"give the name without it"};
  throw MotionError(std::move(problem));
}

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  Problem problem;
  problem.code = ErrorCode::kFile;
  problem.file = path;
  problem.message = what + ": " + std::strerror(errno);
  problem.ways_out = {way_out(errno)};
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

/// A name beside `target` that is nobody else's: this process, and a count within it. What a
/// process of that number that was killed left there is removed.
std::string free_name(const std::filesystem::path& target) {
  static std::atomic<unsigned> count{0};
  const std::string suffix = "." + std::to_string(::getpid()) + "-" + std::to_string(count++);
  std::string name = (target.parent_path() / ("." + target.filename().string() + suffix)).string();
  ::unlink(name.c_str());
  return name;
}

/// The process that a name made by free_name() for `target` tells, or 0 for any other name.
pid_t maker_of(const std::string& name, const std::filesystem::path& target) {
  const std::string start = "." + target.filename().string() + ".";
  if (name.compare(0, start.size(), start) != 0) return 0;
  const char* end = name.data() + name.size();
  pid_t process = 0;
  const auto [dash, no_number] = std::from_chars(name.data() + start.size(), end, process);
  if (no_number != std::errc() || dash == end || *dash != '-' || dash + 1 == end) return 0;
  return std::all_of(dash + 1, end, [](char c) { return c >= '0' && c <= '9'; }) ? process : 0;
}

std::filesystem::path folder_of(const std::filesystem::path& target) {
  return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
}

/// Removes what killed processes left beside `target`. A file whose process lives is not touched,
/// and neither is one that is still locked: its process may live where its number means another,
/// in a container for one. What cannot be removed stays; it does no harm but to the eye.
void remove_leftovers(const std::filesystem::path& target, const std::filesystem::path& folder) {
  std::error_code failed;
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const pid_t maker = maker_of(entry->path().filename().string(), target);
    if (maker <= 0 || ::kill(maker, 0) == 0 || errno != ESRCH) continue;
    const Descriptor file(
        ::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (file.get() < 0 || ::flock(file.get(), LOCK_EX | LOCK_NB) != 0) continue;
    ::unlink(entry->path().c_str());
  }
}

}  // namespace

/// The open file: a new one beside the target, since rename is atomic only within one file system,
/// or the device or pipe itself, which has no old content to keep.
class AtomicFile::Open {
 public:
  /// A device.
  explicit Open(const std::string& path) : file_(::open(path.c_str(), O_WRONLY | O_CLOEXEC)) {
    if (file_.get() < 0) fail("cannot open", path);
  }
  /// A file beside `target`. Its rights are those of any new file.
  Open(std::filesystem::path target, const std::string& path)
      : target_(std::move(target)),
        name_(free_name(target_)),
        file_(::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
    if (file_.get() < 0) fail("cannot create a file beside it", path);
    // Held until the process ends, however it ends: tells others that this is no leftover.
    ::flock(file_.get(), LOCK_EX | LOCK_NB);
  }
  /// Gone with the object, unless it was renamed; a child that was forked meanwhile leaves it.
  ~Open() {
    if (!name_.empty() && maker_ == ::getpid()) ::unlink(name_.c_str());
  }
  Open(const Open&) = delete;
  Open& operator=(const Open&) = delete;

  [[nodiscard]] int fd() const { return file_.get(); }

  /// To the disk, and under the target's name.
  void put_in_place(const std::string& path) {
    if (name_.empty()) return;
    if (::fsync(fd()) != 0) fail("cannot flush to disk", path);
    if (::rename(name_.c_str(), target_.c_str()) != 0) fail("cannot rename into place", path);
    name_.clear();
    const Descriptor directory(
        ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (directory.get() < 0 || ::fsync(directory.get()) != 0) {
      fail("written, but the folder could not be flushed to disk", path);
    }
  }

 private:
  std::filesystem::path target_;
  std::string name_;  ///< empty: nothing is to be removed
  pid_t maker_ = ::getpid();
  Descriptor file_;
};

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
  require_whole(path);
  struct stat old{};
  const bool exists = ::stat(path.c_str(), &old) == 0;
  if (exists && !S_ISREG(old.st_mode)) {
    open_ = std::make_unique<Open>(path);
    return;
  }
  // A link stays a link: what it points to is replaced.
  std::error_code unresolved;
  std::filesystem::path target = std::filesystem::weakly_canonical(path, unresolved);
  if (unresolved) target = path;
  remove_leftovers(target, folder_of(target));
  open_ = std::make_unique<Open>(std::move(target), path);
  // Before the first byte: who may not read the old content may not read the new.
  if (exists && ::fchmod(open_->fd(), old.st_mode & 07777U) != 0)
    fail("cannot set the rights", path);
}

AtomicFile::~AtomicFile() = default;

void AtomicFile::write(std::string_view piece) {
  require_open();
  write_all(open_->fd(), piece, path_);
}

void AtomicFile::commit() {
  require_open();
  open_->put_in_place(path_);
  open_.reset();
}

void AtomicFile::discard() { open_.reset(); }

void AtomicFile::require_open() const {
  if (open_) return;
  Problem problem;
  problem.code = ErrorCode::kFile;
  problem.file = path_;
  problem.message = "cannot write: the file was committed or discarded before";
  problem.ways_out = {"begin another one"};
  throw MotionError(std::move(problem));
}

void write_file_atomically(const std::string& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

std::string read_file(const std::string& path) {
  require_whole(path);
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
