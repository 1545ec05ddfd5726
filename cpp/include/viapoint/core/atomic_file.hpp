/// @file
#pragma once

#include <string>
#include <string_view>

namespace viapoint {

/// Writes a whole file so that a crash at any moment leaves the old content or the new, never a
/// part: write aside in the same folder, fsync, rename, fsync the folder.
/// Real-time: not. @throws MotionError(kFile) naming the path and the system's reason
void write_file_atomically(const std::string& path, std::string_view content);
/// @throws MotionError(kFile)
[[nodiscard]] std::string read_file(const std::string& path);

}  // namespace viapoint
