// Tars of files, through libarchive: POSIX ustar, every date 0 and every owner root, so that the same members
// give the same bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shimmer::dataset {

struct TarMember {
  std::string name;             // at most 100 bytes
  std::filesystem::path place;  // the file that holds it
  int64_t bytes;
};

// What a member takes in a tar, its header included; a tar ends with at most kTarEndBytes more.
constexpr int64_t TarBytes(int64_t member_bytes) { return 512 + (member_bytes + 511) / 512 * 512; }
inline constexpr int64_t kTarEndBytes = 10240;

// Writes and syncs a tar; gives where each member's bytes begin in it. Throws std::runtime_error.
std::vector<int64_t> WriteTar(const std::filesystem::path& path, const std::vector<TarMember>& members);

// The members of a tar: names, and where their bytes lie. Throws std::runtime_error "PATH: what is wrong" if
// it is damaged or cut off.
struct TarEntry {
  std::string name;
  int64_t offset, bytes;
};
std::vector<TarEntry> TarEntries(const std::filesystem::path& path);

}  // namespace shimmer::dataset
