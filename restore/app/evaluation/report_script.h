#pragma once

namespace shimmer::restore::app {

// JavaScript, for the end of the page: tables that sort, lines that move. Without it the page can be read.
extern const char* const kReportScript;

}  // namespace shimmer::restore::app
