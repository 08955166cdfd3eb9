// Names in a sentence.
#pragma once

#include <span>
#include <string>

namespace shimmer::cli {

// "'a', 'b' or 'c'"; joint: what stands before the last, "or" or "and".
std::string Listed(std::span<const std::string> names, const std::string& joint);

}  // namespace shimmer::cli
