/// @file
/// A look at XML text before a parser that calls itself for every element gets it.
#pragma once

#include <string_view>

namespace viapoint {

/// How large a document is for one that walks through it.
struct XmlExtent {
  int elements = 0;
  int depth = 0;  ///< of elements in one another
};

/// Counts the elements of `text`, which need not be well formed; comments, CDATA, declarations and
/// quoted values are passed over. One pass, no recursion.
[[nodiscard]] XmlExtent xml_extent(std::string_view text);

}  // namespace viapoint
