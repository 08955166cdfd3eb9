// A table of the evaluation's page: numbers to the right, sorted by a click on a column's name, and in a box
// of its own to scroll where it is too wide.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "restore/app/evaluation/report_numbers.h"

namespace shimmer::restore::app {

struct Column {
  std::string key;  // data-key of its head; of a measure its name, with "_gain" where it is less the input's
  std::string label, unit;
  Better best = Better::kNeither;  // which of the compared rows is shown bold
  bool number = true;              // else text
};
Column ColumnOf(Measure measure);
Column GainColumn(Measure measure, const std::string& label);
Column TextColumn(const std::string& key, const std::string& label);
Column CountColumn(const std::string& key, const std::string& label, const std::string& unit = "");

struct Cell {
  std::string text;
  std::string small = {};  // beside it, more quietly
  Value value = {};        // what it is sorted by, of a column of numbers
  std::string link = {};   // where the text leads to: "#clip-3"
  std::string error = {};  // below it
};
Cell NumberCell(const Value& value, int decimals, Sign sign = Sign::kOfNegative);
Cell CountCell(int64_t count);
// With its margin where it is a gain: of a level, which differs by the clip, the margin tells nothing.
Cell MeanCell(const std::optional<MeanOfClips>& mean, Measure measure, Sign sign = Sign::kOfNegative);

class Table {
 public:
  // name: for those who do not see it. sorted: the key of the column by which the rows come, ascending.
  Table(std::string name, std::vector<Column> columns, std::string sorted = "");

  // A cell a column; the first is the row's name. compared: may be the best.
  void Add(std::vector<Cell> cells, bool compared = true);
  bool empty() const { return rows_.empty(); }
  std::string Html() const;

 private:
  struct Row {
    std::vector<Cell> cells;
    bool compared;
  };
  // The text of the best in each column; empty where there is nothing to choose from.
  std::vector<std::string> BestTexts() const;

  std::string name_;
  std::vector<Column> columns_;
  std::string sorted_;
  std::vector<Row> rows_;
};

}  // namespace shimmer::restore::app
