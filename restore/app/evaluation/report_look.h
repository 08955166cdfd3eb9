#pragma once

namespace shimmer::restore::app {

extern const char* const kReportLook;  // CSS, after cli::kReportStyle: what the evaluation's page has beside

}  // namespace shimmer::restore::app
