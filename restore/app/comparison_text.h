// A comparison as people and as programs read it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "restore/app/comparison.h"

namespace shimmer::restore::app {

// Frames of the rolling mean and standard deviation of the line deviation.
inline constexpr int kRollingFrames = 10;

// A table: the mean and the worst of each score; but for masks also the line deviation and stability of each
// of both. What is
// infinite is "inf", what is absent "-".
std::string ComparisonTable(const Comparison& comparison, const std::string& a, const std::string& b);

// The same and each frame's values, as docs/restoration.md describes it. What is infinite is the string
// "inf", what is absent null.
nlohmann::ordered_json ComparisonJson(const Comparison& comparison, const std::string& a,
                                      const std::string& b);

}  // namespace shimmer::restore::app
