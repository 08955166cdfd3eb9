// The files of a data set's folder that are no clips: dataset.json, manifest.jsonl, and what a writer needs
// beside.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace shimmer::dataset {

inline constexpr const char* kDescriptionName = "dataset.json";
inline constexpr const char* kManifestName = "manifest.jsonl";
inline constexpr const char* kStagingName = ".staging";  // clips that are being written; gone afterwards.
                                                         // Of a shard with its suffix

// Makes the folder if it is not there. Throws std::invalid_argument if it is a file, or holds files but no
// data set; std::runtime_error if it can't be made.
void MakeDatasetFolder(const std::filesystem::path& folder);

// dataset.json. Throws std::runtime_error if it is not there or damaged.
nlohmann::json ReadDescription(const std::filesystem::path& folder);

// Writes dataset.json; one that is there must agree (dataset_difference.h), or else std::invalid_argument
// names how not. staging: a folder of the writer's own, made where it is needed.
void WriteDescription(const std::filesystem::path& folder, const std::filesystem::path& staging,
                      const nlohmann::json& description);

}  // namespace shimmer::dataset
