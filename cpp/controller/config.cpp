#include "controller/config.hpp"

#include <arpa/inet.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <tuple>
#include <utility>

#include "kinematics/yaml_documents.hpp"
#include "kinematics/yaml_map.hpp"
#include "viapoint/core/atomic_file.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/number_text.hpp"

namespace viapoint::controller {
namespace {

/// A number in a range. @throws MotionError with key and range
double number_in(const YamlValue& value, double least, double most, const char* unit) {
  const double number = value.number();
  if (!(number >= least && number <= most)) {
    value.refuse("is " + number_text(number) + "; allowed are " + number_text(least) + " to " +
                 number_text(most) + ' ' + unit);
  }
  return number;
}

std::chrono::nanoseconds time_in(const YamlValue& value, double least, double most) {
  return std::chrono::nanoseconds(std::llround(number_in(value, least, most, "s") * 1e9));
}

/// "127.0.0.1:7420", "[::1]:7420": the host as it stands there, and the port.
std::pair<std::string, int> read_address(const YamlValue& value) {
  const std::string text = value.text();
  const std::size_t colon = text.rfind(':');
  const std::string host = text.substr(0, colon == std::string::npos ? 0 : colon);
  const std::string port = text.substr(colon + 1);
  const bool is_port = !port.empty() && port.size() <= 5 &&
                       port.find_first_not_of("0123456789") == std::string::npos &&
                       std::stoi(port) <= 65535;
  const bool is_v6 = host.size() > 2 && host.front() == '[' && host.back() == ']';
  const std::string bare = is_v6 ? host.substr(1, host.size() - 2) : host;
  in6_addr parsed{};
  // Numbers only: what a name leads to would be known only when it is too late to refuse it.
  if (!is_port || inet_pton(is_v6 ? AF_INET6 : AF_INET, bare.c_str(), &parsed) != 1) {
    value.refuse("\"" + text + "\" is no address and port in numbers",
                 {"for example 127.0.0.1:7420, or [::1]:7420"});
  }
  return {host, std::stoi(port)};
}

void read_workspace(const YamlValue& value, GuardOptions& guard) {
  YamlMap map(value, {"min", "max"});
  const std::vector<double> least = map.at("min", "min: [x, y, z]").numbers(3);
  const std::vector<double> most = map.at("max", "max: [x, y, z]").numbers(3);
  map.finish();
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<size_t>(i);
    if (!(least[axis] < most[axis])) value.refuse("max must be beyond min on every axis");
    guard.box_min[i] = least[axis];
    guard.box_max[i] = most[axis];
  }
}

TlsFiles read_tls(const YamlValue& value) {
  YamlMap map(value, {"authority", "certificate", "key"});
  TlsFiles files;
  files.authority = map.at("authority", "authority: FILE, who signs clients").text();
  files.certificate = map.at("certificate", "certificate: FILE, the controller's own").text();
  files.key = map.at("key", "key: FILE, to the certificate").text();
  map.finish();
  return files;
}

bool is_this_machine(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
}

RtdeAddress read_rtde(const YamlValue& value) {
  YamlMap map(value, {"port", "address", "other_machines"});
  RtdeAddress rtde;
  if (map.has("port")) {
    const double port = number_in(map.at("port"), 0.0, 65535.0, "");
    if (port != std::floor(port)) map.at("port").refuse("is no whole number");
    rtde.port = static_cast<int>(port);
  }
  if (map.has("other_machines")) {
    const std::string word = map.at("other_machines").text();
    if (word != "allowed") {
      map.at("other_machines").refuse("is \"" + word + "\"; the only word for it is \"allowed\"");
    }
    rtde.other_machines = true;
  }
  if (map.has("address")) {
    rtde.address = map.at("address").text();
    in6_addr parsed{};
    const char* const text = rtde.address.c_str();
    if (inet_pton(AF_INET, text, &parsed) != 1 && inet_pton(AF_INET6, text, &parsed) != 1) {
      map.at("address").refuse("\"" + rtde.address + "\" is no address in numbers",
                               {"for example 127.0.0.1, or ::1"});
    }
    if (!is_this_machine(rtde.address) && !rtde.other_machines) {
      map.at("address").refuse(
          "RTDE has neither passwords nor encryption: other machines could turn the speed and "
          "switch outputs there, and nobody would ask who they are",
          {"serve it on 127.0.0.1", "give \"other_machines: allowed\" where the network is yours"});
    }
  }
  map.finish();
  return rtde;
}

SimulatedDriveOptions read_simulated(const YamlValue& value) {
  constexpr double kMostLag = 10.0, kMostError = 1.0;
  YamlMap map(value, {"lag", "resolution", "noise", "seed"});
  SimulatedDriveOptions options;
  if (map.has("lag")) options.lag = number_in(map.at("lag"), 0.0, kMostLag, "s");
  if (map.has("resolution")) {
    options.resolution = number_in(map.at("resolution"), 0.0, kMostError, "rad or m");
  }
  if (map.has("noise")) options.noise = number_in(map.at("noise"), 0.0, kMostError, "rad or m");
  if (map.has("seed")) {
    const int seed = map.at("seed").whole_number();
    if (seed < 0) map.at("seed").refuse("is " + std::to_string(seed) + "; it must be 0 or more");
    options.seed = static_cast<std::uint64_t>(seed);
  }
  map.finish();
  return options;
}

UdpDriveOptions read_device(const YamlValue& value) {
  auto [host, port] = read_address(value);
  if (port == 0) value.refuse("the device's port is 0; allowed are 1 to 65535");
  UdpDriveOptions device;
  device.host = host.front() == '[' ? host.substr(1, host.size() - 2) : host;
  device.port = port;
  return device;
}

/// `simulated`, or a map that says more.
void read_drive(const YamlValue& value, Config& config) {
  const std::vector<std::string> ways{"\"simulated\"",
                                      "{simulated: {lag, resolution, noise, seed}}",
                                      "{udp: 127.0.0.1:7500, silent_cycles: 10}"};
  if (!value.node().IsMap()) {
    const std::string drive = value.text();
    if (drive != "simulated") value.refuse("\"" + drive + "\" is no drive", ways);
    return;
  }
  using Keys = std::vector<std::string>;
  const bool is_device = value.node()["udp"].IsDefined();
  YamlMap map(value, is_device ? Keys{"udp", "silent_cycles"} : Keys{"simulated"});
  if (map.has("simulated") == is_device) value.refuse("is no drive", ways);
  if (!is_device) {
    config.simulated = read_simulated(map.at("simulated"));
    map.finish();
    return;
  }
  constexpr int kMostSilence = 10'000;
  config.device = read_device(map.at("udp"));
  if (map.has("silent_cycles")) {
    const int silent = map.at("silent_cycles").whole_number();
    if (silent < 0 || silent > kMostSilence) {
      map.at("silent_cycles")
          .refuse("is " + std::to_string(silent) + "; allowed are 0 to " +
                  std::to_string(kMostSilence));
    }
    config.guard.silent_cycles = silent;
  }
  map.finish();
}

void read_start(const YamlValue& value, Config& config) {
  const std::vector<double> start = value.numbers(-1);
  if (start.empty() || start.size() > static_cast<size_t>(kMaxJoints)) {
    value.refuse("has " + std::to_string(start.size()) + " values; a robot has 1 to " +
                 std::to_string(kMaxJoints) + " joints");
  }
  config.start =
      Eigen::Map<const Eigen::VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
  if (!config.start.allFinite()) value.refuse("has a value that is not finite");
}

void read_processors(YamlMap& map, Config& config) {
  if (map.has("processor")) {
    const int processor = map.at("processor").whole_number();
    if (processor < 0) {
      map.at("processor").refuse("is " + std::to_string(processor) + "; processors count from 0");
    }
    config.processor = processor;
  }
  if (map.has("keep_awake")) {
    const std::string word = map.at("keep_awake").text();
    if (word != "true" && word != "false") {
      map.at("keep_awake").refuse("is \"" + word + "\"; allowed are true and false");
    }
    config.keep_awake = word == "true";
  }
}

/// The stop begins a cycle or two after the twentieth of the heartbeat that the loop keeps for it.
void check_heartbeat(YamlMap& map, const Config& config) {
  constexpr int kLeastCycles = 40;
  if (config.heartbeat >= kLeastCycles * config.cycle) return;
  const auto seconds = [](std::chrono::nanoseconds time) {
    return number_text(std::chrono::duration<double>(time).count()) + " s";
  };
  map.at(map.has("heartbeat") ? "heartbeat" : "cycle")
      .refuse("the heartbeat is " + seconds(config.heartbeat) + "; allowed are " +
                  std::to_string(kLeastCycles) + " cycles, " +
                  seconds(kLeastCycles * config.cycle) + ", or more",
              {"give a longer \"heartbeat\", or a shorter \"cycle\""});
}

const std::vector<std::string> kKeys{"robot",     "drive",      "start",     "listen", "cycle",
                                     "heartbeat", "tool_speed", "workspace", "tls",    "logs",
                                     "rtde",      "processor",  "keep_awake"};

Config read(YamlMap map) {
  Config config;
  config.robot = map.at("robot", "robot: puma560").text();
  if (map.has("drive")) read_drive(map.at("drive"), config);
  if (map.has("start")) {
    if (config.device) map.at("start").refuse("is for a simulated drive; a device tells its own");
    read_start(map.at("start"), config);
  }
  if (map.has("cycle")) config.cycle = time_in(map.at("cycle"), 1e-4, 1.0);
  if (map.has("heartbeat")) config.heartbeat = time_in(map.at("heartbeat"), 0.02, 60.0);
  check_heartbeat(map, config);
  read_processors(map, config);
  if (map.has("tool_speed")) {
    config.guard.tool_speed = number_in(map.at("tool_speed"), 0.0, 1e6, "m/s");
  }
  if (map.has("workspace")) read_workspace(map.at("workspace"), config.guard);
  if (map.has("tls")) config.tls = read_tls(map.at("tls"));
  if (map.has("rtde")) config.rtde = read_rtde(map.at("rtde"));
  if (map.has("logs")) config.logs = map.at("logs").text();
  if (map.has("listen")) {
    std::tie(config.host, config.port) = read_address(map.at("listen"));
    if (!config.is_loopback() && !config.tls) {
      map.at("listen").refuse(
          "other machines could reach the arm there, and nobody would ask who they are",
          {"listen on 127.0.0.1 or [::1]", "give \"tls\": authority, certificate and key"});
    }
  }
  map.finish();
  return config;
}

[[noreturn]] void refuse_file(const std::string& path, const std::string& message,
                              std::optional<int> line = std::nullopt) {
  Problem problem;
  problem.code = ErrorCode::kFile;
  problem.file = path;
  problem.line = line;
  problem.message = message;
  throw MotionError(std::move(problem));
}

/// Names that are relative count from the folder of the file that says them.
void resolve_names(Config& config, const std::filesystem::path& folder) {
  const auto resolve = [&folder](std::string& name) {
    if (!name.empty()) name = (folder / name).lexically_normal().string();
  };
  const std::string ending = std::filesystem::path(config.robot).extension();
  if (ending == ".yaml" || ending == ".yml" || ending == ".urdf") resolve(config.robot);
  resolve(config.logs);
  if (!config.tls) return;
  resolve(config.tls->authority);
  resolve(config.tls->certificate);
  resolve(config.tls->key);
}

}  // namespace

bool Config::is_loopback() const { return host.starts_with("127.") || host == "[::1]"; }

Config config_from_yaml(const std::string& text, const std::string& source) {
  try {
    const YamlDocuments documents = load_documents(text);
    if (documents.count != 1) {
      refuse_file(source, "holds " + std::to_string(documents.count) + " documents, not one");
    }
    Config config = read(YamlMap(YamlValue(documents.first, source, ""), kKeys));
    resolve_names(config, std::filesystem::path(source).parent_path());
    return config;
  } catch (const YAML::Exception& error) {
    refuse_file(source, "is no YAML: " + error.msg, error.mark.line + 1);
  } catch (const MotionError& error) {
    // The reader is that of robot files.
    Problem problem = error.problem();
    problem.code = ErrorCode::kFile;
    throw MotionError(std::move(problem));
  }
}

Config load_config(const std::string& path) {
  constexpr std::uintmax_t kMostBytes = 1 << 20;
  std::error_code unknown;
  if (std::filesystem::is_regular_file(path, unknown) &&
      std::filesystem::file_size(path, unknown) > kMostBytes) {
    refuse_file(path, "is no configuration: it has more than 1 MiB");
  }
  return config_from_yaml(read_file(path), path);
}

}  // namespace viapoint::controller
