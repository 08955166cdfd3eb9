#include "cli/page.h"

#include "cli/html.h"
#include "cli/svg.h"

namespace shimmer::cli {

std::string PageStart(const std::string& title, std::string_view style) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
         "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         EscapeHtml(title) + "</title>\n<style>" + std::string(style) + "</style>\n</head>\n<body>\n";
}

std::string Section(const std::string& id, const std::string& title, const std::string& note,
                    const std::string& html) {
  return "<section id=\"" + id + "\">\n<h2>" + EscapeHtml(title) + "</h2>\n<p>" + EscapeHtml(note) +
         "</p>\n" + html + "</section>\n";
}

std::string Tile(const std::string& name, const std::string& value, bool bad) {
  return std::string("<div class=\"tile") + (bad ? " bad" : "") + "\"><b>" + EscapeHtml(value) +
         "</b><span>" + EscapeHtml(name) + "</span></div>\n";
}

std::string Chart(const std::string& key, const std::vector<std::string>& notes, const std::string& html) {
  std::string chart = "<figure class=\"chart\" data-key=\"" + EscapeHtml(key) + "\">\n<figcaption><h3>" +
                      EscapeHtml(key) + "</h3>";
  for (const std::string& note : notes)
    if (!note.empty()) chart += "<p>" + EscapeHtml(note) + "</p>";
  return chart + "</figcaption>\n" + html + "</figure>\n";
}

std::string Bar(const BarTexts& texts, const std::string& data_html, double percent) {
  return "<li " + data_html + "><span class=\"value\">" + EscapeHtml(texts.name) +
         "</span><span class=\"count\">" + EscapeHtml(texts.count) + " <small>" + EscapeHtml(texts.share) +
         "</small></span><svg class=\"row\" width=\"100%\" height=\"8\" aria-hidden=\"true\"><title>" +
         EscapeHtml(texts.title) +
         "</title><rect class=\"rail\" width=\"100%\" height=\"8\" rx=\"2\"/><rect class=\"bar\" width=\"" +
         Px(percent) + "%\" height=\"8\" rx=\"2\"/></svg></li>\n";
}

}  // namespace shimmer::cli
