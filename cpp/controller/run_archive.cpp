#include "controller/run_archive.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <utility>

#include "controller/log_file.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/realtime/log_csv.hpp"

namespace viapoint::controller {
namespace {

constexpr std::chrono::milliseconds kPeriod{50};

std::string file_of(const std::string& folder, std::uint64_t number) {
  const std::string name =
      fmt::format("{:%Y%m%dT%H%M%SZ}-run{}.csv", fmt::gmtime(std::time(nullptr)), number);
  return std::filesystem::path(folder) / name;
}

}  // namespace

RunArchive::RunArchive(const std::string& folder) : folder_(folder) {
  check_log_can_be_written(file_of(folder, 0));
  thread_ = std::jthread([this](const std::stop_token& stop) { follow(stop); });
}

RunArchive::~RunArchive() = default;

void RunArchive::add(std::uint64_t number, std::shared_ptr<Job> job) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back({number, std::move(job)});
  if (waiting_.size() <= kMostWaiting) return;
  spdlog::error("the log of run {} was dropped before it could be written",
                waiting_.front().number);
  waiting_.pop_front();
}

void RunArchive::follow(const std::stop_token& stop) {
  bool was_asked = false;
  while (!was_asked) {
    was_asked = stop.stop_requested();  // one look more after that
    for (Run run = first(); run.job != nullptr && archive(run); run = first()) {
      const std::lock_guard lock(mutex_);
      if (!waiting_.empty() && waiting_.front().number == run.number) waiting_.pop_front();
    }
    if (!was_asked) std::this_thread::sleep_for(kPeriod);
  }
}

RunArchive::Run RunArchive::first() {
  const std::lock_guard lock(mutex_);
  return waiting_.empty() ? Run{} : waiting_.front();
}

bool RunArchive::archive(const Run& run) const {
  try {
    if (!run.job->wait(0.0)) return false;
  } catch (const MotionError& error) {
    spdlog::error("run {}: {}", run.number, error.problem().message);
  }
  try {
    write_log_csv(file_of(folder_, run.number), run.job->log());
  } catch (const MotionError& error) {
    spdlog::error("the log of run {} was not written: {}", run.number, error.problem().describe());
  }
  return true;
}

}  // namespace viapoint::controller
