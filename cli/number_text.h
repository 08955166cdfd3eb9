// Numbers as people read them in pages and summaries. (sim::NumberText gives every digit.)
#pragma once

#include <cstdint>
#include <string>

namespace shimmer::cli {

// RoundedText has the decimals that numbers `step` > 0 apart need: 2.5 and 2 with 0.5;
// ShortText three digits, and all before the point: "0.0312", "4.97", "12346".
std::string RoundedText(double value, double step);
std::string ShortText(double value);

std::string Grouped(int64_t count);                           // "1,234,567"
std::string Counted(int64_t count, const std::string& what);  // "1 clip", "1,000 clips"
std::string BytesText(uint64_t bytes);                        // "1.23 GB"; a GB is 10^9

}  // namespace shimmer::cli
