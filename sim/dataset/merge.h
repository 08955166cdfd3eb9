// Shards into one data set.
#pragma once

#include <filesystem>

#include "sim/dataset/dataset_writer.h"

namespace shimmer::dataset {

// Brings the clips of another folder that writer's has not into it: their files are linked where both folders
// lie in one file system, else copied, and stay in `from` as they are. Clips that failed there and are not
// known here are noted as failed. Throws std::invalid_argument where `from` is made from something else (each
// difference is named), FolderBusy where a process writes to it, and std::runtime_error.
void Adopt(DatasetWriter& writer, const std::filesystem::path& from);

// Makes one manifest of manifest.jsonl and those of the shards: the line of each clip that counts, in the
// order of the clips. What shards leave (their manifests, locks and staging) goes. damaged: Manifest's; such
// lines are left out. Throws FolderBusy while a process writes to the folder.
void UniteManifests(const std::filesystem::path& folder, const Manifest::Damaged& damaged = {});

}  // namespace shimmer::dataset
