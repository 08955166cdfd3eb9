// The kernels of a Restormer against plain loops in double, on every SIMD target of this machine.
#include "restore/panel_rows.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>

#include <cmath>
#include <functional>

namespace shimmer::restore {
namespace {

constexpr size_t kPx = kPanelPx;

void OnEveryTarget(const std::function<void()>& check) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
}

struct Values {
  Floats data;
  size_t count;

  explicit Values(size_t count, uint64_t seed = 0) : data(MakeFloats(count)), count(count) {
    cv::RNG random(seed + 1);
    for (size_t i = 0; i < count; ++i) data[i] = static_cast<float>(random.gaussian(1));
  }
  float* Get() const { return data.get(); }
  double operator[](size_t i) const { return static_cast<double>(data[i]); }
};

double GeluOf(double x) { return x * std::erfc(-x / std::sqrt(2.0)) / 2; }

TEST(PanelProduct, IsThatOfTheMatrix) {
  OnEveryTarget([] {
    for (const int rows : {1, 2, 5, 6, 7, 16, 32, 43})
      for (const size_t columns : {1u, 8u, 85u}) {
        constexpr int kBegin = 15, kEnd = 70;
        const size_t channels = static_cast<size_t>(rows), panels = PanelsFor(kEnd);
        const Values matrix(channels * columns, 1), row(panels * columns * kPx, 2),
            add(panels * channels * kPx, 3);
        const PackedMatrix packed(matrix.Get(), rows, static_cast<int>(columns), columns);
        Values out(panels * channels * kPx, 4), planes(channels * panels * kPx, 5);
        Multiply(packed, row.Get(), kBegin, kEnd, {out.Get(), channels * kPx, kPx}, add.Get());
        Multiply(packed, row.Get(), kBegin, kEnd, {planes.Get(), kPx, panels * kPx});
        for (size_t px = kBegin; px < kEnd; ++px)
          for (size_t c = 0; c < channels; ++c) {
            double sum = 0;
            for (size_t k = 0; k < columns; ++k)
              sum += matrix[c * columns + k] * row[(px / kPx * columns + k) * kPx + px % kPx];
            const size_t at = (px / kPx * channels + c) * kPx + px % kPx;
            ASSERT_NEAR(planes[c * panels * kPx + px], sum, 2e-5) << rows << " " << columns << " " << px;
            ASSERT_NEAR(out[at], sum + add[at], 2e-5) << rows << " " << columns << " " << px;
          }
      }
  });
}

TEST(PanelProduct, TakesPartsOfAMatrix) {
  const Values matrix(6, 1), row(2 * kPx, 2);
  const Values out(2 * kPx), transposed(2 * kPx);
  Multiply(PackedMatrix(matrix.Get() + 1, 2, 2, 3), row.Get(), 0, 1, {out.Get(), 0, kPx});
  Multiply(PackedMatrix(matrix.Get(), 2, 2, 1, 2), row.Get(), 0, 1, {transposed.Get(), 0, kPx});
  EXPECT_NEAR(out[kPx], matrix[4] * row[0] + matrix[5] * row[kPx], 1e-6);
  EXPECT_NEAR(transposed[kPx], matrix[1] * row[0] + matrix[3] * row[kPx], 1e-6);
}

TEST(PanelRows, ChannelsAreNormalised) {
  OnEveryTarget([] {
    for (const size_t channels : {2u, 7u, 48u})
      for (const bool with_bias : {true, false}) {
        const Values row(3 * channels * kPx, 1), weight(channels, 2), bias(channels, 3);
        const Values out(3 * channels * kPx);
        NormaliseRow(row.Get(), static_cast<int>(channels), 15, 40,
                     {weight.Get(), with_bias ? bias.Get() : nullptr}, out.Get());
        for (size_t px = 15; px < 40; ++px) {
          const auto at = [&](size_t c) { return (px / kPx * channels + c) * kPx + px % kPx; };
          double mean = 0, variance = 0;
          for (size_t c = 0; c < channels; ++c) mean += row[at(c)] / static_cast<double>(channels);
          for (size_t c = 0; c < channels; ++c)
            variance += std::pow(row[at(c)] - mean, 2) / static_cast<double>(channels);
          const double sd = std::sqrt(variance + 1e-5);
          for (size_t c = 0; c < channels; ++c) {
            const double wanted =
                with_bias ? (row[at(c)] - mean) / sd * weight[c] + bias[c] : row[at(c)] / sd * weight[c];
            ASSERT_NEAR(out[at(c)], wanted, 2e-6 * (1 + std::abs(wanted) + 1 / sd)) << channels << " " << px;
          }
        }
      }
  });
}

// Three rows of planes with a panel on either side, and their convolutions.
struct Rows {
  static constexpr size_t kPanels = 3, kStride = (kPanels + 2) * kPx;
  size_t planes;
  Values above{planes * kStride, 1}, here{planes * kStride, 2}, below{planes * kStride, 3},
      weights{9 * planes, 4};

