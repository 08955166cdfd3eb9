// Text and bytes as a page of HTML holds them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace shimmer::cli {

// Any bytes as text of an element or of a quoted attribute. What is no UTF-8, and what HTML has no sign for
// (control characters but tab and newline), becomes U+FFFD.
std::string EscapeHtml(std::string_view text);

std::string Base64(std::span<const uint8_t> bytes);

}  // namespace shimmer::cli
