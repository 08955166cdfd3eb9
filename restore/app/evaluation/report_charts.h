// Charts of the evaluation's page, as HTML with inline SVG.
#pragma once

#include <string>

#include "restore/app/evaluation/summary.h"

namespace shimmer::restore::app {

// How long the full pipeline takes in each stage, in ms a frame; empty where no stage has a time.
std::string StageTimesHtml(const ClipGroup& all);

// The gain of each clip by how turbulent it is, and each variant's mean of the weak, the medium and the
// strong ones; says so where no clip has both.
std::string QualityChartHtml(const Evaluation& evaluation);

}  // namespace shimmer::restore::app
