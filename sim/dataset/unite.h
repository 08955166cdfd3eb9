// The manifests of shards into one.
#pragma once

#include <filesystem>

#include "sim/dataset/folder_lock.h"
#include "sim/dataset/manifest.h"

namespace shimmer::dataset {

// Makes one manifest of manifest.jsonl and those of the shards: the line of each clip that counts, in the
// order of the clips. The shards' manifests and locks go. lock: of the whole set. damaged: Manifest's; such
// lines are left out. Throws std::runtime_error.
void UniteManifests(const std::filesystem::path& folder, const FolderLock& lock,
                    const Manifest::Damaged& damaged = {});

}  // namespace shimmer::dataset
