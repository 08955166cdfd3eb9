#include "sim/dataset/own_entries.h"

#include <stdexcept>
#include <system_error>

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

void RequireIn(const fs::path& folder) {
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder, absent)) {
    std::error_code gone;  // by another shard, meanwhile
    const fs::file_type type = fs::symlink_status(entry.path(), gone).type();
    if (gone || type == fs::file_type::regular || type == fs::file_type::directory) continue;
    const char* what = type == fs::file_type::symlink ? "a link" : "no file and no folder";
    throw std::invalid_argument(entry.path().string() + ": is " + what +
                                ", must be a file or folder of the data set's own");
  }
}

}  // namespace

void RequireOwnEntries(const fs::path& folder, const Layout& layout) {
  RequireIn(folder);
  if (layout.IsPairs())
    for (const char* part : {"", "train", "test"}) RequireIn(folder / layout.name / part);
  if (layout.kind != LayoutKind::kBasicsr) return;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder, absent))
    if (entry.path().filename().string().starts_with("part")) RequireIn(entry.path());
}

}  // namespace shimmer::dataset
