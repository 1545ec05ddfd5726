#include "viapoint/core/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

class AtomicFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "viapoint-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(folder_), {});
  }

  std::filesystem::path folder_;
};

TEST_F(AtomicFiles, IsReadBackAndReplaced) {
  const std::string path = folder_ / "points.json";
  write_file_atomically(path, "old");
  write_file_atomically(path, "new");
  EXPECT_EQ(read_file(path), "new");
  // Nothing is left beside it.
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFiles, InPiecesReplacesTheOldFileWhenItIsCommittedOnly) {
  const std::string path = folder_ / "log.csv";
  write_file_atomically(path, "old");
  {
    AtomicFile file(path);
    for (const std::string_view piece : {"a", "", "bc"}) file.write(piece);
    EXPECT_EQ(read_file(path), "old");
    file.commit();
    EXPECT_EQ(read_file(path), "abc");
    file.discard();
    EXPECT_EQ(read_file(path), "abc");
  }
  EXPECT_EQ(read_file(path), "abc");
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFiles, ThatIsNotCommittedLeavesTheOldFileAndNothingElse) {
  const std::string path = folder_ / "log.csv";
  write_file_atomically(path, "old");
  {
    AtomicFile file(path);
    file.write("part");
    EXPECT_EQ(files(), 2);
  }
  EXPECT_EQ(files(), 1);
  AtomicFile file(path);
  file.write("part");
  file.discard();
  EXPECT_EQ(files(), 1);
  EXPECT_THROW(file.write("more"), MotionError);
  EXPECT_THROW(file.commit(), MotionError);
  EXPECT_EQ(read_file(path), "old");
}

TEST_F(AtomicFiles, HasTheRightsOfTheOldOneBeforeItsFirstPiece) {
  const std::string path = folder_ / "log.csv";
  write_file_atomically(path, "secret");
  ASSERT_EQ(::chmod(path.c_str(), 0600), 0);
  const AtomicFile file(path);
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    struct stat status{};
    ASSERT_EQ(::stat(entry.path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0600U) << entry.path();
  }
}

