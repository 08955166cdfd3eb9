// Files that are there or are not: bytes written, checked and synced before anyone relies on them.
// Every function throws std::runtime_error with the path and the system's reason ("No space left on device").
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace shimmer::dataset {

// kNone: this file system has no locks (some cluster file systems).
enum class Lock { kHeld, kTaken, kNone };
enum class LockKind { kExclusive, kShared };

// An open file of the system, closed when it goes.
class FileHandle {
 public:
  // flags and mode as open(2) takes them; never follows into a child process.
  FileHandle(const std::filesystem::path& path, int flags, unsigned mode = 0666);
  ~FileHandle();
  FileHandle(FileHandle&& other) noexcept;
  FileHandle& operator=(FileHandle&& other) = delete;

  void WriteAll(std::span<const uint8_t> bytes);
  void StartSync();  // asks for it and does not wait; Sync() then has less to do
  void Sync();
  void SyncFileSystem();  // all of it that this file or folder lies in
  void Truncate(uint64_t bytes);
  void Close();                                        // reports what the destructor would swallow
  Lock TryLock(LockKind kind = LockKind::kExclusive);  // against other processes and other handles

  size_t ReadSome(std::span<uint8_t> buffer);  // 0 at the end
  void Seek(uint64_t place);

 private:
  std::filesystem::path path_;
  int descriptor_;
};

// Refuses what can't be a source: no such file, a folder, a device, an empty file.
void RequireFile(const std::filesystem::path& path);

// Creates or empties files, writes all bytes and syncs them. The caller gives names that are not final yet.
// Many at once cost the disk fewer waits than one by one.
struct FileToWrite {
  std::filesystem::path path;
  std::span<const uint8_t> bytes;
};
void WriteFiles(std::span<const FileToWrite> files);
void WriteFile(const std::filesystem::path& path, std::span<const uint8_t> bytes);

// The same without the sync, for files that SyncFileSystem makes durable with many others.
void WriteUnsynced(const std::filesystem::path& path, std::span<const uint8_t> bytes);
void AppendUnsynced(const std::filesystem::path& path,
                    std::span<const uint8_t> bytes);  // to one that is there

// A file under its final name at once, or not at all: written and synced beside, renamed, folder synced.
// beside: a name in the same file system, path + ".new" unless it is given.
void WriteFileAtomically(const std::filesystem::path& path, std::span<const uint8_t> bytes,
                         std::filesystem::path beside = {});

std::vector<uint8_t> ReadFile(const std::filesystem::path& path);
// Bytes first .. first + bytes - 1, or fewer where the file ends before.
std::vector<uint8_t> ReadPart(const std::filesystem::path& path, uint64_t first, size_t bytes);
std::vector<uint8_t> ReadStart(const std::filesystem::path& path, size_t most_bytes);
// Piece by piece, from byte `first` on, most_bytes at most; gives how many there were.
int64_t ReadPieces(const std::filesystem::path& path,
                   const std::function<void(std::span<const uint8_t>)>& piece, int64_t first = 0,
                   int64_t most_bytes = INT64_MAX);

// Replaces `to` where it is a file. Durable after SyncFolder of both parents.
void Rename(const std::filesystem::path& from, const std::filesystem::path& to);

// `to` becomes another name of the file where that is possible (one file system), else a copy. `to` is
// replaced.
void LinkOrCopy(const std::filesystem::path& from, const std::filesystem::path& to);
void SyncFolder(const std::filesystem::path& folder);
void MakeFolders(
    const std::filesystem::path& folder);  // with parents, each synced into its own; no error if there
void RemoveAll(const std::filesystem::path& path);  // no error if absent

// Bytes of a text, for the functions above.
std::span<const uint8_t> AsBytes(const std::string& text);

}  // namespace shimmer::dataset
