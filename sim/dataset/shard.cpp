#include "sim/dataset/shard.h"

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

}  // namespace shimmer::dataset
