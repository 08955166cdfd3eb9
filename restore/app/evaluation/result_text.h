// Results as JSON, as CSV, and as a table to print.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "restore/app/evaluation/results.h"

namespace shimmer::restore::app {

// What is infinite is the string "inf" or "-inf", what is absent null or left out. FactsOf and RowsOf take
// what these give, and throw nlohmann::json::exception for other.
OrderedJson FactsJson(const ClipFacts& facts);
ClipFacts FactsOf(const nlohmann::json& json);
OrderedJson RowsJson(const std::vector<ResultRow>& rows);
std::vector<ResultRow> RowsOf(const nlohmann::json& json);

// The whole of an evaluation, its means too: docs/evaluation.md says what is where.
OrderedJson ResultsJson(const Evaluation& evaluation);

// A row for each clip, variant and stage, with the names of measures.h; what is absent is empty (RFC 4180).
std::string ResultsCsv(const Evaluation& evaluation);

// The variants' means, for the end of a run.
std::string ResultsTable(const Evaluation& evaluation);

}  // namespace shimmer::restore::app
