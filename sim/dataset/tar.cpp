#include "sim/dataset/tar.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

#include "sim/dataset/files.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

using Writer = std::unique_ptr<archive, decltype(&archive_write_free)>;
using Reader = std::unique_ptr<archive, decltype(&archive_read_free)>;
using Entry = std::unique_ptr<archive_entry, decltype(&archive_entry_free)>;

// Where libarchive's bytes go. An exception can't cross its C code: it waits here.
struct Target {
  std::function<void(std::span<const uint8_t>)> take;
  std::exception_ptr error;

  static la_ssize_t Write(archive* writer, void* target, const void* bytes, size_t size) {
    auto& self = *static_cast<Target*>(target);
    try {
      self.take({static_cast<const uint8_t*>(bytes), size});
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

// All bytes of a tar, in order; gives where each member's begin.
std::vector<int64_t> MakeTar(const fs::path& path, const std::vector<TarMember>& members,
                             std::function<void(std::span<const uint8_t>)> take) {
  Target target{std::move(take), {}};
  std::vector<int64_t> offsets;
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
    const int64_t read = ReadPieces(
        member.place,
        [&](std::span<const uint8_t> piece) {
          check(archive_write_data(tar.get(), piece.data(), piece.size()));
        },
        member.first, member.bytes);
    if (read != member.bytes)
      throw std::runtime_error(member.place.string() + ": is shorter than when it was written");
    offsets.push_back(place + 512);
    place += TarBytes(member.bytes);
  }
  check(archive_write_close(tar.get()));
  return offsets;
}

}  // namespace

std::vector<int64_t> WriteTar(const fs::path& path, const std::vector<TarMember>& members) {
  FileHandle file(path, O_CREAT | O_WRONLY | O_TRUNC);
  std::vector<int64_t> offsets =
      MakeTar(path, members, [&](std::span<const uint8_t> bytes) { file.WriteAll(bytes); });
  file.Sync();
  file.Close();
  return offsets;
}

std::optional<int64_t> TarDamage(const fs::path& path, const std::vector<TarEntry>& members) {
  std::vector<TarMember> again;
  for (const TarEntry& member : members)
    again.push_back({.name = member.name, .place = path, .bytes = member.bytes, .first = member.offset});
  FileHandle file(path, O_RDONLY);
  std::vector<uint8_t> there;
  std::optional<int64_t> first_difference;
  int64_t place = 0;
  MakeTar(path, again, [&](std::span<const uint8_t> bytes) {
    there.resize(bytes.size());
    size_t size = 0;
    while (const size_t got = file.ReadSome(std::span(there).subspan(size))) size += got;
    const auto differs = std::mismatch(bytes.begin(), bytes.end(), there.begin(), there.begin() + size);
    if (!first_difference && differs.first != bytes.end())
      first_difference = place + (differs.first - bytes.begin());
    place += static_cast<int64_t>(bytes.size());
  });
  uint8_t more = 0;
  if (!first_difference && file.ReadSome({&more, 1}) > 0) first_difference = place;
  return first_difference;
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

std::optional<std::string> FirstTarMember(const fs::path& path) {
  const Reader tar(archive_read_new(), archive_read_free);
  archive_entry* entry = nullptr;
  if (archive_read_support_format_tar(tar.get()) != ARCHIVE_OK ||
      archive_read_open_filename(tar.get(), path.c_str(), kTarEndBytes) != ARCHIVE_OK ||
      archive_read_next_header(tar.get(), &entry) != ARCHIVE_OK)
    return {};
  return archive_entry_pathname(entry);
}

}  // namespace shimmer::dataset
