#include "sim/dataset/shard.h"

#include <cinttypes>
#include <cstdio>
#include <stdexcept>

#include "sim/dataset/numbered_name.h"

namespace shimmer::dataset {

void Shard::Validate() const {
  if (count < 1 || index < 0 || index >= count)
    throw std::invalid_argument("shard " + std::to_string(index) + "/" + std::to_string(count) +
                                ": must be i/N with 0 <= i < N");
}

std::string Shard::Suffix() const {
  return whole() ? "" : "." + Padded(index, 3) + "-of-" + Padded(count, 3);
}

std::optional<Shard> ShardOfManifest(const std::string& name) {
  Shard shard;
  int end = 0;
  if (std::sscanf(name.c_str(), "manifest.%9" SCNd64 "-of-%9" SCNd64 ".jsonl%n", &shard.index, &shard.count,
                  &end) != 2)
    return {};
  const bool is_shard = shard.count > 1 && shard.index >= 0 && shard.index < shard.count;
  return is_shard && name == "manifest" + shard.Suffix() + ".jsonl" ? std::optional(shard) : std::nullopt;
}

}  // namespace shimmer::dataset
