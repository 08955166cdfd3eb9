// The head of a report: what the data set is, how much of it is there, and what it was made from.
#pragma once

#include <string>

#include "sim/app/config/config.h"
#include "sim/app/report_facts.h"
#include "sim/dataset/dataset_reader.h"

namespace shimmer::app {

std::string SummaryHtml(const dataset::DatasetReader& reader, const ConfigFile& config,
                        const ReportFacts& facts);

}  // namespace shimmer::app
