#include "report/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bodeflow::tools::report {
namespace {

std::string csv_title(const std::string& title) {
  std::string quoted = "\"";
  for (const char c : title) quoted += c == '"' ? "\"\"" : c == '\n' || c == '\r' ? " " : std::string(1, c);
  return quoted + "\"";
}

// A cell of so many characters is a sentence.
constexpr std::size_t kSentence = 50;

/// The style of each column: digits, words, or sentences, which want room where the page is narrow.
std::vector<const char*> styles_of(const Table& table) {
  std::vector<const char*> styles;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const bool long_one = i > 0 && std::any_of(table.rows.begin(), table.rows.end(),
                                               [i](const auto& row) { return i < row.size() && row[i].size() > kSentence; });
    styles.push_back(table.columns[i].number ? "n" : long_one ? "w s" : "w");
  }
  return styles;
}

}  // namespace

void add_table(Markup& body, const Table& table) {
  if (table.rows.empty()) return;
  body.open("div", {{"class", "scroll"}, {"tabindex", "0"}, {"role", "region"}, {"aria-label", table.caption}}).open("table");
  body.element("caption", table.caption);
  const bool headed =
      std::any_of(table.columns.begin(), table.columns.end(), [](const Column& column) { return !column.title.empty(); });
  if (headed) body.open("thead").open("tr");
  const auto styles = styles_of(table);
  for (std::size_t i = 0; headed && i < table.columns.size(); ++i)
    body.element("th", {{"scope", "col"}, {"class", styles[i]}}, table.columns[i].title);
  if (headed) body.close("tr").close("thead");
  body.open("tbody");
  for (const auto& row : table.rows) {
    body.open("tr");
    for (std::size_t i = 0; i < row.size(); ++i) {
      const char* style = i < styles.size() ? styles[i] : "w";
      if (i == 0)
        body.element("th", {{"scope", "row"}, {"class", style}}, row[i]);
      else
        body.element("td", {{"class", style}}, row[i]);
    }
    body.close("tr");
  }
  body.close("tbody").close("table").close("div").trusted("\n");
}

void add_facts(Markup& body, const Facts& facts) {
  if (facts.empty()) return;
  body.open("dl");
  for (const auto& [name, value] : facts) body.open("div").element("dt", name).element("dd", value).close("div");
  body.close("dl").trusted("\n");
}

void open_details(Markup& body, const std::string& summary) { body.open("details").element("summary", summary); }

void close_details(Markup& body) { body.close("details").trusted("\n"); }

std::string csv_text(const std::vector<CsvColumn>& columns) {
  std::string text;
  for (std::size_t i = 0; i < columns.size(); ++i) text += (i == 0 ? "" : ",") + csv_title(columns[i].title);
  text += '\n';
  for (std::size_t k = 0; !columns.empty() && k < columns[0].values.size(); ++k) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) text += ',';
      if (std::isfinite(columns[i].values[k])) text += fmt::format("{:.9g}", columns[i].values[k]);
    }
    text += '\n';
  }
  return text;
}

std::string data_address(const std::string& media_type, const std::string& text) {
  std::string address = "data:" + media_type + ";charset=utf-8,";
  for (const char c : text) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == ',' || c == '.' || c == '-';
    if (plain)
      address += c;
    else
      address += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return address;
}

}  // namespace bodeflow::tools::report
