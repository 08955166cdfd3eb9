// The part of a report about what each clip has drawn for itself.
#pragma once

#include <string>

#include "sim/app/config/config.h"
#include "sim/app/report_facts.h"

namespace shimmer::app {

// A chart for each key of the config that has a distribution, in the config's order: bars of names, sizes and
// whatever was a choice, histograms of other numbers. Empty if there is no such key.
std::string DrawnChartsHtml(const ConfigFile& config, const ReportFacts& facts);

}  // namespace shimmer::app
