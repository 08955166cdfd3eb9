#include "sim/app/origin.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/files.h"

namespace shimmer::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kConfigFolder = "config_folder";

// null if it is not there or damaged.
Json Read(const fs::path& folder) {
  if (!fs::exists(folder / dataset::kOriginName)) return {};
  const Json json =
      Json::parse(dataset::ReadFile(folder / dataset::kOriginName), nullptr, /*allow_exceptions=*/false);
  return json.is_object() ? json.value(kConfigFolder, Json()) : Json();
}

}  // namespace

void NoteConfigFolder(const fs::path& folder, const fs::path& config_folder) {
  const fs::path place = fs::weakly_canonical(config_folder.empty() ? "." : config_folder);
  const std::string text =
      Json{{kConfigFolder, place.string()}}.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (Read(folder) == Json::parse(text)[kConfigFolder]) return;
  dataset::WriteDatasetFile(folder, dataset::kOriginName, dataset::AsBytes(text));
}

fs::path NotedConfigFolder(const fs::path& folder) {
  const Json place = Read(folder);
  if (!place.is_string())
    throw std::runtime_error(
        folder.string() +
        ": can't be made again: it is not noted where its config lay; --config-folder says so");
  return place.get<std::string>();
}

}  // namespace shimmer::app
