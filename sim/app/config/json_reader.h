// Strict JSON text: what a lenient reader lets pass in silence is an error here.
#pragma once

#include <string>

#include "sim/app/config/error.h"

namespace shimmer::app {

inline constexpr int kMaxJsonNesting = 64;

// The text is no JSON at all, in contrast to JSON that says something twice or too big.
class JsonSyntaxError : public ConfigError {
  using ConfigError::ConfigError;
};

// Reads one JSON value of UTF-8 text (a byte-order mark is let pass). Throws JsonSyntaxError, with line and
// column and pointer "", if it is none: empty, cut off, followed by more, another encoding, with comments or
// NaN. Throws ConfigError with the pointer of a key that is there twice, a number that is beyond double
// (1e999) or a whole number beyond 64 bits, and of what is nested deeper than kMaxJsonNesting.
Json ReadJson(const std::string& text);

}  // namespace shimmer::app
