/// @file
/// One JSON object a line on standard output.
#pragma once

#include <iostream>
#include <sstream>
#include <string>
#include <string_view>

namespace viapoint::bench {

/// Collects keys and prints the object when it goes out of scope. Keys and texts are plain words
/// of this program: nothing in them needs escaping.
class JsonLine {
 public:
  JsonLine(std::string_view bench, std::string_view subject) {
    text_.precision(kDigits);
    text_ << "{\"bench\": \"" << bench << "\", \"case\": \"" << subject << '"';
  }
  ~JsonLine() { std::cout << text_.str() << "}" << std::endl; }
  JsonLine(const JsonLine&) = delete;
  JsonLine& operator=(const JsonLine&) = delete;

  template <typename Number>
  JsonLine& add(std::string_view key, Number value) {
    text_ << ", \"" << key << "\": " << value;
    return *this;
  }

 private:
  /// Enough to tell a limit that is kept from one that is not.
  static constexpr int kDigits = 9;
  std::ostringstream text_;
};

}  // namespace viapoint::bench
