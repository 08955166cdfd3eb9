#include "sim/app/sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "sim/app/colour_maps.h"

namespace shimmer::app {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

// A colour that nothing on a page has of itself: its inks and papers are greys.
cv::Vec3b Marker(int i) { return cv::Vec3b(uchar(255 - i), uchar(i), 90); }

cv::Mat Plain(cv::Size size, const cv::Vec3b& colour) {
  return cv::Mat(size, CV_32FC3, cv::Scalar(colour[0], colour[1], colour[2]) / 255);
}

// Box around the pixels of this colour; empty if there are none, or if other colours are in between.
cv::Rect BlockOf(const cv::Mat& page, const cv::Vec3b& colour) {
  cv::Mat same;
  cv::inRange(page, colour, colour, same);
  std::vector<cv::Point> places;
  cv::findNonZero(same, places);
  if (places.empty()) return {};
  cv::Point low = places[0], high = places[0];
  for (const cv::Point& p : places) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const cv::Rect box(low, high + cv::Point(1, 1));
  return box.area() == int(places.size()) ? box : cv::Rect();
}

bool Equal(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(Sheet, HasEveryRowInOrder) {
  std::vector<SheetRow> rows;
  for (int i = 0; i < 40; ++i)
    rows.push_back(
        {"clip " + std::to_string(i), Plain({50, 30}, Marker(i)), Plain({50, 30}, Marker(100 + i)), {}, {}});
  const cv::Mat page = DrawSheet(rows, 100);
  ASSERT_EQ(page.type(), CV_8UC3);
  int below = 0;
  for (int i = 0; i < 40; ++i) {
    const cv::Rect clean = BlockOf(page, Marker(i)), turb = BlockOf(page, Marker(100 + i));
    EXPECT_EQ(clean.size(), cv::Size(100, 60)) << i;  // twice as large fits
    EXPECT_EQ(turb.size(), cv::Size(100, 60)) << i;
    EXPECT_EQ(clean.y, turb.y);
    EXPECT_GT(turb.x, clean.br().x);
    EXPECT_GT(clean.y, below);
    below = clean.br().y;
  }
}

TEST(Sheet, GrowsByEqualSteps) {
  const SheetRow row{"clip 1", Plain({64, 64}, Marker(1)), Plain({64, 64}, Marker(2)), {}, {}};
  std::vector<SheetRow> rows;
  std::vector<cv::Size> sizes;
  for (int n = 0; n < 4; ++n) {
    sizes.push_back(DrawSheet(rows).size());
    rows.push_back(row);
  }
  for (int n = 2; n < 4; ++n) {
    EXPECT_EQ(sizes[n].width, sizes[1].width);
    EXPECT_EQ(sizes[n].height - sizes[n - 1].height, sizes[1].height - sizes[0].height);
  }
}

TEST(Sheet, FitsImagesOfAnySize) {
  struct Case {
    cv::Size image, shown;
  };
  for (const Case& c : {Case{{512, 256}, {128, 64}}, Case{{100, 300}, {43, 128}}, Case{{1, 1}, {128, 128}},
                        Case{{3, 1}, {126, 42}}, Case{{4000, 2}, {128, 1}}, Case{{100, 90}, {100, 90}},
                        Case{{128, 128}, {128, 128}}}) {
    const SheetRow rows[] = {{"", Plain(c.image, Marker(5)), Plain({20, 20}, Marker(6)), {}, {}}};
    EXPECT_EQ(BlockOf(DrawSheet(rows, 128), Marker(5)).size(), c.shown) << c.image;
  }
}

TEST(Sheet, ShowsTruthOnItsScale) {
  const SheetRow row{"clip 1", Plain({60, 60}, Marker(1)), Plain({60, 60}, Marker(2)),
                     cv::Mat(60, 60, CV_32FC2, cv::Scalar(3, 0)), cv::Mat(60, 60, CV_32FC1, cv::Scalar(2))};
  const cv::Mat page = DrawSheet({&row, 1}, 60);
  // All shifts are 3 px to the right: the scale is 3 px, and full red fills a cell.
  cv::Mat red;
  cv::inRange(page, cv::Scalar(255, 0, 0), cv::Scalar(255, 0, 0), red);
  EXPECT_GE(cv::countNonZero(red), 60 * 60);
  // All sigmas are 2: the top of the scale.
  const auto top = SigmaAsHeat(cv::Mat(1, 1, CV_32FC1, cv::Scalar(2)), 0, 2).at<cv::Vec3b>(0, 0);
  cv::Mat light;
  cv::inRange(page, top, top, light);
  EXPECT_GE(cv::countNonZero(light), 60 * 60);
}

TEST(Sheet, ShowsWhatIsAbsent) {
  const SheetRow full{"a", Plain({60, 60}, Marker(1)), Plain({60, 60}, Marker(2)),
                      cv::Mat(60, 60, CV_32FC2, cv::Scalar(1, 1)), cv::Mat(60, 60, CV_32FC1, cv::Scalar(1))};
  SheetRow bare = full;
  bare.tilt = bare.sigma = cv::Mat();
  const SheetRow nothing{"a", {}, {}, {}, {}};
  const SheetRow rows[] = {full, bare, nothing};
  EXPECT_EQ(DrawSheet(rows, 64).cols, DrawSheet({rows, 1}, 64).cols);
  EXPECT_FALSE(Equal(DrawSheet({&full, 1}, 64), DrawSheet({&bare, 1}, 64)));
  // Without any truth there is nothing of it to see: only the markers have colour.
  const cv::Mat page = DrawSheet({&bare, 1}, 64);
  for (int y = 0; y < page.rows; ++y) {
    for (int x = 0; x < page.cols; ++x) {
      const cv::Vec3b p = page.at<cv::Vec3b>(y, x);
      EXPECT_TRUE(std::abs(p[0] - p[2]) <= 20 || p == Marker(1) || p == Marker(2)) << p;
    }
  }
  EXPECT_NO_THROW(DrawSheet({&nothing, 1}, 16));
}

TEST(Sheet, ShowsGreyAsEqualChannels) {
  cv::Mat grey(20, 30, CV_32FC1), rgb(20, 30, CV_32FC3);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 30; ++x) {
      const float value = float(y * 30 + x) / 600;
      grey.at<float>(y, x) = value;
      rgb.at<cv::Vec3f>(y, x) = cv::Vec3f::all(value);
    }
  }
  const SheetRow a[] = {{"x", grey, grey, {}, {}}}, b[] = {{"x", rgb, rgb, {}, {}}};
  EXPECT_TRUE(Equal(DrawSheet(a), DrawSheet(b)));
}

