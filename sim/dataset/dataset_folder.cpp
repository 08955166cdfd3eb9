#include "sim/dataset/dataset_folder.h"

#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <stdexcept>
#include <string>
#include <system_error>

#include "sim/dataset/dataset_difference.h"
#include "sim/dataset/files.h"
#include "sim/dataset/folder_lock.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// A folder without dataset.json must hold nothing but what a kill of ours at the very start may leave.
// Another shard may begin at this moment: whatever it writes, dataset.json is there first.
void RefuseForeignFolder(const fs::path& folder) {
  if (fs::exists(folder / kDescriptionName)) return;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kStagingName) || name.starts_with(kLockName)) continue;
    if (fs::exists(folder / kDescriptionName)) return;
    throw std::invalid_argument(folder.string() + ": holds other files (" + name +
                                ") and no data set; give a new or an empty folder");
  }
}

// A source that can't be read now is still the one that it was.
Json WithKnownHashes(const Json& there, const Json& description) {
  std::map<std::string, Json> known;
  for (const Json& source : there) known[source.value("path", "")] = source.value("sha256", Json());
  Json sources = description.value("sources", Json::array());
  for (Json& source : sources) {
    const auto found = known.find(source.value("path", ""));
    if (found != known.end() && source.value("sha256", Json()).is_null()) source["sha256"] = found->second;
  }
  return sources;
}

}  // namespace

void MakeDatasetFolder(const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw std::invalid_argument(folder.string() + ": is a file, must be a folder");
  MakeFolders(folder);
  RefuseForeignFolder(folder);
}

void WriteDatasetFile(const fs::path& folder, const std::string& name, std::span<const uint8_t> bytes) {
  if (fs::is_regular_file(folder / name) && std::ranges::equal(ReadFile(folder / name), bytes)) return;
  const fs::path to = folder / name;
  std::string staging = (folder / (std::string(kStagingName) + ".XXXXXX")).string();
  if (!mkdtemp(staging.data()))
    throw std::runtime_error(to.string() + ": can't be written: " + std::generic_category().message(errno));
  const auto clear_away = [&] {
    std::error_code ignored;
    fs::remove_all(staging, ignored);
  };
  try {
    WriteFileAtomically(to, bytes, staging / to.filename());
  } catch (...) {
    clear_away();
    throw;
  }
  clear_away();
}

Json ReadDescription(const fs::path& folder) {
  const fs::path path = folder / kDescriptionName;
  if (!fs::exists(path))
    throw std::runtime_error(folder.string() + ": not a data set (no " + kDescriptionName + " in it)");
  Json description = Json::parse(ReadFile(path), nullptr, /*allow_exceptions=*/false);
  if (!description.is_object() || !description.value("config", Json()).is_object() ||
      !description.value("sources", Json::array()).is_array())
    throw std::runtime_error(path.string() + ": damaged, must be a JSON object with config and sources");
  return description;
}

void WriteDescription(const fs::path& folder, const Json& description) {
  Json written = description;
  if (fs::exists(folder / kDescriptionName)) {
    const Json there = ReadDescription(folder);
    const std::vector<std::string> differences = Differences(there, description);
    if (!differences.empty())
      throw std::invalid_argument(folder.string() + ": holds a data set made from something else: " +
                                  InOneLine(differences) + ". Give another folder, or make the same again");
    written["sources"] = WithKnownHashes(there.value("sources", Json::array()), description);
    if (there == written) return;
  }
  const std::string text = written.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  WriteDatasetFile(folder, kDescriptionName, AsBytes(text));
}

}  // namespace shimmer::dataset
