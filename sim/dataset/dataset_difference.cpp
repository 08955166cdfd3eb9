#include "sim/dataset/dataset_difference.h"

#include <algorithm>
#include <map>
#include <set>

namespace shimmer::dataset {
namespace {

using Json = nlohmann::json;

// Every leaf by its JSON pointer: "/tilt/strength_px" -> 5.
std::map<std::string, Json> Leaves(const Json& config) {
  return config.is_structured() ? config.flatten().get<std::map<std::string, Json>>()
                                : std::map<std::string, Json>();
}

std::map<std::string, std::string> Hashes(const Json& sources) {
  std::map<std::string, std::string> hashes;
  for (const Json& source : sources) {
    const Json hash = source.value("sha256", Json());  // null for a file that could not be read
    hashes[source.value("path", "")] = hash.is_string() ? hash.get<std::string>() : "";
  }
  return hashes;
}

template <class Value>
std::set<std::string> Keys(const std::map<std::string, Value>& a, const std::map<std::string, Value>& b) {
  std::set<std::string> keys;
  for (const auto& [key, value] : a) keys.insert(key);
  for (const auto& [key, value] : b) keys.insert(key);
  return keys;
}

}  // namespace

std::vector<std::string> Differences(const Json& there, const Json& here) {
  std::vector<std::string> differences;

  const auto old_leaves = Leaves(there.value("config", Json())),
             new_leaves = Leaves(here.value("config", Json()));
  const auto text = [](const std::map<std::string, Json>& leaves, const std::string& pointer) {
    const auto leaf = leaves.find(pointer);
    return leaf == leaves.end() ? "absent"
                                : leaf->second.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  for (const std::string& pointer : Keys(old_leaves, new_leaves)) {
    if (pointer == "/clips") continue;
    const auto old_leaf = old_leaves.find(pointer), new_leaf = new_leaves.find(pointer);
    if (old_leaf != old_leaves.end() && new_leaf != new_leaves.end() && old_leaf->second == new_leaf->second)
      continue;
    differences.push_back(pointer + " is " + text(old_leaves, pointer) + " there and " +
                          text(new_leaves, pointer) + " here");
  }

  const auto compare = [&](const char* key, const std::string& before, const std::string& after) {
    const Json old_value = there.value(key, Json()), new_value = here.value(key, Json());
    if (old_value != new_value)
      differences.push_back(before + old_value.dump() + " " + after + " there and would have " +
                            new_value.dump() + " here");
  };
  compare("pair_digits", "the numbers in file names have ", "digits");
  compare("clips_per_tar", "tars have ", "clips");

  const Json old_engine = there.value("engine", Json()), new_engine = here.value("engine", Json());
  if (old_engine != new_engine)
    differences.push_back("engine is " + old_engine.dump() + " there and " + new_engine.dump() + " here");

  const auto old_hashes = Hashes(there.value("sources", Json::array()));
  const auto new_hashes = Hashes(here.value("sources", Json::array()));
  for (const std::string& path : Keys(old_hashes, new_hashes)) {
    const auto old_hash = old_hashes.find(path), new_hash = new_hashes.find(path);
    if (old_hash == old_hashes.end())
      differences.push_back("source " + path + " was added");
    else if (new_hash == new_hashes.end())
      differences.push_back("source " + path + " is gone");
    else if (!old_hash->second.empty() && !new_hash->second.empty() && old_hash->second != new_hash->second)
      differences.push_back("source " + path + " has changed");
  }
  return differences;
}

std::string InOneLine(const std::vector<std::string>& differences) {
  constexpr size_t kMostNamed = 8;
  std::string line;
  for (size_t i = 0; i < std::min(differences.size(), kMostNamed); ++i)
    line += (i ? "; " : "") + differences[i];
  if (differences.size() > kMostNamed)
    line += "; and " + std::to_string(differences.size() - kMostNamed) + " more";
  return line;
}

}  // namespace shimmer::dataset
