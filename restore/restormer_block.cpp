#include "restore/restormer_block.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "restore/row_tiles.h"

namespace shimmer::restore {
namespace {

constexpr size_t kBatchPx = 512;  // q and k of about so many px are multiplied at a time

// What a 1x1 convolution makes of rows, three at a time, for a depthwise convolution after it: planes with a
// panel on either side. What is outside the image is zero.
class ExpandedRows {
 public:
  ExpandedRows(const RowTile& tile, cv::Size image, int planes, Scratch& scratch)
      : tile_(tile), image_(image), planes_(static_cast<size_t>(planes)) {
    stride_ = (tile.PanelCount() + 2) * kPanelPx;
    for (float*& row : rows_) row = scratch.Take(planes_ * stride_);
  }

  // Px [Begin(), End()) are those that the tile's own need, counted from the panel before the tile's first.
  int Begin() const { return tile_.first_panel == 0 ? kPanelPx : kPanelPx - 1; }
  int End() const {
    return kPanelPx + std::min(Width(), static_cast<int>(tile_.PanelCount()) * kPanelPx + 1);
  }

  void SetOutside(int y) { std::fill_n(At(y), planes_ * stride_, 0.0f); }

  // row: as Multiply takes it, its panels counted as Begin's px are.
  void Expand(int y, const PackedMatrix& matrix, const float* row) {
    Multiply(matrix, row, Begin(), End(), {At(y), kPanelPx, stride_});
    const size_t right = kPanelPx + static_cast<size_t>(Width());  // the first px beyond the image
    for (size_t plane = 0; plane < planes_; ++plane) {
      if (tile_.first_panel == 0) At(y)[plane * stride_ + kPanelPx - 1] = 0;
      if (right < stride_) At(y)[plane * stride_ + right] = 0;
    }
  }

  ThreeRows Around(int y) { return {{At(y - 1), At(y), At(y + 1)}, stride_}; }

 private:
  int Width() const { return image_.width - static_cast<int>(tile_.first_panel) * kPanelPx; }
  float* At(int y) { return rows_[(y + 3) % 3]; }

  RowTile tile_;
  cv::Size image_;
  size_t planes_, stride_;
  float* rows_[3];
};

}  // namespace

struct RestormerBlock::Sums {
  std::vector<double> products, q_squares, k_squares;  // products: [head][i][j]
};

RestormerBlock::RestormerBlock(const SafeTensors& file, const std::string& name,
                               const RestormerShape& shape) {
  const auto tensor = [&](const std::string& part) -> const Tensor& {
    return file.tensors.at(name + "." + part);
  };
  const auto matrix = [&](const std::string& part) {
    const Tensor& of = tensor(part);
    return PackedMatrix(of.values.data(), static_cast<int>(of.shape[0]), static_cast<int>(of.shape[1]),
                        static_cast<size_t>(of.shape[1]));
  };
  const auto norm = [&](const std::string& part) {
    return Norm{tensor(part + ".weight").values,
                shape.norm_with_bias ? tensor(part + ".bias").values : std::vector<float>()};
  };
  norm1_ = norm("norm1");
  norm2_ = norm("norm2");
  qkv_ = matrix("attention.qkv.weight");
  project_in_ = matrix("feed_forward.project_in.weight");
  project_out_ = matrix("feed_forward.project_out.weight");
  temperature_ = tensor("attention.temperature").values;
  qkv_depthwise_ = tensor("attention.depthwise.weight").values;
  project_ = tensor("attention.project.weight").values;
  feed_depthwise_ = tensor("feed_forward.depthwise.weight").values;
}

void RestormerBlock::Run(Panels& x, Panels& spare_a, Panels& spare_b, Workspace& workspace) const {
  const PackedMatrix attention = AttendAll(x, spare_a, workspace);
  const std::vector<RowTile> tiles =
      RowTiles(x.Size(), 3 * kPanelPx * sizeof(float) * static_cast<size_t>(project_in_.Rows()));
  tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t i) {
    workspace.WithScratch(
        [&](Scratch& scratch) { FeedTile(x, spare_a, attention, tiles[i], spare_b, scratch); });
  });
  std::swap(x, spare_b);
}

