#include "viapoint/realtime/log_csv.hpp"

#include <array>
#include <charconv>

#include "viapoint/core/atomic_file.hpp"

namespace viapoint {
namespace {

template <typename Number>
void append(std::string& text, Number value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

template <typename Number>
void append_field(std::string& text, Number value) {
  text += ',';
  append(text, value);
}

void append_names(std::string& text, const char* name, Eigen::Index joints) {
  for (Eigen::Index i = 1; i <= joints; ++i) {
    text += ',';
    text += name;
    append(text, i);
  }
}

void append_vector(std::string& text, const JointVector& values, Eigen::Index joints) {
  for (Eigen::Index i = 0; i < joints; ++i) {
    if (i < values.size()) {
      append_field(text, values[i]);
    } else {
      text += ',';
    }
  }
}

Eigen::Index joints_of(std::span<const LogRecord> records) {
  return records.empty() ? 0 : records.front().q.size();
}

std::string heading(Eigen::Index joints) {
  std::string text = "cycle,stamp_ns,latency_ns,compute_ns,nominal_time,rate,move,state,outputs";
  for (const char* name : {"q", "qd", "qdd", "qddd", "measured"}) append_names(text, name, joints);
  text += '\n';
  return text;
}

void append_row(std::string& text, const LogRecord& record, Eigen::Index joints) {
  append(text, record.cycle);
  append_field(text, record.stamp);
  append_field(text, record.latency);
  append_field(text, record.compute);
  append_field(text, record.nominal_time);
  append_field(text, record.rate);
  append_field(text, record.move);
  text += ',';
  text += to_string(record.state);
  append_field(text, record.outputs);
  for (const JointVector* values :
       {&record.q, &record.qd, &record.qdd, &record.qddd, &record.measured}) {
    append_vector(text, *values, joints);
  }
  text += '\n';
}

}  // namespace

std::string log_to_csv(std::span<const LogRecord> records) {
  const Eigen::Index joints = joints_of(records);
  std::string text = heading(joints);
  for (const LogRecord& record : records) append_row(text, record, joints);
  return text;
}

void write_log_csv(const std::string& path, std::span<const LogRecord> records) {
  constexpr size_t kPiece = size_t{1} << 18;  // hours are never text in memory as a whole
  AtomicFile file(path);
  const Eigen::Index joints = joints_of(records);
  std::string text = heading(joints);
  for (const LogRecord& record : records) {
    append_row(text, record, joints);
    if (text.size() < kPiece) continue;
    file.write(text);
    text.clear();
  }
  file.write(text);
  file.commit();
}

}  // namespace viapoint
