// 3x3 convolutions between all channels.
#pragma once

#include <array>

#include "restore/panel_product.h"
#include "restore/safe_tensors.h"

namespace shimmer::restore {

class Convolution {
 public:
  Convolution() = default;
  explicit Convolution(const Tensor& weights);  // [outputs, inputs, 3, 3]

  // Outside the image are zeros.
  Panels Run(const Panels& image, Workspace& workspace) const;

 private:
  void RunTile(const Panels& image, const struct RowTile& tile, Panels& out, Scratch& scratch) const;

  std::array<PackedMatrix, 3> rows_;  // of the row above, at and below: [output, column * inputs + input]
};

}  // namespace shimmer::restore