PackedMatrix RestormerBlock::AttendAll(const Panels& x, Panels& v, Workspace& workspace) const {
  const std::vector<RowTile> tiles =
      RowTiles(x.Size(), 3 * kPanelPx * sizeof(float) * static_cast<size_t>(qkv_.Rows()));
  std::vector<Sums> sums(tiles.size());
  tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t i) {
    workspace.WithScratch([&](Scratch& scratch) { AttendTile(x, tiles[i], v, sums[i], scratch); });
  });
  return Attention(sums);
}

void RestormerBlock::AttendTile(const Panels& x, const RowTile& tile, Panels& v, Sums& sums,
                                Scratch& scratch) const {
  const int channels = Channels(), head = HeadChannels(), heads = channels / head;
  const size_t count = static_cast<size_t>(channels), panels = tile.PanelCount(), row_px = panels * kPanelPx;
  sums.products.assign(count * static_cast<size_t>(head), 0);
  sums.q_squares.assign(count, 0);
  sums.k_squares.assign(count, 0);
  const size_t batch_rows =
      std::clamp<size_t>(kBatchPx / row_px, 1, static_cast<size_t>(tile.end_row - tile.first_row));
  const size_t batch_px = batch_rows * row_px;
  float *normed = scratch.Take((panels + 2) * x.PanelStride()), *qk = scratch.Take(2 * count * batch_px);
  ExpandedRows expanded(tile, x.Size(), qkv_.Rows(), scratch);
  // Of the last panel only so many px are inside.
  const size_t inside = std::min(row_px, static_cast<size_t>(x.Size().width) - tile.first_panel * kPanelPx);

  const auto add_batch = [&](size_t rows) {
    float *q = qk, *k = q + count * batch_px;
    // (rows that were not reached, in a last batch)
    for (size_t plane = 0; plane < 2 * count; ++plane)
      std::fill_n(q + plane * batch_px + rows * row_px, (batch_rows - rows) * row_px, 0.0f);
    for (int h = 0; h < heads; ++h) {
      const size_t first = static_cast<size_t>(h * head);
      AddProducts(q + first * batch_px, k + first * batch_px, head, batch_px,
                  sums.products.data() + first * static_cast<size_t>(head));
    }
    AddSquares(q, channels, batch_px, sums.q_squares.data());
    AddSquares(k, channels, batch_px, sums.k_squares.data());
  };

  size_t rows = 0;  // in the batch
  for (int y = tile.first_row - 1; y <= tile.end_row; ++y) {
    if (y < 0 || y >= x.Size().height) {
      expanded.SetOutside(y);
    } else {
      NormaliseRow(x.At(y, static_cast<ptrdiff_t>(tile.first_panel) - 1), channels, expanded.Begin(),
                   expanded.End(), norm1_.Weights(), normed);
      expanded.Expand(y, qkv_, normed);
    }
    const int done = y - 1;
    if (done < tile.first_row) continue;
    ThreeRows around = expanded.Around(done);
    float* batch_row = qk + rows * row_px;
    DepthwiseRow(around, kPanelPx, 2 * channels, qkv_depthwise_.data(), panels,
                 {batch_row, kPanelPx, batch_px});
    if (inside < row_px)
      for (size_t plane = 0; plane < 2 * count; ++plane)
        std::fill_n(batch_row + plane * batch_px + inside, row_px - inside, 0.0f);
    for (const float*& row : around.rows) row += 2 * count * around.plane_stride;
    DepthwiseRow(around, kPanelPx, channels, qkv_depthwise_.data() + 2 * count * 9, panels,
                 {v.At(done, static_cast<ptrdiff_t>(tile.first_panel)), v.PanelStride(), kPanelPx});
    if (++rows == batch_rows || done + 1 == tile.end_row) {
      add_batch(rows);
      rows = 0;
    }
  }
}

