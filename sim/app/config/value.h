// A literal value of a key: checked, and brought to the one form that resolved configs keep.
#pragma once

#include <string>

#include "sim/app/config/keys.h"

namespace shimmer::app {

// What a literal of the key must be: "a number in [0, 64] px", "true or false".
std::string Wanted(const Key& key);

// The value as resolved configs keep it: numbers of the key's kind, a single text as a list where the key is
// a list. Throws ConfigError with the pointer of what is wrong in it. pointer: where the value stands.
Json CheckedLiteral(const Key& key, const Json& value, const std::string& pointer);

}  // namespace shimmer::app
