// Data sets into one.
#pragma once

#include <filesystem>

#include "sim/dataset/dataset_writer.h"

namespace shimmer::dataset {

// Throws std::invalid_argument where the data set of a folder is made from something else than this
// description (each difference is named), and std::runtime_error where it is none.
void RequireSameDataset(const std::filesystem::path& from, const Json& description,
                        const std::filesystem::path& described);

// Brings the clips of another folder that writer's has not into it: their files are linked where both folders
// lie in one file system, else copied, and stay in `from` as they are, which may be read-only. Clips that
// failed there and are not known here are noted as failed. A tar comes whole, where it has all that there is
// here and more. Throws as RequireSameDataset, FolderBusy where a process writes to `from`, and
// std::runtime_error.
void Adopt(DatasetWriter& writer, const std::filesystem::path& from);

}  // namespace shimmer::dataset
