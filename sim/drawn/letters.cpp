#include "sim/drawn/letters.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace shimmer::sim {
namespace {

constexpr int kFine = 8;              // fine pixels per pixel and axis
constexpr double kCapitalUnits = 21;  // height of a capital in the fonts' own units

struct Pen {
  int font;
  double font_scale;
  int thickness;  // fine px
};

Pen PenOf(Face face, double capital_px) {
  // All but the plain face draw stems as pairs of strokes, 2 or 3 units apart, which the pen must bridge.
  struct Style {
    int font;
    double stroke_of_capital, least_px;
  };
  constexpr Style kStyles[] = {{cv::FONT_HERSHEY_SIMPLEX, 0.115, 0.9},
                               {cv::FONT_HERSHEY_DUPLEX, 0.08, 0.6},
                               {cv::FONT_HERSHEY_COMPLEX, 0.055, 0.4},
                               {cv::FONT_HERSHEY_TRIPLEX, 0.065, 0.4}};  // in the order of Face
  const Style& style = kStyles[size_t(face)];
  const double stroke_px = std::max(style.stroke_of_capital * capital_px, style.least_px);
  return {style.font, capital_px * kFine / kCapitalUnits, std::max(1, int(std::lround(stroke_px * kFine)))};
}

}  // namespace

double TextWidth(const std::string& text, Face face, double capital_px) {
  const Pen pen = PenOf(face, capital_px);
  // Without the pen's thickness, so that the widths of a line's parts add up to the line's.
  return (cv::getTextSize(text, pen.font, pen.font_scale, 1, nullptr).width - 1) / double(kFine);
}

std::vector<std::string> WrapWords(const std::string& text, Face face, double capital_px, double width_px) {
  const auto fits = [&](const std::string& line) { return TextWidth(line, face, capital_px) <= width_px; };
  std::vector<std::string> lines;
  for (size_t end = 0;;) {
    const size_t begin = text.find_first_not_of(' ', end), spaces = begin - end;
    if (begin == std::string::npos) return lines;
    end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (!lines.empty() && fits(lines.back() + std::string(spaces, ' ') + word)) {
      lines.back() += std::string(spaces, ' ') + word;
      continue;
    }
    lines.push_back(word);
    while (!fits(lines.back()) && lines.back().size() > 1) {
      size_t kept = lines.back().size() - 1;
      while (kept > 1 && !fits(lines.back().substr(0, kept))) --kept;
      const std::string rest = lines.back().substr(kept);
      lines.back().resize(kept);
      lines.push_back(rest);
    }
  }
}

Lettering DrawLetters(const std::string& text, Face face, double capital_px, cv::Point2d origin) {
  const Pen pen = PenOf(face, capital_px);
  const cv::Point whole(cvFloor(origin.x), cvFloor(origin.y));
  // Room around the baseline for ascenders, descenders and glyphs that lean out of their box.
  const int above = cvCeil(1.5 * capital_px) + 2, below = cvCeil(0.7 * capital_px) + 2, beside = above;
  const cv::Size size(cvCeil(TextWidth(text, face, capital_px)) + 2 * beside, above + below);

  cv::Mat_<uint8_t> fine = cv::Mat_<uint8_t>::zeros(size * kFine);
  const cv::Point2d start = origin - cv::Point2d(whole) + cv::Point2d(beside + 0.5, above + 0.5);
  cv::putText(fine, text, {cvRound(start.x * kFine), cvRound(start.y * kFine)}, pen.font, pen.font_scale, 255,
              pen.thickness, cv::LINE_AA);

  Lettering letters{cv::Mat_<float>(size), whole - cv::Point(beside, above)};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      int sum = 0;
      for (int i = 0; i < kFine; ++i) {
        const uint8_t* row = fine[y * kFine + i] + x * kFine;
        for (int j = 0; j < kFine; ++j) sum += row[j];
      }
      letters.coverage(y, x) = float(sum) / (255 * kFine * kFine);
    }
  }
  return letters;
}

}  // namespace shimmer::sim
