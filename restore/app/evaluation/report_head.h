// What is read first: the set, how much of it is evaluated, and the headline figures.
#pragma once

#include <string>

#include "restore/app/evaluation/results.h"

namespace shimmer::restore::app {

std::string HeadHtml(const Evaluation& evaluation);

}  // namespace shimmer::restore::app
