// The tensors that a Restormer's file of weights must hold.
#pragma once

#include "restore/model_card.h"

namespace shimmer::restore {

struct TensorShape {
  std::string name;
  std::vector<int64_t> shape;
};

// All that a network of this shape needs, in the order of its use. Convolutions are as torch keeps them,
// [outputs, inputs, rows, columns], and have no bias. u is the shape's unshuffle, C_l level l's channels.
//   embed.weight                 [C_0, 3 u^2, 3, 3]
//   encoder.LEVEL.BLOCK.*        of every level, the last being the bottom
//   down.LEVEL.weight            [C_l / 2, C_l, 3, 3], from level l to the next
//   up.LEVEL.weight              [2 C_(l+1), C_(l+1), 3, 3], into level l
//   reduce.LEVEL.weight          [C_l, 2 C_l, 1, 1], l >= 1: of what came up, then what the encoder left
//   decoder.LEVEL.BLOCK.*        of every level but the bottom; level 0 has 2 C_0 channels
//   refinement.BLOCK.*           2 C_0 channels, heads of level 0
//   output.weight                [3 u^2, 2 C_0, 3, 3]
// A block of C channels, h heads and H hidden channels has
//   norm1.weight, norm2.weight   [C], and norm1.bias, norm2.bias [C] if the norm has biases
//   attention.temperature        [h]
//   attention.qkv.weight         [3 C, C, 1, 1],  attention.depthwise.weight [3 C, 1, 3, 3]
//   attention.project.weight     [C, C, 1, 1]
//   feed_forward.project_in.weight [2 H, C, 1, 1],  feed_forward.depthwise.weight [2 H, 1, 3, 3]
//   feed_forward.project_out.weight [C, H, 1, 1]
std::vector<TensorShape> RestormerTensors(const RestormerShape& shape);

// Throws std::runtime_error with the file, the first tensor that is missing, has another shape or is one too
// many, its shape and the one that the card asks for. A recorded sample, sample.input and sample.output, may
// be there: both or none, [3, height, width] and alike.
void CheckRestormerTensors(const SafeTensors& file, const RestormerShape& shape);

}  // namespace shimmer::restore
