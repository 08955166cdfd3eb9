// The files that a config's source patterns mean.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace shimmer::dataset {

enum class FileKind { kPicture, kVideo };

// Each pattern is a file, a folder (every file of this kind below it, by its extension), a glob (glob.h;
// files of any extension) or a list of such patterns (pattern_list.h). A relative pattern is looked up below
// the first of bases that has a match (the config's folder, then the working directory: ""); one of a list's
// below the list's own folder before these. Sorted by the bytes of the path, each file once. Throws
// std::runtime_error with the pattern and the places looked in where nothing is found; for a list's with its
// name and the line's number.
std::vector<std::filesystem::path> FindFiles(std::span<const std::string> patterns,
                                             std::span<const std::filesystem::path> bases, FileKind kind);

// Each pattern is a folder of frames, a glob of such folders, the frames' names with one %d or %06d for their
// number, or a list of such patterns. Found, sorted and refused as above; the results go to SequenceFiles or
// OpenSequence.
std::vector<std::filesystem::path> FindSequences(std::span<const std::string> patterns,
                                                 std::span<const std::filesystem::path> bases);

// The frames of a sequence, in order. A folder: its pictures (by extension, not those in folders below) by
// the last number in their names, then by bytes. A %d pattern: from the lowest number on. Throws
// std::runtime_error if there are none, or if a number between the lowest and the highest is missing (%d
// only).
std::vector<std::filesystem::path> SequenceFiles(const std::filesystem::path& sequence);

}  // namespace shimmer::dataset
