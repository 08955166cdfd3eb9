// One transformer block of a Restormer.
#pragma once

#include "restore/model_card.h"
#include "restore/panel_rows.h"

namespace shimmer::restore {

// x + attention(norm1(x)), and of that y: y + feed_forward(norm2(y)).
//
// Attention is between channels ("multi-Dconv head transposed"): q, k and v are 1x1 and depthwise 3x3
// convolutions of what is normalised; per head of d channels, q and k over their norms over all px,
// softmax(q k^T temperature) v, and a 1x1 convolution. Feed forward ("gated-Dconv") is 1x1 and depthwise 3x3
// convolutions to two halves, gelu(first) * second, and a 1x1 convolution. 3x3 convolutions take zeros
// outside.
class RestormerBlock {
 public:
  // The tensors "NAME.*" of a file that CheckRestormerTensors has passed.
  RestormerBlock(const SafeTensors& file, const std::string& name, const RestormerShape& shape);

  int Channels() const { return project_in_.Columns(); }

  // x becomes what comes out. spare_a and spare_b are as large as x; what they hold then is not specified.
  void Run(Panels& x, Panels& spare_a, Panels& spare_b, Workspace& workspace) const;

 private:
  struct Norm {
    std::vector<float> weight, bias;  // bias empty: bias-free
    NormWeights Weights() const { return {weight.data(), bias.empty() ? nullptr : bias.data()}; }
  };
  struct Sums;  // over px: products of q and k, squares of both

  PackedMatrix AttendAll(const Panels& x, Panels& v,
                         Workspace& workspace) const;  // what v is multiplied with: softmax and project
  void AttendTile(const Panels& x, const struct RowTile& tile, Panels& v, Sums& sums, Scratch& scratch) const;
  PackedMatrix Attention(const std::vector<Sums>& tiles) const;
  void FeedTile(const Panels& x, const Panels& v, const PackedMatrix& attention, const RowTile& tile,
                Panels& out, Scratch& scratch) const;
  int HeadChannels() const { return Channels() / static_cast<int>(temperature_.size()); }

  Norm norm1_, norm2_;
  PackedMatrix qkv_, project_in_, project_out_;
  std::vector<float> temperature_, qkv_depthwise_, project_, feed_depthwise_;
};

}  // namespace shimmer::restore
