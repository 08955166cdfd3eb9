#pragma once

namespace shimmer::cli {

extern const char* const kReportStyle;  // CSS: light and dark, wide and narrow, screen and paper

}  // namespace shimmer::cli
