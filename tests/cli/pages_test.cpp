// Ticks of axes, and how texts are written into pages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cli/html.h"
#include "cli/page.h"
#include "cli/ticks.h"

namespace shimmer::cli {
namespace {

using Numbers = std::vector<double>;

TEST(AxisTicks, AreRoundAndWithin) {
  EXPECT_EQ(Ticks(0, 10, 5, AxisKind::kLinear), (Numbers{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(Ticks(0, 3, 5, AxisKind::kWhole), (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(Ticks(5.5, 8.5, 6, AxisKind::kWhole), (Numbers{6, 7, 8}));
  EXPECT_THAT(Ticks(0.4, 12, 6, AxisKind::kLogarithmic),
              testing::Pointwise(testing::DoubleEq(), Numbers{0.5, 1, 2, 5, 10}));
  EXPECT_THAT(Ticks(0.001, 1000, 6, AxisKind::kLogarithmic), testing::SizeIs(testing::Le(6u)));
  EXPECT_GE(Ticks(3, 4.9, 6, AxisKind::kLogarithmic).size(), 3u);  // none of 1, 2, 5: linear ones
  std::mt19937 generator(2);
  for (int round = 0; round < 1000; ++round) {
    const double low = std::pow(10, std::uniform_real_distribution<>(-6, 6)(generator));
    const double high = low * (1.1 + 100 * std::uniform_real_distribution<>(0, 1)(generator));
    for (const AxisKind kind : {AxisKind::kLinear, AxisKind::kLogarithmic}) {
      const Numbers ticks = Ticks(low, high, 6, kind);
      EXPECT_TRUE(std::ranges::is_sorted(ticks));
      EXPECT_GE(ticks.size(), 2u) << low << " " << high;
      EXPECT_LE(ticks.size(), 7u) << low << " " << high;
      EXPECT_GE(ticks.front(), low * (1 - 1e-12));
      EXPECT_LE(ticks.back(), high * (1 + 1e-12));
    }
  }
}

TEST(HtmlTexts, HoldNoMarkupAndNothingButText) {
  EXPECT_EQ(EscapeHtml("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&#39;");
  EXPECT_EQ(EscapeHtml("tab\tline\n"), "tab\tline\n");
  const std::string good = "gr\xC3\xBC\xC3\x9F \xE2\x82\xAC \xF0\x9F\x8C\x8A \xF4\x8F\xBF\xBF";
  EXPECT_EQ(EscapeHtml(good), good);
  const std::string no = "\xEF\xBF\xBD";
  EXPECT_EQ(EscapeHtml(std::string("a\0b\x1B\x7F", 5)), "a" + no + "b" + no + no);
  EXPECT_EQ(EscapeHtml("\xFFx"), no + "x");
  EXPECT_EQ(EscapeHtml("\xC3"), no);                             // cut off
  EXPECT_EQ(EscapeHtml("\xC3<"), no + "&lt;");                   // and what follows is not swallowed
  EXPECT_EQ(EscapeHtml("\xC0\xBC"), no + no);                    // "<" in too long a form
  EXPECT_EQ(EscapeHtml("\xED\xA0\x80"), no + no + no);           // half a surrogate pair
  EXPECT_EQ(EscapeHtml("\xF4\x90\x80\x80"), no + no + no + no);  // beyond Unicode
  EXPECT_EQ(EscapeHtml("\xC2\x85"), no + no);                    // a C1 control
}

TEST(HtmlTexts, Base64OfRfc4648) {
  const auto of = [](const std::string& text) {
    return Base64({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(of("\xFB\xFF"), "+/8=");
}

TEST(PageParts, EscapeAllButWhatIsHtml) {
  const std::string text = "<b>&", escaped = "&lt;b&gt;&amp;", html = "<i>html</i>";
  EXPECT_EQ(Tile(text, text, true),
            "<div class=\"tile bad\"><b>" + escaped + "</b><span>" + escaped + "</span></div>\n");
  EXPECT_EQ(Section("id", text, text, html), "<section id=\"id\">\n<h2>" + escaped + "</h2>\n<p>" + escaped +
                                                 "</p>\n" + html + "</section>\n");
  EXPECT_EQ(Chart(text, {"", text}, html), "<figure class=\"chart\" data-key=\"" + escaped +
                                               "\">\n<figcaption><h3>" + escaped + "</h3><p>" + escaped +
                                               "</p></figcaption>\n" + html + "</figure>\n");
  const std::string bar = Bar({text, "1", "2", text}, "data-a=\"1\"", 50), start = PageStart(text, "p {}");
  EXPECT_THAT(bar, testing::StartsWith("<li data-a=\"1\"><span class=\"value\">" + escaped + "<"));
  EXPECT_THAT(bar, testing::HasSubstr("width=\"50.0%\""));
  EXPECT_THAT(start, testing::HasSubstr("<title>" + escaped + "</title>\n<style>p {}</style>"));
  EXPECT_THAT(start, testing::EndsWith("<body>\n"));
}

}  // namespace
}  // namespace shimmer::cli
