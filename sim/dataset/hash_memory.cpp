#include "sim/dataset/hash_memory.h"

#include <sys/stat.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/files.h"
#include "sim/dataset/interrupted.h"
#include "sim/dataset/sha256.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// The last line: two runs that write at once, or a damaged disk, may leave any mixture of lines before it.
constexpr const char* kHashOfLines = "sha256_of_lines";

int64_t Now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

// A file that was changed just now may be changed again within the same tick of the file system's clock.
bool ChangedJustNow(int64_t mtime_ns) { return Now_ns() - mtime_ns < 2'000'000'000; }

std::string HashOfBytes(const fs::path& file, const std::atomic<bool>& stop) {
  Sha256 hash;
  ReadPieces(file, [&](std::span<const uint8_t> piece) {
    if (stop) throw Interrupted();
    hash.Add(piece);
  });
  return hash.Hex();
}

}  // namespace

HashMemory::HashMemory(const fs::path& folder) {
  try {
    RequireFile(folder / kHashMemoryName);
    Parse(ReadFile(folder / kHashMemoryName));
  } catch (const std::exception&) {  // there is none, or it is damaged
    known_.clear();
  }
}

void HashMemory::Parse(const std::vector<uint8_t>& bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const size_t last = text.rfind('\n', text.size() - 2) + 1;  // where the last line begins
  const std::string hash = Sha256Hex(std::span(bytes).first(last));
  if (Json::parse(text.substr(last)).at(kHashOfLines) != hash) return;
  for (size_t begin = 0, end = 0; begin < last; begin = end) {
    end = text.find('\n', begin) + 1;
    const Json line = Json::parse(text.substr(begin, end - begin));
    known_[line.at("path").get<std::string>()] = {line.at("bytes"), line.at("mtime_ns"), line.at("sha256")};
  }
  hash_of_known_ = hash;
}

std::string HashMemory::HashOf(const fs::path& file, const std::atomic<bool>& stop) {
  RequireFile(file);  // a pipe would be waited for
  struct stat status = {};
  if (stat(file.c_str(), &status) != 0) throw std::runtime_error(file.string() + ": can't be read");
  const auto bytes = static_cast<uint64_t>(status.st_size);
  const int64_t mtime_ns = status.st_mtim.tv_sec * int64_t{1'000'000'000} + status.st_mtim.tv_nsec;
  const std::string path = fs::absolute(file).lexically_normal().string();
  const auto known = known_.find(path);
  const bool same =
      known != known_.end() && known->second.bytes == bytes && known->second.mtime_ns == mtime_ns;
  const bool lasts = same || !ChangedJustNow(mtime_ns);
  const Known now{bytes, mtime_ns, same ? known->second.sha256 : HashOfBytes(file, stop)};
  if (lasts) {
    const std::lock_guard lock(mutex_);
    asked_[path] = now;
  }
  return now.sha256;
}

void HashMemory::Write(const fs::path& folder) const {
  const std::lock_guard lock(mutex_);
  std::string lines;
  for (const auto& [path, known] : asked_) {
    const Json line = {
        {"path", path}, {"bytes", known.bytes}, {"mtime_ns", known.mtime_ns}, {"sha256", known.sha256}};
    try {
      lines += line.dump() + "\n";
    } catch (const Json::type_error&) {
      // a name that is no UTF-8, which JSON can't hold
    }
  }
  const std::string hash = Sha256Hex(AsBytes(lines));
  if (hash == hash_of_known_) return;
  const Json last = {{kHashOfLines, hash}};
  try {
    WriteDatasetFile(folder, kHashMemoryName, AsBytes(lines + last.dump() + "\n"));
  } catch (const std::runtime_error&) {
    // the next run reads the sources again
  }
}

}  // namespace shimmer::dataset