TEST_F(AtomicFiles, IsLeftAloneByAChildThatWasForkedMeanwhile) {
  const std::string path = folder_ / "log.csv";
  AtomicFile file(path);
  file.write("a");
  const pid_t child = ::fork();
  if (child == 0) {
    file.discard();
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  file.write("b");
  file.commit();
  EXPECT_EQ(read_file(path), "ab");
}

TEST_F(AtomicFiles, OnAFullDiskIsToldByNameAndLeavesNothing) {
  const std::string path = folder_ / "log.csv";
  write_file_atomically(path, "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  // SIG_IGN is the C library's macro: a handler made of a number.
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);  // NOLINT(performance-no-int-to-ptr)
  const rlimit small{10'000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string told;
  try {
    AtomicFile file(path);
    for (int piece = 0; piece < 3; ++piece) file.write(std::string(4'000, 'x'));
    file.commit();
  } catch (const MotionError& error) {
    told = error.what();
    EXPECT_NE(error.problem().ways_out.at(0).find("make room"), std::string::npos);
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  static_cast<void>(std::signal(SIGXFSZ, handler));
  EXPECT_NE(told.find(path), std::string::npos) << told;
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFiles, KeepsTheRightsOfTheFileItReplaces) {
  const std::string path = folder_ / "points.json";
  write_file_atomically(path, "old");
  std::filesystem::permissions(
      path, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  write_file_atomically(path, "new");
  struct stat status{};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(AtomicFiles, FollowsLinksAndWritesIntoDevices) {
  const std::string path = folder_ / "points.json";
  const std::string link = folder_ / "link.json";
  write_file_atomically(path, "old");
  std::filesystem::create_symlink(path, link);
  write_file_atomically(link, "new");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(read_file(path), "new");

  write_file_atomically("/dev/null", "gone");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(AtomicFiles, HonoursTheUmask) {
  const std::string path = folder_ / "secret.json";
  const mode_t before = ::umask(077);
  write_file_atomically(path, "x");
  ::umask(before);
  struct stat status{};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST_F(AtomicFiles, RefusesByNameWhereItCannotWriteOrRead) {
  const auto expect_named = [](const auto& action, const std::string& path) {
    try {
      action();
      FAIL() << path;
    } catch (const MotionError& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFile);
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    }
  };
  const std::string nowhere = folder_ / "no" / "such" / "folder.json";
  expect_named([&] { write_file_atomically(nowhere, "x"); }, nowhere);
  expect_named([&] { (void)read_file(nowhere); }, nowhere);
  expect_named([&] { (void)read_file(folder_); }, folder_);
}

TEST_F(AtomicFiles, RefusesANameWithANulCharacter) {
  const std::string path = folder_ / "a";
  write_file_atomically(path, "precious");
  const std::string other = path + std::string("\0b.json", 7);
  EXPECT_THROW(write_file_atomically(other, "x"), MotionError);
  EXPECT_THROW((void)read_file(other), MotionError);
  EXPECT_EQ(read_file(path), "precious");
  try {
    write_file_atomically(other, "x");
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFile);
    EXPECT_NE(std::string(error.what()).find("a\\0b.json"), std::string::npos) << error.what();
  }
}

TEST_F(AtomicFiles, TellsAWayOut) {
  for (const auto& path : {folder_ / "no" / "such.json", folder_, std::filesystem::path()}) {
    try {
      (void)read_file(path.string());
      ADD_FAILURE() << path;
    } catch (const MotionError& error) {
      EXPECT_FALSE(error.problem().ways_out.empty()) << error.what();
    }
  }
}

/// A number that no process has any more.
pid_t process_that_ended() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST_F(AtomicFiles, RemovesWhatKilledProcessesLeftOfTheSameFileAndNothingElse) {
  const std::string dead = std::to_string(process_that_ended());
  const std::string alive = std::to_string(::getppid());
  const std::vector<std::string> gone{".p.json." + dead + "-0", ".p.json." + dead + "-17"};
  const std::vector<std::string> kept{".p.json." + alive + "-0", ".p.json." + dead,
                                      ".p.json." + dead + "-x",  ".q.json." + dead + "-0",
                                      "p.json." + dead + "-0",   ".p.json.lock",
                                      ".p.json." + dead + "-",   ".p.json.-1-0"};
  for (const auto* names : {&gone, &kept}) {
    for (const std::string& name : *names) std::ofstream(folder_ / name) << "part";
  }
  write_file_atomically(folder_ / "p.json", "whole");
  for (const std::string& name : gone) EXPECT_FALSE(exists(folder_ / name)) << name;
  for (const std::string& name : kept) EXPECT_TRUE(exists(folder_ / name)) << name;
}

TEST_F(AtomicFiles, LeavesALeftoverThatSomebodyHoldsLocked) {
  const std::filesystem::path name =
      folder_ / (".p.json." + std::to_string(process_that_ended()) + "-0");
  const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  ASSERT_EQ(::flock(file, LOCK_EX), 0);
  write_file_atomically(folder_ / "p.json", "whole");
  EXPECT_TRUE(exists(name));
  ::close(file);
  write_file_atomically(folder_ / "p.json", "whole");
  EXPECT_FALSE(exists(name));
}

TEST_F(AtomicFiles, SurvivesKillAtAnyMoment) {
  // A child writes two contents in turn as fast as it can and is killed at varying moments; what
  // is found must be one of them, whole.
  const std::string path = folder_ / "points.json";
  const std::string a(200'000, 'a');
  const std::string b(300'000, 'b');
  write_file_atomically(path, a);
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE(trial);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      for (;;) {
        write_file_atomically(path, b);
        write_file_atomically(path, a);
      }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(500 + 777 * trial));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const std::string found = read_file(path);
    ASSERT_TRUE(found == a || found == b) << found.size();
  }
}

}  // namespace
}  // namespace viapoint
