#include "kinematics/xml_bounds.hpp"

#include <algorithm>

namespace viapoint {
namespace {

/// Behind the next `end` at or after `from`, or the end of the text.
size_t behind(std::string_view text, size_t from, std::string_view end) {
  const size_t found = text.find(end, from);
  return found == std::string_view::npos ? text.size() : found + end.size();
}

/// Behind the '>' that ends the tag, which is none of a quoted value.
size_t behind_tag(std::string_view text, size_t from) {
  for (size_t i = from; i < text.size(); ++i) {
    if (text[i] == '>') return i + 1;
    if (text[i] != '"' && text[i] != '\'') continue;
    const size_t close = text.find(text[i], i + 1);
    if (close == std::string_view::npos) break;
    i = close;
  }
  return text.size();
}

}  // namespace

XmlExtent xml_extent(std::string_view text) {
  XmlExtent extent;
  int depth = 0;
  size_t i = text.find('<');
  while (i < text.size()) {
    const std::string_view rest = text.substr(i);
    if (rest.starts_with("<!--")) {
      i = behind(text, i + 4, "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      i = behind(text, i, "]]>");
    } else if (rest.starts_with("<?")) {
      i = behind(text, i, "?>");
    } else if (rest.starts_with("<!")) {
      i = behind(text, i, ">");
    } else if (rest.starts_with("</")) {
      depth = std::max(0, depth - 1);
      i = behind(text, i, ">");
    } else {
      const size_t end = behind_tag(text, i + 1);
      const bool closed = end - i >= 3 && text[end - 1] == '>' && text[end - 2] == '/';
      ++extent.elements;
      extent.depth = std::max(extent.depth, depth + 1);
      if (!closed) ++depth;
      i = end;
    }
    i = text.find('<', i);
  }
  return extent;
}

}  // namespace viapoint
