#include "sim/dataset/tar.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>

#include <exception>
#include <memory>
#include <stdexcept>

#include "sim/dataset/files.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

using Writer = std::unique_ptr<archive, decltype(&archive_write_free)>;
using Reader = std::unique_ptr<archive, decltype(&archive_read_free)>;
using Entry = std::unique_ptr<archive_entry, decltype(&archive_entry_free)>;

// Where libarchive's bytes go. An exception can't cross its C code: it waits here.
struct Target {
  FileHandle file;
  std::exception_ptr error;

  static la_ssize_t Write(archive* writer, void* target, const void* bytes, size_t size) {
    auto& self = *static_cast<Target*>(target);
    try {
      self.file.WriteAll({static_cast<const uint8_t*>(bytes), size});
      return static_cast<la_ssize_t>(size);
    } catch (...) {
      self.error = std::current_exception();
      archive_set_error(writer, EIO, "can't be written");
      return -1;
    }
  }
};

void Check(const fs::path& path, archive* tar, la_int64_t result, const std::exception_ptr& error = {}) {
  if (error) std::rethrow_exception(error);
  if (result >= ARCHIVE_OK) return;
  const char* text = archive_error_string(tar);
  throw std::runtime_error(path.string() + ": tar: " + (text ? text : "cut off or damaged"));
}

}  // namespace

std::vector<int64_t> WriteTar(const fs::path& path, const std::vector<TarMember>& members) {
  Target target{FileHandle(path, O_CREAT | O_WRONLY | O_TRUNC), {}};
  std::vector<int64_t> offsets;
  {
    const Writer tar(archive_write_new(), archive_write_free);
    const auto check = [&](la_int64_t result) { Check(path, tar.get(), result, target.error); };
    check(archive_write_set_format_ustar(tar.get()));
    check(archive_write_open(tar.get(), &target, nullptr, Target::Write, nullptr));
    int64_t place = 0;
    for (const TarMember& member : members) {
      if (member.name.size() > 100) throw std::invalid_argument(member.name + ": too long for a tar");
      const Entry entry(archive_entry_new(), archive_entry_free);
      archive_entry_set_pathname(entry.get(), member.name.c_str());
      archive_entry_set_filetype(entry.get(), AE_IFREG);
      archive_entry_set_perm(entry.get(), 0644);
      archive_entry_set_size(entry.get(), member.bytes);
      check(archive_write_header(tar.get(), entry.get()));
      int64_t written = 0;
      ReadPieces(member.place, [&](std::span<const uint8_t> piece) {
        check(archive_write_data(tar.get(), piece.data(), piece.size()));
        written += static_cast<int64_t>(piece.size());
      });
      if (written != member.bytes)
        throw std::runtime_error(member.place.string() + ": has changed since it was written");
      offsets.push_back(place + 512);
      place += TarBytes(member.bytes);
    }
    check(archive_write_close(tar.get()));
  }
  target.file.Sync();
  target.file.Close();
  return offsets;
}

std::vector<TarEntry> TarEntries(const fs::path& path) {
  const Reader tar(archive_read_new(), archive_read_free);
  const auto check = [&](la_int64_t result) { Check(path, tar.get(), result); };
  check(archive_read_support_format_tar(tar.get()));
  check(archive_read_open_filename(tar.get(), path.c_str(), size_t{1} << 16));
  std::vector<TarEntry> entries;
  for (archive_entry* entry = nullptr;;) {
    const int result = archive_read_next_header(tar.get(), &entry);
    if (result == ARCHIVE_EOF) break;
    check(result);
    entries.push_back({.name = archive_entry_pathname(entry),
                       .offset = archive_read_header_position(tar.get()) + 512,
                       .bytes = archive_entry_size(entry)});
    check(archive_read_data_skip(tar.get()));
  }
  return entries;
}

}  // namespace shimmer::dataset
