// A process that is killed at any step of a write leaves the old file or the new one, whole.
#include <gtest/gtest.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "viapoint/core/atomic_file.hpp"

namespace viapoint {
namespace {

/// What became of a writer that was to be killed.
struct Fate {
  bool ended = false;                ///< by itself, before it came to be killed
  std::vector<unsigned long> calls;  ///< of the system, in order, that it had begun
};

/// Lets a process write the file in some pieces, and kills it where it enters or leaves a call of
/// the system for the `steps`-th time. @pre this process may trace its children
Fate write_and_kill(const std::string& path, const std::string& content, int steps) {
  const pid_t writer = ::fork();
  if (writer == 0) {
    ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    ::raise(SIGSTOP);
    AtomicFile file(path);
    constexpr size_t kPiece = 40'000;
    for (size_t at = 0; at < content.size(); at += kPiece) {
      file.write(std::string_view(content).substr(at, kPiece));
    }
    file.commit();
    ::_exit(0);
  }
  Fate fate;
  int status = 0;
  ::waitpid(writer, &status, 0);
  ::ptrace(PTRACE_SETOPTIONS, writer, nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL);
  for (int step = 0; step < steps; ++step) {
    ::ptrace(PTRACE_SYSCALL, writer, nullptr, nullptr);
    ::waitpid(writer, &status, 0);
    if (WIFEXITED(status)) {
      fate.ended = WEXITSTATUS(status) == 0;
      return fate;
    }
    __ptrace_syscall_info info{};  // of glibc
    ::ptrace(PTRACE_GET_SYSCALL_INFO, writer, sizeof info, &info);
    if (info.op == PTRACE_SYSCALL_INFO_ENTRY) fate.calls.push_back(info.entry.nr);
  }
  ::kill(writer, SIGKILL);
  ::waitpid(writer, &status, 0);
  return fate;
}

bool may_trace() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0 ? 0 : 1);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

class KilledWriter : public testing::Test {
 protected:
  void SetUp() override {
    if (!may_trace()) GTEST_SKIP() << "NOT tested: this process may not trace its children";
    folder_ = std::filesystem::temp_directory_path() /
              ("viapoint_killed_writer_" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path() const { return (folder_ / "points.json").string(); }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(folder_), {});
  }

  const std::string old_ = std::string(1000, 'o');
  const std::string new_ = std::string(100'000, 'n');

 private:
  std::filesystem::path folder_;
};

TEST_F(KilledWriter, LeavesTheOldFileOrTheNewAtEveryStep) {
  constexpr int kMostSteps = 1000;
  int steps = 0, olds = 0, news = 0;
  for (; steps < kMostSteps; ++steps) {
    write_file_atomically(path(), old_);  // which clears what the killed one left aside, too
    ASSERT_EQ(files(), 1) << steps;
    const Fate fate = write_and_kill(path(), new_, steps);
    const std::string found = read_file(path());
    if (fate.ended) {
      EXPECT_EQ(found, new_);
      break;
    }
    ASSERT_TRUE(found == old_ || found == new_)
        << "after step " << steps << " there are " << found.size() << " characters";
    ASSERT_FALSE(found == old_ && news > 0) << "step " << steps << " has brought the old one back";
    ++(found == old_ ? olds : news);
  }
  EXPECT_LT(steps, kMostSteps);
  EXPECT_GT(olds, 10);  // before the name is changed, and after
  EXPECT_GT(news, 2);
}

TEST_F(KilledWriter, FlushesTheFileBeforeItsNameAndItsNameAfter) {
  write_file_atomically(path(), old_);
  const Fate fate = write_and_kill(path(), new_, 1000);  // more steps than there are
  ASSERT_TRUE(fate.ended);
  const std::vector<unsigned long>& calls = fate.calls;
  const auto is_rename = [](unsigned long call) {
    return call == SYS_renameat || call == SYS_renameat2
#ifdef SYS_rename
           || call == SYS_rename
#endif
        ;
  };
  const auto renamed = std::find_if(calls.begin(), calls.end(), is_rename);
  ASSERT_NE(renamed, calls.end());
  const auto written = std::find(std::make_reverse_iterator(renamed), calls.rend(), SYS_write);
  ASSERT_NE(written, calls.rend());
  EXPECT_NE(std::find(written.base(), renamed, SYS_fsync), renamed)
      << "a power cut could leave the new name with nothing in it";
  EXPECT_NE(std::find(renamed, calls.end(), SYS_fsync), calls.end())
      << "a power cut could bring the old file back after the call has returned";
}

}  // namespace
}  // namespace viapoint
