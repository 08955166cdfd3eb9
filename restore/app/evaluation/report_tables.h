// Sections of the evaluation's page that are tables of the clips' means.
#pragma once

#include <string>

#include "restore/app/evaluation/results.h"

namespace shimmer::restore::app {

std::string VariantsHtml(const Evaluation& evaluation);
std::string StagesHtml(const Evaluation& evaluation);  // with what they found and how long they took
std::string GroupsHtml(const Evaluation& evaluation);

}  // namespace shimmer::restore::app
