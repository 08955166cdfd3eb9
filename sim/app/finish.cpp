#include "sim/app/finish.h"

#include "sim/app/report.h"
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
  for (const auto& manifest : dataset::ManifestsIn(folder))
    if (std::filesystem::exists(manifest) && std::filesystem::last_write_time(manifest) > report) return false;
  return true;
}

}  // namespace shimmer::app
