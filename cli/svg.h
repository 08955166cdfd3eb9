// Parts of a drawing in SVG, in px of its own coordinates.
#pragma once

#include <string>

namespace shimmer::cli {

std::string Px(double px);  // "12.5"

// Elements; kind is their class, anchor "start", "middle" or "end".
std::string Text(double x, double y, const std::string& anchor, const std::string& text,
                 const std::string& kind = "");
std::string Line(double x1, double y1, double x2, double y2, const std::string& kind);
std::string Rect(const std::string& kind, double x, double y, double width, double height);

}  // namespace shimmer::cli
