// Runs as Python sees them: jobs, their reports, and what is logged of them.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "run_handles.hpp"
#include "viapoint/realtime/log_csv.hpp"

namespace viapoint::python {
namespace {

using Release = py::gil_scoped_release;

template <typename T, typename Get>
py::array_t<T> column(const std::vector<LogRecord>& records, Get get) {
  py::array_t<T> out(static_cast<py::ssize_t>(records.size()));
  T* data = out.mutable_data();
  for (const LogRecord& record : records) *data++ = static_cast<T>(get(record));
  return out;
}

Array rows(const std::vector<LogRecord>& records, int joints, JointVector LogRecord::* member) {
  Array out({static_cast<py::ssize_t>(records.size()), static_cast<py::ssize_t>(joints)});
  double* data = out.mutable_data();
  for (const LogRecord& record : records) {
    const JointVector& values = record.*member;
    // A record without a value (nothing measured in a simulated run) reads as NaN.
    for (int i = 0; i < joints; ++i) *data++ = i < values.size() ? values[i] : std::nan("");
  }
  return out;
}

Columns columns_of(const LogHandle& log) {
  const std::vector<LogRecord>& records = log.records;
  const int joints = log.joints;
  Columns out;
  out["cycle"] = column<std::uint64_t>(records, [](const LogRecord& r) { return r.cycle; });
  out["stamp"] = column<std::int64_t>(records, [](const LogRecord& r) { return r.stamp; });
  out["latency"] = column<std::int64_t>(records, [](const LogRecord& r) { return r.latency; });
  out["compute"] = column<std::int64_t>(records, [](const LogRecord& r) { return r.compute; });
  out["nominal_time"] = column<double>(records, [](const LogRecord& r) { return r.nominal_time; });
  out["rate"] = column<double>(records, [](const LogRecord& r) { return r.rate; });
  out["move"] = column<std::int32_t>(records, [](const LogRecord& r) { return r.move; });
  out["state"] = column<std::uint8_t>(records, [](const LogRecord& r) { return r.state; });
  out["outputs"] = column<std::uint64_t>(records, [](const LogRecord& r) { return r.outputs; });
  out["q"] = rows(records, joints, &LogRecord::q);
  out["qd"] = rows(records, joints, &LogRecord::qd);
  out["qdd"] = rows(records, joints, &LogRecord::qdd);
  out["qddd"] = rows(records, joints, &LogRecord::qddd);
  out["measured"] = rows(records, joints, &LogRecord::measured);
  return out;
}

std::vector<std::string> run_states() {
  std::vector<std::string> states;
  for (int i = 0; i <= static_cast<int>(RunState::kWaiting); ++i) {
    states.emplace_back(to_string(static_cast<RunState>(i)));
  }
  return states;
}

template <typename T>
py::array_t<T> column_named(const Columns& columns, const std::string& name,
                            std::vector<py::ssize_t> shape) {
  if (!columns.contains(name)) {
    throw MotionError(ErrorCode::kBadArgument, "The log lacks the column \"" + name + "\".");
  }
  const auto column =
      py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(columns[name.c_str()]);
  if (!column ||
      !std::equal(column.shape(), column.shape() + column.ndim(), shape.begin(), shape.end())) {
    throw MotionError(ErrorCode::kBadArgument,
                      "The log's column \"" + name + "\" does not fit the others in shape.");
  }
  return column;
}

/// The opposite of columns_of: a log that was read from a file.
LogHandle log_of(const Columns& columns) {
  const auto q = py::array::ensure(columns.contains("q") ? py::object(columns["q"]) : py::none());
  if (!q || q.ndim() != 2 || q.shape(1) < 1 || q.shape(1) > kMaxJoints) {
    throw MotionError(ErrorCode::kBadArgument, "The log's column \"q\" must be (k, n).");
  }
  const py::ssize_t count = q.shape(0);
  const py::ssize_t joints = q.shape(1);
  LogHandle log{std::vector<LogRecord>(static_cast<size_t>(count)), static_cast<int>(joints)};
  const auto fill = [&]<typename T>(const std::string& name, T LogRecord::* member) {
    const py::array_t<T> values = column_named<T>(columns, name, {count});
    for (size_t k = 0; k < log.records.size(); ++k) log.records[k].*member = values.data()[k];
  };
  fill("cycle", &LogRecord::cycle);
  fill("stamp", &LogRecord::stamp);
  fill("latency", &LogRecord::latency);
  fill("compute", &LogRecord::compute);
  fill("nominal_time", &LogRecord::nominal_time);
  fill("rate", &LogRecord::rate);
  fill("move", &LogRecord::move);
  fill("outputs", &LogRecord::outputs);
  const py::array_t<std::uint8_t> states = column_named<std::uint8_t>(columns, "state", {count});
  for (size_t k = 0; k < log.records.size(); ++k) {
    if (states.data()[k] > static_cast<std::uint8_t>(RunState::kWaiting)) {
      throw MotionError(ErrorCode::kBadArgument, "The log's column \"state\" holds no state.");
    }
    log.records[k].state = static_cast<RunState>(states.data()[k]);
  }
  const auto fill_rows = [&](const std::string& name, JointVector LogRecord::* member) {
    const py::array_t<double> values = column_named<double>(columns, name, {count, joints});
    for (size_t k = 0; k < log.records.size(); ++k) {
      const Eigen::Map<const Eigen::VectorXd> row(
          values.data() + static_cast<py::ssize_t>(k) * joints, joints);
      // As rows() tells a record without a value.
      if (!row.array().isNaN().all()) log.records[k].*member = row;
    }
  };
  fill_rows("q", &LogRecord::q);
  fill_rows("qd", &LogRecord::qd);
  fill_rows("qdd", &LogRecord::qdd);
  fill_rows("qddd", &LogRecord::qddd);
  fill_rows("measured", &LogRecord::measured);
  return log;
}

/// Numbers are the shortest text that reads back to the same bits.
std::string json_list(std::span<const double> values) {
  std::string text = "[";
  for (const double value : values) {
    if (text.size() > 1) text += ',';
    if (!std::isfinite(value)) {
      text += "null";
      continue;
    }
    const size_t begin = text.size();
    std::array<char, 32> digits;
    text.append(digits.data(),
                std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
    // Without a point it would be read as an integer, and there is no integer -0.
    if (text.find_first_of(".e", begin) == std::string::npos) text += ".0";
  }
  return text += ']';
}

/// Hours of cycles are tens of millions of numbers, which Python writes in ten times the time.
std::vector<std::string> json_rows(const py::array_t<double, py::array::c_style>& values) {
  if (values.ndim() != 2) {
    throw MotionError(ErrorCode::kBadArgument, "values must be a matrix, (k, n).");
  }
  const auto width = static_cast<size_t>(values.shape(1));
  std::vector<std::string> texts;
  texts.reserve(static_cast<size_t>(values.shape(0)));
  for (py::ssize_t k = 0; k < values.shape(0); ++k) {
    texts.push_back(json_list({values.data() + static_cast<size_t>(k) * width, width}));
  }
  return texts;
}

void bind_log(py::module_& m) {
  m.def("json_rows", &json_rows, py::arg("values"),
        "Each row of a matrix as a list in JSON; null is no finite number.");
  py::class_<LogHandle>(m, "Log", "Every cycle of a run as it was executed.")
      .def("__len__", [](const LogHandle& log) { return log.records.size(); })
      .def("columns", &columns_of, "A dict of arrays, one row a cycle.")
      .def_static("of_columns", &log_of, py::arg("columns"),
                  "A log of what columns() returned, one row a cycle.")
      .def(
          "head",
          [](const LogHandle& log, size_t count) {
            const auto end = std::min(count, log.records.size());
            return LogHandle{{log.records.begin(), log.records.begin() + static_cast<long>(end)},
                             log.joints};
          },
          py::arg("count"), "The first `count` cycles.")
      .def(
          "save_csv",
          [](const LogHandle& log, const std::string& path) { write_log_csv(path, log.records); },
          py::arg("path"), py::call_guard<Release>(),
          "Writes the same table as viapoint-controller --log.");
}

Wish wish_of(const std::string& action) {
  if (action == "pause") return Wish::kPause;
  if (action == "resume") return Wish::kRun;
  if (action == "stop") return Wish::kStop;
  throw MotionError(ErrorCode::kBadArgument, "\"" + action + "\" is nothing that an input can do.",
                    {"Use \"pause\", \"resume\" or \"stop\"."});
}

void bind_job(py::module_& m) {
  py::class_<RunReport>(m, "RunReport", "Figures of one run; times in seconds.")
      .def_readonly("cycles", &RunReport::cycles)
      .def_readonly("overruns", &RunReport::overruns,
                    "Cycles that woke a whole cycle late or more.")
      .def_readonly("latency_p50", &RunReport::latency_p50)
      .def_readonly("latency_p99", &RunReport::latency_p99)
      .def_readonly("latency_max", &RunReport::latency_max)
      .def_readonly("compute_p50", &RunReport::compute_p50)
      .def_readonly("compute_p99", &RunReport::compute_p99)
      .def_readonly("compute_max", &RunReport::compute_max)
      .def_readonly("wall_time", &RunReport::wall_time, "First to last cycle.")
      .def_readonly("missed_cycles", &RunReport::missed_cycles,
                    "Cycles that overruns slept through.")
      .def_readonly("lost_records", &RunReport::lost_records,
                    "Cycles that found no room in the log.")
      .def_readonly("rested_cycles", &RunReport::rested_cycles,
                    "Cycles at rest that left no record.");
  py::class_<JobHandle>(m, "Job", "One motion under way.")
      .def(
          "wait", [](const JobHandle& j, double timeout) { return j.job->wait(timeout); },
          py::arg("timeout"), py::call_guard<Release>())
      .def(
          "pause", [](const JobHandle& j) { j.job->pause(); }, py::call_guard<Release>())
      .def(
          "resume", [](const JobHandle& j) { j.job->resume(); }, py::call_guard<Release>())
      .def(
          "step", [](const JobHandle& j) { j.job->step(); }, py::call_guard<Release>())
      .def(
          "backward", [](const JobHandle& j) { j.job->backward(); }, py::call_guard<Release>())
      .def(
          "stop",
          [](const JobHandle& j, int category) {
            j.job->stop(category == 1 ? StopCategory::kRelease : StopCategory::kHold);
          },
          py::arg("category"), py::call_guard<Release>())
      .def(
          "on_input",
          [](const JobHandle& j, std::int16_t input, bool value, const std::string& action) {
            j.job->on_input({input, value, wish_of(action)});
          },
          py::arg("input"), py::arg("value"), py::arg("action"))
      .def_property_readonly(
          "state", [](const JobHandle& j) { return std::string(to_string(j.job->state())); })
      .def_property_readonly(
          "awaited",
          [](const JobHandle& j) -> std::optional<std::tuple<int, bool, double>> {
            const std::optional<InputWait> wait = j.job->awaited();
            if (!wait) return std::nullopt;
            return std::tuple{static_cast<int>(wait->input), wait->value, wait->timeout};
          },
          "Input, value and time-out [s] that the run rests for, if it does.")
      .def_property_readonly("nominal_time",
                             [](const JobHandle& j) { return j.job->nominal_time(); })
      .def_property_readonly("duration", [](const JobHandle& j) { return j.job->duration(); })
      .def_property_readonly("overruns", [](const JobHandle& j) { return j.job->overruns(); })
      .def_property_readonly("move", [](const JobHandle& j) { return j.job->move(); })
      .def(
          "log", [](const JobHandle& j) { return LogHandle{j.job->log(), j.joints}; },
          py::call_guard<Release>())
      .def("report", [](const JobHandle& j) { return j.job->report(); }, py::call_guard<Release>());
}

}  // namespace

void bind_run(py::module_& m) {
  bind_log(m);
  bind_job(m);
  m.def("run_states", &run_states, "Every state's name, in the order of the C++ enum.");
}

}  // namespace viapoint::python
