#include "restore/app/evaluation/report_page.h"

namespace shimmer::restore::app {
std::string EvaluationHtml(const Evaluation&, const std::filesystem::path&) { return "<!DOCTYPE html>"; }
}  // namespace shimmer::restore::app
