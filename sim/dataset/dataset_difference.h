// dataset.json: what a data set is made from. The program says it as a JSON object:
//   config (resolved), config_hash, engine (a number), sources [{path, sha256}], and what else may be of use
//   (version).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace shimmer::dataset {

// Why clips made from `here` don't belong with clips made from `there`, a line each: keys of the config but
// for "clips" (by JSON pointer, with both values), the engine, source files. Empty: they do.
std::vector<std::string> Differences(const nlohmann::json& there, const nlohmann::json& here);

// The first few of them in one line.
std::string InOneLine(const std::vector<std::string>& differences);

}  // namespace shimmer::dataset