PackedMatrix RestormerBlock::Attention(const std::vector<Sums>& tiles) const {
  constexpr double kLeastNorm = 1e-12;  // as torch's normalize has it
  Sums all = tiles.front();
  const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
    for (size_t i = 0; i < to.size(); ++i) to[i] += from[i];
  };
  for (size_t tile = 1; tile < tiles.size(); ++tile) {
    add(all.products, tiles[tile].products);
    add(all.q_squares, tiles[tile].q_squares);
    add(all.k_squares, tiles[tile].k_squares);
  }
  const size_t count = static_cast<size_t>(Channels()), head = static_cast<size_t>(HeadChannels());
  std::vector<float> softmax(count * head), product(count * count, 0.0f);
  std::vector<double> row(head);
  for (size_t i = 0; i < count; ++i) {
    const size_t first = i / head * head;
    const double q_norm = std::max(kLeastNorm, std::sqrt(all.q_squares[i]));
    for (size_t j = 0; j < head; ++j)
      row[j] = all.products[i * head + j] * static_cast<double>(temperature_[i / head]) /
               (q_norm * std::max(kLeastNorm, std::sqrt(all.k_squares[first + j])));
    const double most = *std::max_element(row.begin(), row.end());
    double sum = 0;
    for (double& value : row) sum += value = std::exp(value - most);
    for (size_t j = 0; j < head; ++j) softmax[i * head + j] = static_cast<float>(row[j] / sum);
  }
  tbb::parallel_for(size_t{0}, count, [&](size_t c) {
    for (size_t i = 0; i < count; ++i) {
      const float weight = project_[c * count + i];
      float* to = product.data() + c * count + i / head * head;
      for (size_t j = 0; j < head; ++j) to[j] += weight * softmax[i * head + j];
    }
  });
  return PackedMatrix(product.data(), Channels(), Channels(), count);
}

void RestormerBlock::FeedTile(const Panels& x, const Panels& v, const PackedMatrix& attention,
                              const RowTile& tile, Panels& out, Scratch& scratch) const {
  const int channels = Channels(), hidden = project_out_.Columns();
  const ptrdiff_t first_panel = static_cast<ptrdiff_t>(tile.first_panel);
  const size_t panels = tile.PanelCount(), stride = x.PanelStride();
  float *normed = scratch.Take((panels + 2) * stride),
        *gated = scratch.Take(panels * static_cast<size_t>(hidden) * kPanelPx);
  float* const attended[] = {scratch.Take((panels + 2) * stride),
                             scratch.Take((panels + 2) * stride)};  // x + attention
  ExpandedRows expanded(tile, x.Size(), project_in_.Rows(), scratch);
  const int tile_px = std::min(static_cast<int>(panels) * kPanelPx,
                               x.Size().width - static_cast<int>(first_panel) * kPanelPx);
  for (int y = tile.first_row - 1; y <= tile.end_row; ++y) {
    if (y < 0 || y >= x.Size().height) {
      expanded.SetOutside(y);
    } else {
      float* row = attended[y & 1];
      Multiply(attention, v.At(y, first_panel - 1), expanded.Begin(), expanded.End(), {row, stride, kPanelPx},
               x.At(y, first_panel - 1));
      NormaliseRow(row, channels, expanded.Begin(), expanded.End(), norm2_.Weights(), normed);
      expanded.Expand(y, project_in_, normed);
    }
    const int done = y - 1;
    if (done < tile.first_row) continue;
    GateRow(expanded.Around(done), kPanelPx, hidden, feed_depthwise_.data(), panels, gated);
    Multiply(project_out_, gated, 0, tile_px, {out.At(done, first_panel), stride, kPanelPx},
             attended[done & 1] + stride);
  }
}

}  // namespace shimmer::restore
