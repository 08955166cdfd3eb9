#include "sim/dataset/files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const fs::path& path, const std::string& what, int error) {
  throw std::runtime_error(path.string() + ": " + what + ": " + std::generic_category().message(error));
}

void Check(const fs::path& path, const std::string& what, const std::error_code& error) {
  if (error) throw std::runtime_error(path.string() + ": " + what + ": " + error.message());
}

// Repeats a system call that a signal interrupted.
template <class Call>
auto Again(Call call) {
  for (;;) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

}  // namespace

FileHandle::FileHandle(const fs::path& path, int flags, unsigned mode) : path_(path) {
  descriptor_ = Again([&] { return open(path.c_str(), flags | O_CLOEXEC, mode); });
  if (descriptor_ < 0) Fail(path_, (flags & O_CREAT) ? "can't be written" : "can't be opened", errno);
}

FileHandle::~FileHandle() {
  if (descriptor_ >= 0) close(descriptor_);
}

FileHandle::FileHandle(FileHandle&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

void FileHandle::WriteAll(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = Again([&] { return write(descriptor_, bytes.data(), bytes.size()); });
    if (written < 0) Fail(path_, "can't be written", errno);
    bytes = bytes.subspan(written);
  }
}

size_t FileHandle::ReadSome(std::span<uint8_t> buffer) {
  const ssize_t got = Again([&] { return read(descriptor_, buffer.data(), buffer.size()); });
  if (got < 0) Fail(path_, "can't be read", errno);
  return got;
}

void FileHandle::Seek(uint64_t place) {
  if (lseek(descriptor_, static_cast<off_t>(place), SEEK_SET) < 0) Fail(path_, "can't be read", errno);
}

void FileHandle::StartSync() {
  // A hint only: Sync() says what went wrong.
  sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE);
}

void FileHandle::Sync() {
  // Some file systems have nothing to sync for a folder or a pipe and say EINVAL.
  if (Again([&] { return fsync(descriptor_); }) < 0 && errno != EINVAL) Fail(path_, "can't be synced", errno);
}

void FileHandle::SyncFileSystem() {
  if (Again([&] { return syncfs(descriptor_); }) < 0) Fail(path_, "can't be synced", errno);
}

void FileHandle::Truncate(uint64_t bytes) {
  if (Again([&] { return ftruncate(descriptor_, bytes); }) < 0) Fail(path_, "can't be cut", errno);
}

void FileHandle::Close() {
  // Not repeated on EINTR: Linux has closed the descriptor by then.
  if (close(std::exchange(descriptor_, -1)) < 0 && errno != EINTR) Fail(path_, "can't be closed", errno);
}

Lock FileHandle::TryLock(LockKind kind) {
  const int operation = (kind == LockKind::kShared ? LOCK_SH : LOCK_EX) | LOCK_NB;
  if (Again([&] { return flock(descriptor_, operation); }) == 0) return Lock::kHeld;
  if (errno == EWOULDBLOCK) return Lock::kTaken;
  if (errno == ENOLCK || errno == ENOSYS || errno == EOPNOTSUPP) return Lock::kNone;
  Fail(path_, "can't be locked", errno);
}

void RequireFile(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  const auto refuse = [&](const std::string& what) { throw std::runtime_error(path.string() + ": " + what); };
  if (status.type() == fs::file_type::not_found) refuse("no such file");
  Check(path, "can't be read", error);
  if (fs::is_directory(status)) refuse("is a folder, must be a file");
  if (!fs::is_regular_file(status)) refuse("is not a regular file");
  if (fs::file_size(path, error) == 0) refuse("the file is empty (0 bytes)");
}

void WriteFiles(std::span<const FileToWrite> files) {
  constexpr size_t kMostOpen = 64;
  while (!files.empty()) {
    const auto batch = files.first(std::min(kMostOpen, files.size()));
    std::vector<FileHandle> open;
    for (const FileToWrite& file : batch) {
      open.emplace_back(file.path, O_CREAT | O_WRONLY | O_TRUNC);
      open.back().WriteAll(file.bytes);
      open.back().StartSync();
    }
    for (FileHandle& file : open) {
      file.Sync();
      file.Close();
    }
    files = files.subspan(batch.size());
  }
}

void WriteFile(const fs::path& path, std::span<const uint8_t> bytes) {
  const FileToWrite file{path, bytes};
  WriteFiles({&file, 1});
}

void WriteUnsynced(const fs::path& path, std::span<const uint8_t> bytes) {
  FileHandle file(path, O_CREAT | O_WRONLY | O_TRUNC);
  file.WriteAll(bytes);
  file.Close();
}

void AppendUnsynced(const fs::path& path, std::span<const uint8_t> bytes) {
  FileHandle file(path, O_WRONLY | O_APPEND);
  file.WriteAll(bytes);
  file.Close();
}

void WriteFileAtomically(const fs::path& path, std::span<const uint8_t> bytes, fs::path beside) {
  if (beside.empty()) beside = path.string() + ".new";
  try {
    WriteFile(beside, bytes);
    Rename(beside, path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(beside, ignored);
    throw;
  }
  SyncFolder(path.parent_path());
}

int64_t ReadPieces(const fs::path& path, const std::function<void(std::span<const uint8_t>)>& piece,
                   int64_t first, int64_t most_bytes) {
  FileHandle file(path, O_RDONLY);
  if (first != 0) file.Seek(static_cast<uint64_t>(first));
  std::vector<uint8_t> buffer(static_cast<size_t>(std::min<int64_t>(most_bytes, 1 << 18)));
  int64_t bytes = 0;
  while (bytes < most_bytes) {
    const auto most = static_cast<size_t>(std::min<int64_t>(most_bytes - bytes, std::ssize(buffer)));
    const size_t got = file.ReadSome(std::span(buffer).first(most));
    if (got == 0) break;
    piece({buffer.data(), got});
    bytes += static_cast<int64_t>(got);
  }
  return bytes;
}

std::vector<uint8_t> ReadFile(const fs::path& path) {
  std::vector<uint8_t> bytes;
  ReadPieces(path,
             [&](std::span<const uint8_t> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
  return bytes;
}

std::vector<uint8_t> ReadPart(const fs::path& path, uint64_t first, size_t most_bytes) {
  FileHandle file(path, O_RDONLY);
  file.Seek(first);
  std::vector<uint8_t> bytes(most_bytes);
  size_t size = 0;
  while (const size_t got = file.ReadSome(std::span(bytes).subspan(size))) size += got;
  bytes.resize(size);
  return bytes;
}

std::vector<uint8_t> ReadStart(const fs::path& path, size_t most_bytes) {
  return ReadPart(path, 0, most_bytes);
}

void Rename(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  Check(to, "can't be put in place", error);
}

void LinkOrCopy(const fs::path& from, const fs::path& to) {
  RemoveAll(to);
  std::error_code error;
  fs::create_hard_link(from, to, error);
  if (!error) return;
  fs::copy_file(from, to, error);
  if (!error) return;
  RequireFile(from);
  Check(to, "can't be written", error);
}

void SyncFolder(const fs::path& folder) {
  FileHandle(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY).Sync();
}

void MakeFolders(const fs::path& folder) {
  if (folder.empty() || fs::is_directory(folder)) return;
  MakeFolders(folder.parent_path());
  std::error_code error;
  fs::create_directory(folder, error);
  Check(folder, "can't be made", error);
  SyncFolder(folder.parent_path());
}

void RemoveAll(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  Check(path, "can't be removed", error);
}

std::span<const uint8_t> AsBytes(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

}  // namespace shimmer::dataset
