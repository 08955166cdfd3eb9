// Patterns of paths: * and ? within a name, [...] a set of characters, ** any number of folders. As in a
// shell, names that start with a dot are matched only by a pattern that does; links to folders are followed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shimmer::dataset {

bool HasWildcards(const std::string& pattern);

// What exists below base and matches; files and folders, in no order, perhaps twice.
// Throws std::runtime_error if a folder on the way can't be read.
std::vector<std::filesystem::path> ExpandGlob(const std::filesystem::path& base, const std::string& pattern);

// The entries of a folder but for those that start with a dot, sorted by name.
std::vector<std::filesystem::path> VisibleEntries(const std::filesystem::path& folder);

// Every visible file below a folder, at any depth.
std::vector<std::filesystem::path> FilesBelow(const std::filesystem::path& folder);

}  // namespace shimmer::dataset
