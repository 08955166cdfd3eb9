// Tars of files, through libarchive: POSIX ustar, every date 0 and every owner root, so that the same members
// give the same bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shimmer::dataset {

struct TarMember {
  std::string name;             // at most 100 bytes
  std::filesystem::path place;  // the file that holds it
  int64_t bytes;
  int64_t first = 0;  // where it begins in that file
};

// What a member takes in a tar, its header included; a tar ends with at most kTarEndBytes more.
constexpr int64_t TarBytes(int64_t member_bytes) { return 512 + (member_bytes + 511) / 512 * 512; }
inline constexpr int64_t kTarEndBytes = 10240;

// Of a whole tar, by what its members take: two empty blocks at its end, filled up to blocks of 10,240.
constexpr int64_t WholeTarBytes(int64_t members_bytes) {
  return (members_bytes + 1024 + kTarEndBytes - 1) / kTarEndBytes * kTarEndBytes;
}

// Writes and syncs a tar; gives where each member's bytes begin in it. Throws std::runtime_error.
std::vector<int64_t> WriteTar(const std::filesystem::path& path, const std::vector<TarMember>& members);

// The members of a tar: names, and where their bytes lie. Throws std::runtime_error "PATH: what is wrong" if
// it is damaged or cut off.
struct TarEntry {
  std::string name;
  int64_t offset, bytes;
};
std::vector<TarEntry> TarEntries(const std::filesystem::path& path);

// The name of a tar's first member; nothing if its header is damaged.
std::optional<std::string> FirstTarMember(const std::filesystem::path& path);

// Where a file first differs from what WriteTar would write of the bytes that lie at these places in it: in a
// header, in what fills up a block, at its end. Nothing if it does not; the members' bytes themselves are
// compared with nothing. Throws std::runtime_error if it can't be read.
std::optional<int64_t> TarDamage(const std::filesystem::path& path, const std::vector<TarEntry>& members);

}  // namespace shimmer::dataset
