#include "sim/app/finish.h"

#include <algorithm>
#include <vector>

#include "sim/app/report.h"
#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/derived_files.h"

namespace shimmer::app {

void FinishDataset(const std::filesystem::path& folder, const dataset::Layout& layout) {
  dataset::WriteDerivedFiles(dataset::DatasetReader(folder), layout);
  WriteReport(folder);
}

bool IsFinished(const std::filesystem::path& folder) {
  std::error_code absent;
  const auto report = std::filesystem::last_write_time(folder / kReportName, absent);
  if (absent) return false;
  // Later files, or another number of clips, are not in it.
  std::vector<std::filesystem::path> shown = dataset::ManifestsIn(folder);
  shown.push_back(folder / dataset::kDescriptionName);
  return std::ranges::none_of(shown, [&](const std::filesystem::path& path) {
    return std::filesystem::exists(path) && std::filesystem::last_write_time(path) > report;
  });
}

}  // namespace shimmer::app
