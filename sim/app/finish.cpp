#include "sim/app/finish.h"

#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/derived_files.h"

namespace shimmer::app {

void FinishDataset(const std::filesystem::path& folder, const dataset::Layout& layout) {
  dataset::WriteDerivedFiles(dataset::DatasetReader(folder), layout);
}

}  // namespace shimmer::app
