#include "tests/restore/restormer_twin.h"

#include <algorithm>
#include <cmath>

#include "restore/model_card.h"

namespace shimmer::restore {
namespace {

struct Planes {
  int channels, height, width;
  std::vector<double> values = std::vector<double>(static_cast<size_t>(channels) *
                                                   static_cast<size_t>(height) * static_cast<size_t>(width));

  double& At(int c, int y, int x) {
    return values[(static_cast<size_t>(c) * static_cast<size_t>(height) + static_cast<size_t>(y)) *
                      static_cast<size_t>(width) +
                  static_cast<size_t>(x)];
  }
  double At(int c, int y, int x) const { return const_cast<Planes*>(this)->At(c, y, x); }
};

// Each output takes the inputs of its group; zeros outside.
Planes Convolved(const Planes& in, const Tensor& weights, int groups = 1) {
  const int outputs = static_cast<int>(weights.shape[0]), inputs = static_cast<int>(weights.shape[1]);
  const int size = static_cast<int>(weights.shape[2]), reach = size / 2;
  Planes out{outputs, in.height, in.width};
  const float* weight = weights.values.data();
  for (int o = 0; o < outputs; ++o)
    for (int i = 0; i < inputs; ++i)
      for (int j = -reach; j <= reach; ++j)
        for (int k = -reach; k <= reach; ++k, ++weight)
          for (int y = std::max(0, -j); y < std::min(in.height, in.height - j); ++y)
            for (int x = std::max(0, -k); x < std::min(in.width, in.width - k); ++x)
              out.At(o, y, x) +=
                  static_cast<double>(*weight) * in.At(o / (outputs / groups) * inputs + i, y + j, x + k);
  return out;
}

Planes Unshuffled(const Planes& in, int u) {
  Planes out{in.channels * u * u, in.height / u, in.width / u};
  for (int c = 0; c < in.channels; ++c)
    for (int y = 0; y < in.height; ++y)
      for (int x = 0; x < in.width; ++x) out.At(u * u * c + y % u * u + x % u, y / u, x / u) = in.At(c, y, x);
  return out;
}

Planes Shuffled(const Planes& in, int u) {
  Planes out{in.channels / (u * u), in.height * u, in.width * u};
  for (int c = 0; c < out.channels; ++c)
    for (int y = 0; y < out.height; ++y)
      for (int x = 0; x < out.width; ++x)
        out.At(c, y, x) = in.At(u * u * c + y % u * u + x % u, y / u, x / u);
  return out;
}

Planes Sum(Planes a, const Planes& b) {
  for (size_t i = 0; i < a.values.size(); ++i) a.values[i] += b.values[i];
  return a;
}

Planes Together(Planes a, const Planes& b) {
  a.channels += b.channels;
  a.values.insert(a.values.end(), b.values.begin(), b.values.end());
  return a;
}

class Twin {
 public:
  explicit Twin(const SafeTensors& file) : file_(file), shape_(ReadModelCard(file).shape) {}

  Planes Run(const Planes& image) const {
    Planes x = Convolved(Unshuffled(image, shape_.unshuffle), Of("embed.weight"));
    x = RunLevel(0, std::move(x));
    x = RunBlocks("refinement", shape_.refinement, shape_.heads[0], std::move(x));
    return Sum(image, Shuffled(Convolved(x, Of("output.weight")), shape_.unshuffle));
  }

  int SizeMultiple() const { return shape_.SizeMultiple(); }

 private:
  const Tensor& Of(const std::string& name) const { return file_.tensors.at(name); }

  Planes RunLevel(int level, Planes x) const {
    const std::string l = "." + std::to_string(level);
    const int blocks = shape_.blocks[static_cast<size_t>(level)],
              heads = shape_.heads[static_cast<size_t>(level)];
    x = RunBlocks("encoder" + l, blocks, heads, std::move(x));
    if (level + 1 == shape_.Levels()) return x;
    Planes below = RunLevel(level + 1, Unshuffled(Convolved(x, Of("down" + l + ".weight")), 2));
    Planes both = Together(Shuffled(Convolved(below, Of("up" + l + ".weight")), 2), x);
    if (level > 0) both = Convolved(both, Of("reduce" + l + ".weight"));
    return RunBlocks("decoder" + l, blocks, heads, std::move(both));
  }

