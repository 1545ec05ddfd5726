/// @file
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace viapoint {

/// A file that is written piece by piece so that a crash at any moment leaves the old content or
/// the new, never a part: written aside in the same folder; then fsync, rename, fsync of the
/// folder. What processes that were killed meanwhile left of the same file is removed. A device or
/// a pipe has no old content to keep: it is written to, never replaced.
/// Real-time: not. Threads: one at a time.
class AtomicFile {
 public:
  /// Begins aside; it has the rights of the file that it is to replace. @throws MotionError(kFile)
  /// naming the path and the system's reason, and for a path with a NUL character
  explicit AtomicFile(const std::string& path);
  /// Leaves nothing of what was not committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// @throws MotionError(kFile) as above, and once it was committed or discarded
  void write(std::string_view piece);
  /// What was written takes the place of the old content. @throws MotionError(kFile) as write()
  void commit();
  /// Removes what was written; the old content stays. Nothing after commit().
  void discard();

 private:
  class Open;
  void require_open() const;

  std::string path_;
  std::unique_ptr<Open> open_;  ///< null: committed or discarded
};

/// The same with all of its content at once.
/// Real-time: not. Threads: any. @throws MotionError(kFile) as AtomicFile
void write_file_atomically(const std::string& path, std::string_view content);
/// The whole text of a file. @throws MotionError(kFile) as above
[[nodiscard]] std::string read_file(const std::string& path);

}  // namespace viapoint