TEST(Sheet, ClipsValuesAndStandsNaN) {
  const auto shown = [](float value) {
    const SheetRow rows[] = {{"", cv::Mat(8, 8, CV_32FC3, cv::Scalar(value, 0.5, 0.2)), {}, {}, {}}};
    return DrawSheet(rows, 64);
  };
  EXPECT_EQ(BlockOf(shown(kInf), {255, 128, 51}).size(), cv::Size(64, 64));
  EXPECT_EQ(BlockOf(shown(7), {255, 128, 51}).size(), cv::Size(64, 64));
  EXPECT_EQ(BlockOf(shown(kNan), {0, 128, 51}).size(), cv::Size(64, 64));
  EXPECT_EQ(BlockOf(shown(-kInf), {0, 128, 51}).size(), cv::Size(64, 64));
  const SheetRow unknown[] = {{"",
                               {},
                               {},
                               cv::Mat(4, 4, CV_32FC2, cv::Scalar::all(kNan)),
                               cv::Mat(4, 4, CV_32FC1, cv::Scalar(kInf))}};
  EXPECT_NO_THROW(DrawSheet(unknown));
}

TEST(Sheet, WrapsLabelsAndKeepsItsWidth) {
  SheetRow row{"short", Plain({64, 64}, Marker(1)), Plain({64, 64}, Marker(2)), {}, {}};
  const cv::Mat plain = DrawSheet({&row, 1});
  row.label = "other";
  EXPECT_FALSE(Equal(plain, DrawSheet({&row, 1})));
  for (const std::string& label :
       {std::string(600, 'w'), std::string(300, '/') + " a b c " + std::string(200, 'x')}) {
    row.label = label;
    const cv::Mat page = DrawSheet({&row, 1});
    EXPECT_EQ(page.cols, plain.cols);
    EXPECT_GT(page.rows, plain.rows);
    EXPECT_EQ(BlockOf(page, Marker(1)).size(), cv::Size(256, 256));  // nothing written over it
    // The right margin stays blank.
    const cv::Mat margin = page(cv::Rect(page.cols - 20, 0, 20, page.rows));
    EXPECT_EQ(cv::norm(margin, cv::Mat(margin.size(), CV_8UC3, cv::Scalar(250, 250, 248)), cv::NORM_INF), 0);
  }
}

TEST(Sheet, RefusesBadInput) {
  const cv::Mat image = Plain({8, 8}, Marker(1)), bytes(8, 8, CV_8UC3, cv::Scalar::all(0));
  const SheetRow good{"", image, image, {}, {}};
  EXPECT_THROW(DrawSheet({&good, 1}, 15), std::invalid_argument);
  for (const SheetRow& bad : {SheetRow{"", bytes, image, {}, {}}, SheetRow{"", image, bytes, {}, {}},
                              SheetRow{"", image, image, bytes, {}}, SheetRow{"", image, image, {}, bytes}})
    EXPECT_THROW(DrawSheet({&bad, 1}), std::invalid_argument);
  EXPECT_THROW(DrawClipFrame(image, bytes, ""), std::invalid_argument);
}

TEST(ClipFrame, ShowsBothAndKeepsItsSize) {
  const cv::Mat clean = Plain({300, 200}, Marker(1)), turb = Plain({300, 200}, Marker(2));
  const cv::Mat frame = DrawClipFrame(clean, turb, "frame 0");
  EXPECT_EQ(BlockOf(frame, Marker(1)).size(), cv::Size(300, 200));
  EXPECT_EQ(BlockOf(frame, Marker(2)).size(), cv::Size(300, 200));
  EXPECT_GT(BlockOf(frame, Marker(2)).x, BlockOf(frame, Marker(1)).br().x);
  for (const std::string& label : {std::string(), std::string("frame 10000"), std::string(500, 'w'),
                                   std::string("many words ") + std::string(300, ' ') + "more"})
    EXPECT_EQ(DrawClipFrame(clean, turb, label).size(), frame.size()) << label;
  EXPECT_FALSE(Equal(DrawClipFrame(clean, turb, "frame 1"), frame));
  EXPECT_LE(DrawClipFrame(Plain({4000, 100}, Marker(1)), Plain({4000, 100}, Marker(2)), "").cols, 1200);
  EXPECT_NO_THROW(DrawClipFrame(Plain({1, 1}, Marker(1)), {}, "x"));
}

}  // namespace
}  // namespace shimmer::app