  Planes RunBlocks(const std::string& stage, int blocks, int heads, Planes x) const {
    for (int block = 0; block < blocks; ++block) {
      const std::string name = stage + "." + std::to_string(block) + ".";
      x = Sum(x, Attention(name + "attention.", heads, Normalised(x, name + "norm1")));
      x = Sum(x, FeedForward(name + "feed_forward.", Normalised(x, name + "norm2")));
    }
    return x;
  }

  Planes Normalised(const Planes& x, const std::string& name) const {
    Planes out = x;
    for (int y = 0; y < x.height; ++y)
      for (int px = 0; px < x.width; ++px) {
        double mean = 0, variance = 0;
        for (int c = 0; c < x.channels; ++c) mean += x.At(c, y, px) / x.channels;
        for (int c = 0; c < x.channels; ++c) variance += std::pow(x.At(c, y, px) - mean, 2) / x.channels;
        for (int c = 0; c < x.channels; ++c) {
          const double weight = Of(name + ".weight").values[static_cast<size_t>(c)],
                       sd = std::sqrt(variance + 1e-5);
          out.At(c, y, px) = shape_.norm_with_bias
                                 ? (x.At(c, y, px) - mean) / sd * weight +
                                       static_cast<double>(Of(name + ".bias").values[static_cast<size_t>(c)])
                                 : x.At(c, y, px) / sd * weight;
        }
      }
    return out;
  }

  Planes Attention(const std::string& name, int heads, const Planes& x) const {
    const Planes qkv =
        Convolved(Convolved(x, Of(name + "qkv.weight")), Of(name + "depthwise.weight"), 3 * x.channels);
    const int head = x.channels / heads;
    const auto product = [&](int a, int b) {
      double sum = 0;
      for (int y = 0; y < x.height; ++y)
        for (int px = 0; px < x.width; ++px) sum += qkv.At(a, y, px) * qkv.At(b, y, px);
      return sum;
    };
    const auto norm = [&](int a) { return std::max(1e-12, std::sqrt(product(a, a))); };
    Planes mixed{x.channels, x.height, x.width};
    for (int i = 0; i < x.channels; ++i) {
      const int first = i / head * head;
      std::vector<double> share;
      double sum = 0;
      for (int j = first; j < first + head; ++j) {
        const int k = x.channels + j;
        share.push_back(
            std::exp(product(i, k) / (norm(i) * norm(k)) *
                     static_cast<double>(Of(name + "temperature").values[static_cast<size_t>(i / head)])));
        sum += share.back();
      }
      for (int j = 0; j < head; ++j)
        for (int y = 0; y < x.height; ++y)
          for (int px = 0; px < x.width; ++px)
            mixed.At(i, y, px) +=
                share[static_cast<size_t>(j)] / sum * qkv.At(2 * x.channels + first + j, y, px);
    }
    return Convolved(mixed, Of(name + "project.weight"));
  }

  Planes FeedForward(const std::string& name, const Planes& x) const {
    const Tensor& weights = Of(name + "depthwise.weight");
    const Planes both =
        Convolved(Convolved(x, Of(name + "project_in.weight")), weights, static_cast<int>(weights.shape[0]));
    Planes gated{both.channels / 2, x.height, x.width};
    for (size_t i = 0; i < gated.values.size(); ++i) {
      const double a = both.values[i];
      gated.values[i] = a * std::erfc(-a / std::sqrt(2.0)) / 2 * both.values[gated.values.size() + i];
    }
    return Convolved(gated, Of(name + "project_out.weight"));
  }

  const SafeTensors& file_;
  RestormerShape shape_;
};

int Reflected(int at, int size) {
  if (size == 1) return 0;
  const int period = 2 * (size - 1);
  return at % period < size ? at % period : period - at % period;
}

}  // namespace

cv::Mat RestormerTwin(const SafeTensors& file, const cv::Mat& image) {
  const Twin twin(file);
  const auto rounded = [&](int px) {
    return (px + twin.SizeMultiple() - 1) / twin.SizeMultiple() * twin.SizeMultiple();
  };
  Planes planes{3, rounded(image.rows), rounded(image.cols)};
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < planes.height; ++y)
      for (int x = 0; x < planes.width; ++x)
        planes.At(c, y, x) = image.at<cv::Vec3f>(Reflected(y, image.rows), Reflected(x, image.cols))[c];
  planes = twin.Run(planes);
  cv::Mat out(image.size(), CV_64FC3);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      for (int c = 0; c < 3; ++c) out.at<cv::Vec3d>(y, x)[c] = planes.At(c, y, x);
  return out;
}

}  // namespace shimmer::restore
