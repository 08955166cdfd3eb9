// Plain text in aligned columns: the first to the left, the others to the right.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace shimmer::bench {

class Table {
 public:
  explicit Table(std::vector<std::string> head) : rows_{std::move(head)} {}
  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }  // as many cells as the head
  void Print() const;                                                          // to stdout

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::string Number(double value, int decimals);
std::string Significant(double value, int digits);  // "0.00213", "1.2e-07"
std::string SizeText(cv::Size size);                // "1920x1080"

}  // namespace shimmer::bench
