#include "restore/app/evaluation/report_table.h"

#include <cmath>
#include <utility>

#include "cli/html.h"
#include "cli/number_text.h"

namespace shimmer::restore::app {
namespace {

using cli::EscapeHtml;

bool IsNumber(const Value& value) { return value && !std::isnan(*value); }

std::string HeadHtml(const Column& column, bool sorted) {
  return std::string("<th scope=\"col\"") + (column.number ? " class=\"number\"" : "") + " data-key=\"" +
         EscapeHtml(column.key) + "\" aria-sort=\"" + (sorted ? "ascending" : "none") +
         "\"><button type=\"button\">" + EscapeHtml(column.label) +
         (column.unit.empty() ? "" : " <small>" + EscapeHtml(column.unit) + "</small>") + "</button></th>";
}

std::string CellHtml(const Cell& cell, const Column& column, bool first, bool best) {
  std::string html = first ? "<th scope=\"row\"" : "<td";
  if (column.number) html += best ? " class=\"number best\"" : " class=\"number\"";
  if (column.number && IsNumber(cell.value)) html += " data-value=\"" + Exact(*cell.value) + "\"";
  const std::string text = EscapeHtml(cell.text);
  html += ">" + (best                ? "<b>" + text + "</b>"
                 : cell.link.empty() ? text
                                     : "<a href=\"" + EscapeHtml(cell.link) + "\">" + text + "</a>");
  if (!cell.small.empty()) html += " <small>" + EscapeHtml(cell.small) + "</small>";
  if (!cell.error.empty()) html += "<div class=\"error\">" + EscapeHtml(cell.error) + "</div>";
  return html + (first ? "</th>" : "</td>");
}

}  // namespace

Column ColumnOf(Measure measure) {
  const MeasureText& text = TextOf(measure);
  return {text.name, text.label, text.unit, text.better};
}

Column GainColumn(Measure measure, const std::string& label) {
  const MeasureText& text = TextOf(measure);
  return {std::string(text.name) + "_gain", label, text.unit, text.better};
}

Column TextColumn(const std::string& key, const std::string& label) {
  return {.key = key, .label = label, .unit = "", .number = false};
}

Column CountColumn(const std::string& key, const std::string& label, const std::string& unit) {
  return {.key = key, .label = label, .unit = unit};
}

Cell NumberCell(const Value& value, int decimals, Sign sign) {
  return {.text = Shown(value, decimals, sign), .value = value};
}

Cell CountCell(int64_t count) { return {.text = cli::Grouped(count), .value = static_cast<double>(count)}; }

Cell MeanCell(const std::optional<MeanOfClips>& mean, Measure measure, Sign sign) {
  Cell cell = NumberCell(MeanAlone(mean), TextOf(measure).decimals, sign);
  if (sign == Sign::kAlways) cell.small = MarginText(mean, TextOf(measure).decimals);
  return cell;
}

Table::Table(std::string name, std::vector<Column> columns, std::string sorted)
    : name_(std::move(name)), columns_(std::move(columns)), sorted_(std::move(sorted)) {}

void Table::Add(std::vector<Cell> cells, bool compared) {
  cells.resize(columns_.size());
  rows_.push_back({std::move(cells), compared});
}

std::vector<std::string> Table::BestTexts() const {
  std::vector<std::string> texts(columns_.size());
  for (size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].best == Better::kNeither) continue;
    const Cell* best = nullptr;
    int numbers = 0;
    for (const Row& row : rows_) {
      const Cell& cell = row.cells[i];
      if (!row.compared || !IsNumber(cell.value)) continue;
      ++numbers;
      if (!best ||
          (columns_[i].best == Better::kMore ? *cell.value > *best->value : *cell.value < *best->value))
        best = &cell;
    }
    if (numbers > 1) texts[i] = best->text;
  }
  return texts;
}

std::string Table::Html() const {
  std::string html = "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"" + EscapeHtml(name_) +
                     "\">\n<table>\n<thead><tr>";
  for (const Column& column : columns_) html += HeadHtml(column, column.key == sorted_);
  html += "</tr></thead>\n<tbody>\n";
  const std::vector<std::string> best = BestTexts();
  for (const Row& row : rows_) {
    html += "<tr>";
    for (size_t i = 0; i < columns_.size(); ++i)
      html += CellHtml(row.cells[i], columns_[i], i == 0,
                       row.compared && !best[i].empty() && row.cells[i].text == best[i]);
    html += "</tr>\n";
  }
  return html + "</tbody>\n</table>\n</div>\n";
}

}  // namespace shimmer::restore::app
