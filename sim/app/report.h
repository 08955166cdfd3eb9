// shimmer report DIR: one page about a data set, DIR/report.html.
#pragma once

#include <filesystem>
#include <string>

namespace shimmer::app {

inline constexpr const char* kReportName = "report.html";

// The page: a summary, a contact sheet, histograms of what was drawn and of what came out, how often each
// source was used, failures, and the config. It stands alone: no script, no other file. The same set gives
// the same page, wherever it lies and however it was made. Throws std::runtime_error for what is missing or
// damaged.
std::string ReportHtml(const std::filesystem::path& folder);

// Writes it, and gives its path.
std::filesystem::path WriteReport(const std::filesystem::path& folder);

}  // namespace shimmer::app
