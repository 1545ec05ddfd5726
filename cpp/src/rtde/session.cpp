#include "rtde/session.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viapoint/core/number_text.hpp"

namespace viapoint::rtde {
namespace {

constexpr std::uint16_t kProtocolVersion = 2;
/// Of a controller whose clients know 500 Hz.
constexpr std::array<std::uint32_t, 4> kControllerVersion{5, 11, 0, 0};
constexpr double kMostHertz = 500.0;
constexpr std::uint8_t kOutputRecipe = 1, kNoRecipe = 0;
constexpr std::uint8_t kError = 1, kWarning = 2;  ///< levels of text messages
constexpr std::size_t kMostText = 255;
constexpr char kYes = 1, kNo = 0;

/// The names of a recipe; one comma too many at the end is none.
std::vector<std::string_view> names_in(std::string_view list) {
  if (list.ends_with(',')) list.remove_suffix(1);
  std::vector<std::string_view> names;
  while (!list.empty() && names.size() <= kMostVariables) {
    const std::size_t comma = std::min(list.find(','), list.size());
    names.push_back(list.substr(0, comma));
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return names;
}

/// The variables of these names, nullptr where there is none, and their types for the answer.
template <typename Variable>
std::pair<std::vector<const Variable*>, Bytes> look_up(const std::vector<std::string_view>& names,
                                                       const Variable* (*find)(std::string_view)) {
  std::vector<const Variable*> variables;
  Bytes types;
  for (const std::string_view name : names) {
    variables.push_back(find(name));
    if (!types.empty()) types += ',';
    types += variables.back() == nullptr ? kNotFound : variables.back()->type;
  }
  return {std::move(variables), std::move(types)};
}

}  // namespace

Bytes Session::receive(std::string_view bytes) {
  received_ += bytes;
  std::string_view rest = received_;
  while (!is_broken_ && rest.size() >= kHeaderBytes) {
    std::string_view header = rest.substr(0, kHeaderBytes);
    const std::size_t length = take<std::uint16_t>(header);
    if (length < kHeaderBytes || length > kMostPackageBytes) {
      refuse("a package has " + std::to_string(length) + " bytes; allowed are " +
             std::to_string(kHeaderBytes) + " to " + std::to_string(kMostPackageBytes));
      break;
    }
    if (rest.size() < length) break;
    handle(static_cast<PackageType>(take<std::uint8_t>(header)),
           rest.substr(kHeaderBytes, length - kHeaderBytes));
    rest.remove_prefix(length);
  }
  received_.erase(0, is_broken_ ? received_.size() : received_.size() - rest.size());
  return std::exchange(answers_, {});
}

void Session::answer(PackageType type, std::string_view payload) {
  answers_ += package(type, payload);
}

void Session::tell(std::string_view message, std::uint8_t level) {
  constexpr std::string_view kSource = "viapoint";
  message = message.substr(0, kMostText);
  Bytes payload;
  put(payload, static_cast<std::uint8_t>(message.size()));
  payload += message;
  put(payload, static_cast<std::uint8_t>(kSource.size()));
  payload += kSource;
  put(payload, level);
  answer(PackageType::kTextMessage, payload);
}

void Session::refuse(std::string_view why) {
  tell(why, kError);
  is_broken_ = true;
  is_started_ = false;
}

void Session::handle(PackageType type, std::string_view payload) {
  if (type == PackageType::kProtocolVersion) return greet(payload);
  if (type == PackageType::kControllerVersion) {
    Bytes version;
    for (const std::uint32_t part : kControllerVersion) put(version, part);
    return answer(PackageType::kControllerVersion, version);
  }
  if (!has_greeted_) return refuse("ask for protocol version 2 first");
  switch (type) {
    case PackageType::kSetupOutputs:
      return set_up_outputs(payload);
    case PackageType::kSetupInputs:
      return set_up_inputs(payload);
    case PackageType::kStart:
      is_started_ = !outputs_.empty();
      due_ = 0.0;
      return answer(type, {is_started_ ? &kYes : &kNo, 1});
    case PackageType::kPause:
      is_started_ = false;
      return answer(type, {&kYes, 1});
    case PackageType::kData:
      return take_data(payload);
    case PackageType::kTextMessage:
      return;  // a client's own log
    default:
      return refuse("type " + std::to_string(static_cast<int>(type)) + " is no package's");
  }
}

void Session::greet(std::string_view payload) {
  if (payload.size() != sizeof(std::uint16_t)) return refuse("a protocol version has two bytes");
  const auto version = take<std::uint16_t>(payload);
  has_greeted_ = has_greeted_ || version == kProtocolVersion;
  answer(PackageType::kProtocolVersion, {version == kProtocolVersion ? &kYes : &kNo, 1});
}

void Session::set_up_outputs(std::string_view payload) {
  if (payload.size() < sizeof(double)) return refuse("an output recipe begins with a frequency");
  const auto hertz = take<double>(payload);
  if (!(hertz >= 1.0 && hertz <= kMostHertz)) {
    return refuse("the frequency is " + number_text(hertz) + "; allowed are 1 to 500 Hz");
  }
  const std::vector<std::string_view> names = names_in(payload);
  if (names.empty() || names.size() > kMostVariables) {
    return refuse("an output recipe has 1 to " + std::to_string(kMostVariables) + " variables");
  }
  auto [variables, types] = look_up(names, &find_output);
  const bool is_whole = std::find(variables.begin(), variables.end(), nullptr) == variables.end();
  is_started_ = false;
  outputs_ = is_whole ? std::move(variables) : std::vector<const OutputVariable*>{};
  period_ = 1.0 / hertz;
  Bytes reply;
  put(reply, is_whole ? kOutputRecipe : kNoRecipe);
  answer(PackageType::kSetupOutputs, reply + types);
}

void Session::set_up_inputs(std::string_view payload) {
  const std::vector<std::string_view> names = names_in(payload);
  if (names.empty() || names.size() > kMostVariables || recipes_.size() == kMostInputRecipes) {
    return refuse("there are at most " + std::to_string(kMostInputRecipes) +
                  " input recipes, each of 1 to " + std::to_string(kMostVariables) + " variables");
  }
  auto [variables, types] = look_up(names, &find_input);
  Bytes reply;
  if (std::find(variables.begin(), variables.end(), nullptr) == variables.end()) {
    recipes_.push_back(std::move(variables));
    put(reply, static_cast<std::uint8_t>(recipes_.size()));
  } else {
    put(reply, kNoRecipe);
  }
  answer(PackageType::kSetupInputs, reply + types);
}

void Session::take_data(std::string_view payload) {
  const std::size_t number = payload.empty() ? 0 : take<std::uint8_t>(payload);
  if (number == 0 || number > recipes_.size()) {
    return refuse("there is no input recipe " + std::to_string(number));
  }
  const std::vector<const InputVariable*>& recipe = recipes_[number - 1];
  std::size_t bytes = 0;
  for (const InputVariable* variable : recipe) bytes += variable->bytes;
  if (payload.size() != bytes) {
    return refuse("input recipe " + std::to_string(number) + " has " + std::to_string(bytes) +
                  " bytes; there came " + std::to_string(payload.size()));
  }
  Told told;
  for (const InputVariable* variable : recipe) variable->read(payload, told);
  const std::uint64_t mask = told.output_mask & told.told_outputs;
  if (mask != 0) arm_.switch_outputs(mask, told.outputs);
  if (told.slider_mask == 0) return;
  if (told.slider_fraction >= 0.0 && told.slider_fraction <= 1.0) {
    arm_.set_override(told.slider_fraction);
  } else {
    tell("the speed slider stays: " + number_text(told.slider_fraction) + " is not in [0, 1]",
         kWarning);
  }
}

Bytes Session::data(const ArmView& view) {
  // Late packages are not made up for.
  due_ += period_;
  if (is_due(view.time)) due_ = view.time + period_;
  Bytes payload;
  put(payload, kOutputRecipe);
  for (const OutputVariable* variable : outputs_) variable->write(view, payload);
  return package(PackageType::kData, payload);
}

}  // namespace viapoint::rtde
