// What lies between a Restormer's products, a row of panels at a time.
#pragma once

#include <span>

#include "restore/panel_product.h"

namespace shimmer::restore {

struct NormWeights {  // one a channel
  const float* weight = nullptr;
  const float* bias = nullptr;  // null: bias-free
};

// Each px's channels over their standard deviation (with 1e-5 added to the variance, which is over all
// channels and biased), times the weights; with a bias their mean is subtracted first and the bias added.
// Bias-free they keep their mean, as BiasFree_LayerNorm of github.com/swz30/Restormer does. Px [begin, end)
// of row, and those that fill their vectors up; row and out: [panel][channel][16].
void NormaliseRow(const float* row, int channels, int begin, int end, const NormWeights& norm, float* out);

// Three rows of planes, [plane][px], above, at and below the one asked for.
struct ThreeRows {
  const float* rows[3];
  size_t plane_stride;
};

// A 3x3 convolution of each of some planes with its own nine weights, from px `first` of the rows, whose
// neighbours are read, over whole panels. weights: [plane][row][column].
void DepthwiseRow(const ThreeRows& from, int first, int planes, const float* weights, size_t panels,
                  const RowPlace& out);

// gelu(a) b, of a the depthwise convolutions of the first half of the planes and b those of the second, with
// gelu(a) = a Phi(a). out: [panel][plane of the first half][16].
void GateRow(const ThreeRows& from, int first, int half, const float* weights, size_t panels, float* out);

// products[i * channels + j] += sum over px of q_i k_j. q, k: [channel][count px], count whole panels.
void AddProducts(const float* q, const float* k, int channels, size_t count, double* products);

// squares[i] += sum over px of values_i^2, [channel][count px].
void AddSquares(const float* values, int channels, size_t count, double* squares);

// Phi(x) of each, off by 1.1e-7 at most: what GateRow takes.
void NormalShares(std::span<const float> x, float* out);

}  // namespace shimmer::restore
