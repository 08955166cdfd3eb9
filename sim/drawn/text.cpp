// A page of print: a headline, then columns of paragraphs in several sizes, down to the small print.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <vector>

#include "noise/lattice.h"
#include "noise/perlin_double.h"
#include "sim/drawn/scenes.h"
#include "sim/drawn/waves.h"

namespace shimmer::sim {
namespace {

constexpr const char* kHeadlines[] = {"The Road in June", "A Mile of Heat", "Heated Air", "Seeing Far",
                                      "Mirage"};

constexpr const char* kSentences[] = {
    "Over a hot road the far end of the street begins to swim.",
    "Warm air is thinner than cold air, and light bends where the two meet.",
    "Each ray takes its own way through the heat, and arrives a little off its place.",
    "A straight kerb looks like a rope that somebody shakes.",
    "The letters on a distant sign tremble, swell and melt into each other.",
    "Nothing out there moves; only the air between does.",
    "Wait a second and the same window stands half a brick further left.",
    "The longer the lens, the stronger the dance.",
    "Stars twinkle for the same reason, and so do the lamps of a far town.",
    "In the early morning the ground is cool and the view is calm.",
    "By noon the whole valley boils.",
    "Take a hundred pictures, and no two of them agree.",
    "Their mean stands still, but it is soft as wool.",
    "Now and then a patch comes through sharp by luck.",
    "A patient eye collects such moments and builds the scene from them.",
    "First hold the picture still, then find what truly moves, then make it sharp.",
    "A car that crosses the scene must not be averaged away.",
    "Heat has no edges, so its blur has none either.",
    "Small print is the first to go and the last to come back.",
    "Whoever reads this line from a mile away has good air or good mathematics.",
    "Wind carries the pattern along, as a stream carries ripples.",
    "Close the lens down, and the flicker grows.",
    "Pilots, painters and surveyors have cursed it for centuries.",
    "From the tower the plain looked like the bottom of a brook.",
};

constexpr double kLineOfCapital = 2.1;                   // distance of lines
constexpr double kSizes[] = {1.5, 1.0, 0.75, 1.0, 0.6};  // of a column's paragraphs in turn, in body sizes
constexpr double kWidestSpace = 2.2;     // in natural spaces; lines that need more stay ragged
constexpr double kLeastCapitalPx = 4.5;  // letters below that are no letters

// Sentences in an order of the variation's own, again and again.
class Writer {
 public:
  Writer(uint64_t variation) : order_(std::size(kSentences)) {
    std::iota(order_.begin(), order_.end(), 0);
    noise::HashStream stream(noise::HashPath(variation, 0, "text.order"));
    for (size_t i = order_.size() - 1; i > 0; --i) std::swap(order_[i], order_[stream.Below(i + 1)]);
  }
  std::string Paragraph(int sentences) {
    std::string text;
    for (int i = 0; i < sentences; ++i)
      text += (i ? " " : "") + std::string(kSentences[order_[next_++ % order_.size()]]);
    return text;
  }

