// Sections of the evaluation's page that go clip by clip.
#pragma once

#include <string>
#include <vector>

#include "restore/app/evaluation/report_pictures.h"
#include "restore/app/evaluation/results.h"

namespace shimmer::restore::app {

// By the full pipeline's gain on the whole frame, ascending; then those that have none, in their order.
std::vector<const ClipResult*> WorstFirst(const std::vector<ClipResult>& clips);

// shown: those to link to.
std::string ClipsHtml(const Evaluation& evaluation, const std::vector<ShownClip>& shown);
std::string RealHtml(const Evaluation& evaluation, const std::vector<ShownClip>& shown);
std::string FailuresHtml(const Evaluation& evaluation);  // empty where nothing failed

}  // namespace shimmer::restore::app