  ThreeRows Three() const { return {{above.Get(), here.Get(), below.Get()}, kStride}; }
  double Convolved(size_t plane, size_t px) const {
    const Values* rows[] = {&above, &here, &below};
    double sum = 0;
    for (size_t j = 0; j < 3; ++j)
      for (size_t i = 0; i < 3; ++i)
        sum += weights[9 * plane + 3 * j + i] * (*rows[j])[plane * kStride + kPx + px + i - 1];
    return sum;
  }
};

TEST(PanelRows, PlanesAreConvolved) {
  OnEveryTarget([] {
    const Rows rows{.planes = 5};
    const size_t count = Rows::kPanels * kPx;
    const Values planes(5 * count), panels(5 * count);
    DepthwiseRow(rows.Three(), kPanelPx, 5, rows.weights.Get(), Rows::kPanels, {planes.Get(), kPx, count});
    DepthwiseRow(rows.Three(), kPanelPx, 5, rows.weights.Get(), Rows::kPanels, {panels.Get(), 5 * kPx, kPx});
    for (size_t plane = 0; plane < 5; ++plane)
      for (size_t px = 0; px < count; ++px) {
        ASSERT_NEAR(planes[plane * count + px], rows.Convolved(plane, px), 3e-6);
        ASSERT_EQ(panels[(px / kPx * 5 + plane) * kPx + px % kPx], planes[plane * count + px]);
      }
  });
}

TEST(PanelRows, OneHalfGatesTheOther) {
  OnEveryTarget([] {
    const Rows rows{.planes = 10};
    const Values out(5 * Rows::kPanels * kPx);
    GateRow(rows.Three(), kPanelPx, 5, rows.weights.Get(), Rows::kPanels, out.Get());
    for (size_t plane = 0; plane < 5; ++plane)
      for (size_t px = 0; px < Rows::kPanels * kPx; ++px) {
        const double a = rows.Convolved(plane, px), b = rows.Convolved(plane + 5, px);
        ASSERT_NEAR(out[(px / kPx * 5 + plane) * kPx + px % kPx], GeluOf(a) * b,
                    4e-6 * (1 + std::abs(a) + std::abs(b)));
      }
  });
}

TEST(PanelRows, ProductsAndSquaresAreAdded) {
  OnEveryTarget([] {
    for (const size_t channels : {1u, 4u, 6u, 16u, 19u}) {
      const size_t count = 9 * kPx;
      const Values q(channels * count, 1), k(channels * count, 2);
      std::vector<double> products(channels * channels, 3), squares(channels, 4);
      AddProducts(q.Get(), k.Get(), static_cast<int>(channels), count, products.data());
      AddSquares(q.Get(), static_cast<int>(channels), count, squares.data());
      for (size_t i = 0; i < channels; ++i) {
        double square = 4;
        for (size_t px = 0; px < count; ++px) square += q[i * count + px] * q[i * count + px];
        ASSERT_NEAR(squares[i], square, 1e-4);
        for (size_t j = 0; j < channels; ++j) {
          double product = 3;
          for (size_t px = 0; px < count; ++px) product += q[i * count + px] * k[j * count + px];
          ASSERT_NEAR(products[i * channels + j], product, 1e-4) << channels << " " << i << " " << j;
        }
      }
    }
  });
}

TEST(PanelRows, NormalShareIsWithinItsError) {
  std::vector<float> x;
  for (int i = -800'000; i <= 800'000; ++i) x.push_back(static_cast<float>(i) * 1e-5f);
  for (const float far : {9.0f, 30.0f, 1e4f, 1e30f, 1e-30f, 0.0f})
    for (const float sign : {-1.0f, 1.0f}) x.push_back(sign * far);
  OnEveryTarget([&] {
    std::vector<float> shares(x.size());
    NormalShares(x, shares.data());
    double largest = 0, largest_gelu = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      const double value = static_cast<double>(x[i]), share = static_cast<double>(shares[i]);
      largest = std::max(largest, std::abs(share - std::erfc(-value / std::sqrt(2.0)) / 2));
      largest_gelu =
          std::max(largest_gelu, std::abs(value * share - GeluOf(value)) / std::max(1.0, std::abs(value)));
    }
    EXPECT_LE(largest, 1.1e-7);  // as panel_rows.h says; 1.02e-7 where there is no fused multiply-add
    EXPECT_LE(largest_gelu, 1.1e-7);
  });
}

}  // namespace
}  // namespace shimmer::restore
