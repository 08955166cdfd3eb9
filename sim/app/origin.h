// Where a data set's config file lay, which relative sources count from: noted in the data set's folder
// (.origin.json), for its clips may have to be made again.
#pragma once

#include <filesystem>

namespace shimmer::app {

// Writes it where it is not noted so already.
void NoteConfigFolder(const std::filesystem::path& folder, const std::filesystem::path& config_folder);

// Throws std::runtime_error where it is not noted.
std::filesystem::path NotedConfigFolder(const std::filesystem::path& folder);

}  // namespace shimmer::app
