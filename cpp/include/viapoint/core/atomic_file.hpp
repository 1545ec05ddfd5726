/// @file
#pragma once

#include <string>
#include <string_view>

namespace viapoint {

/// Writes a whole file so that a crash at any moment leaves the old content or the new, never a
/// part: write aside in the same folder, fsync, rename, fsync the folder. What processes that were
/// killed meanwhile left of the same file is removed.
/// Real-time: not. Threads: any. @throws MotionError(kFile) naming the path and the system's
/// reason,
///   and for a path with a NUL character
void write_file_atomically(const std::string& path, std::string_view content);
/// The whole text of a file. @throws MotionError(kFile) as above
[[nodiscard]] std::string read_file(const std::string& path);

}  // namespace viapoint