 private:
  std::vector<size_t> order_;
  size_t next_ = 0;
};

// One line of words, spread over the whole width unless it is its paragraph's last.
void SetLine(Canvas& canvas, const std::string& line, double capital_px, const cv::Rect2d& column,
             double baseline_px, bool justify, const Rgb& ink) {
  std::vector<std::string> words;
  for (size_t begin = 0; begin < line.size();) {
    const size_t end = std::min(line.find(' ', begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  double words_px = 0;
  for (const std::string& word : words) words_px += TextWidth(word, Face::kSerif, capital_px);
  const double natural_px = TextWidth(" ", Face::kSerif, capital_px);
  const double spread_px =
      words.size() > 1 ? (column.width - words_px) / double(words.size() - 1) : natural_px;
  const double space_px = justify && spread_px < kWidestSpace * natural_px ? spread_px : natural_px;
  double x = column.x;
  for (const std::string& word : words) {
    canvas.Write(word, Face::kSerif, capital_px, {x, baseline_px}, ink);
    x += TextWidth(word, Face::kSerif, capital_px) + space_px;
  }
}

// Paragraphs from the column's top to its end, none in letters above largest_px.
void SetColumn(Canvas& canvas, Writer& writer, const cv::Rect2d& column, double body_px, double largest_px,
               size_t first_size, const Rgb& ink) {
  double y = column.y;
  for (size_t paragraph = first_size;; ++paragraph) {
    const double wish_px = body_px * kSizes[paragraph % std::size(kSizes)];
    const double capital_px = std::clamp(wish_px, kLeastCapitalPx, std::max(kLeastCapitalPx, largest_px));
    const double line_px = kLineOfCapital * capital_px;
    if (paragraph > first_size) y += 0.6 * capital_px;  // apart from the one before
    const std::vector<std::string> lines =
        WrapWords(writer.Paragraph(paragraph % 2 ? 3 : 2), Face::kSerif, capital_px, column.width);
    for (size_t i = 0; i < lines.size(); ++i) {
      if (y + capital_px > column.y + column.height) return;
      SetLine(canvas, lines[i], capital_px, column, y + capital_px, i + 1 < lines.size(), ink);
      y += line_px;
    }
  }
}

// The variation's own, or else the next that fits the page; the last one where none does.
std::string Headline(double width_px, uint64_t variation) {
  auto i = size_t(Detail(variation, "text.headline") * std::size(kHeadlines));
  while (i + 1 < std::size(kHeadlines) &&
         TextWidth(kHeadlines[i], Face::kSerifBold, kLeastCapitalPx) > width_px)
    ++i;
  return kHeadlines[i];
}

// The headline between two rules; returns where it ends.
double SetHeadline(Canvas& canvas, const cv::Rect2d& page, const std::string& text, double wish_px,
                   const Rgb& ink) {
  const double fits_px = wish_px * page.width / TextWidth(text, Face::kSerifBold, wish_px);
  const double capital_px = std::max(kLeastCapitalPx, std::min(wish_px, fits_px)),
               rule_px = std::max(1.0, 0.07 * capital_px);
  canvas.Fill({page.x, page.y, page.width, 2 * rule_px}, ink);
  const double middle = page.y + 2 * rule_px + 1.1 * capital_px;
  canvas.WriteCentred(text, Face::kSerifBold, capital_px, {page.x + page.width / 2, middle}, ink);
  const double end = middle + 1.2 * capital_px;
  canvas.Fill({page.x, end, page.width, rule_px}, ink);
  return end + rule_px;
}

}  // namespace

void DrawText(Canvas& canvas, double scale, uint64_t variation) {
  const cv::Size size = canvas.crop();
  const int shorter = std::min(size.width, size.height);
  const double body_px = std::max(
      kLeastCapitalPx, std::min(scale * std::clamp(3.5 + shorter / 110.0, 5.0, 16.0), shorter / 10.0));

  // Paper: a tint of the variation, slow light, a little unevenness.
  const Rgb paper = FromHue(Detail(variation, "text.hue"), 0.09 * Detail(variation, "text.tint"), 0.84);
  const Rgb ink = FromHue(Detail(variation, "text.ink"), 0.4, 0.13);
  noise::HashStream stream(noise::HashPath(variation, 0, "text.paper"));
  const noise::Permutation fibres = noise::ShuffledPermutation(stream);
  canvas.Paint(canvas.WholeArea(), [&](int x, int y) {
    const double along = std::clamp(0.5 * (x / double(size.width) + y / double(size.height)), 0.0, 1.0);
    const double grain = noise::PerlinDouble(fibres, 0.31 * x, 0.31 * y, 0.4) +
                         noise::PerlinDouble(fibres, 0.05 * x, 0.05 * y, 7.3);
    return paper * float(1.03 - 0.12 * along + 0.02 * grain);
  });

  const double margin_px = 0.045 * shorter;
  cv::Rect2d page(margin_px - 0.5, margin_px - 0.5, size.width - 2 * margin_px, size.height - 2 * margin_px);
  const double end =
      SetHeadline(canvas, page, Headline(page.width, variation), 2.6 * body_px + 0.02 * shorter, ink);
  page.height -= end + 1.4 * body_px - page.y;
  page.y = end + 1.4 * body_px;

  Writer writer(variation);
  const int columns = std::max(1, int(page.width / (44 * body_px)));
  const double gutter_px = 3 * body_px, width_px = (page.width - (columns - 1) * gutter_px) / columns;
  const double largest_px = width_px / std::max(10.0, 25 / std::max(1.0, scale));  // a line holds some words
  for (int i = 0; i < columns; ++i) {
    const double left = page.x + i * (width_px + gutter_px);
    if (i > 0) canvas.Fill({left - gutter_px / 2 - 0.5, page.y, 1, page.height}, Mix(paper, ink, 0.5));
    SetColumn(canvas, writer, {left, page.y, width_px, page.height}, body_px, largest_px, size_t(i), ink);
  }
}

}  // namespace shimmer::sim
