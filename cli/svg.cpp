#include "cli/svg.h"

#include <cstdio>

#include "cli/html.h"

namespace shimmer::cli {

std::string Px(double px) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", px);
  return text;
}

std::string Text(double x, double y, const std::string& anchor, const std::string& text,
                 const std::string& kind) {
  return "<text x=\"" + Px(x) + "\" y=\"" + Px(y) + "\" text-anchor=\"" + anchor + "\"" +
         (kind.empty() ? "" : " class=\"" + kind + "\"") + ">" + EscapeHtml(text) + "</text>";
}

std::string Line(double x1, double y1, double x2, double y2, const std::string& kind) {
  return "<line class=\"" + kind + "\" x1=\"" + Px(x1) + "\" y1=\"" + Px(y1) + "\" x2=\"" + Px(x2) +
         "\" y2=\"" + Px(y2) + "\"/>";
}

std::string Rect(const std::string& kind, double x, double y, double width, double height) {
  return "<rect class=\"" + kind + "\" x=\"" + Px(x) + "\" y=\"" + Px(y) + "\" width=\"" + Px(width) +
         "\" height=\"" + Px(height) + "\"/>";
}

}  // namespace shimmer::cli
