// The files of a data set's folder that are no clips: dataset.json, manifest.jsonl, and what a writer needs
// beside.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace shimmer::dataset {

inline constexpr const char* kDescriptionName = "dataset.json";
inline constexpr const char* kManifestName = "manifest.jsonl";
inline constexpr const char* kOriginName = ".origin.json";  // where its config lay
inline constexpr const char* kStagingName = ".staging";  // what is being written; of a shard with its suffix

// Makes the folder if it is not there. Throws std::invalid_argument if it is a file, or holds files but no
// data set; std::runtime_error if it can't be made.
void MakeDatasetFolder(const std::filesystem::path& folder);

// Writes a file of the set that is no clip's, unless it says that already; whole or not at all: beside, in a staging folder of its own,
// for shards on several hosts may do this at the same moment, and renamed. Throws std::runtime_error.
void WriteDatasetFile(const std::filesystem::path& folder, const std::string& name,
                      std::span<const uint8_t> bytes);

// dataset.json. Throws std::runtime_error if it is not there or damaged.
nlohmann::json ReadDescription(const std::filesystem::path& folder);

// Writes dataset.json; one that is there must agree (dataset_difference.h), or else std::invalid_argument
// names how not.
void WriteDescription(const std::filesystem::path& folder, const nlohmann::json& description);

}  // namespace shimmer::dataset
