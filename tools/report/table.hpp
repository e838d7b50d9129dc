#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/markup.hpp"

namespace bodeflow::tools::report {

struct Column {
  std::string title;
  bool number = true;  ///< right-aligned, digits of one width
};

struct Table {
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;
};

/// The table in a frame that scrolls by itself where the page is narrow; nothing for a table without rows.
void add_table(Markup& body, const Table& table);

/// Names with their values, two columns.
using Facts = std::vector<std::pair<std::string, std::string>>;
void add_facts(Markup& body, const Facts& facts);

/// A heading that opens and closes what follows, up to `close_details`.
void open_details(Markup& body, const std::string& summary);
void close_details(Markup& body);

/// Columns of equal length as CSV.
struct CsvColumn {
  std::string title;
  std::vector<double> values;
};
std::string csv_text(const std::vector<CsvColumn>& columns);

/// A text as the address of a file that is part of the page.
std::string data_address(const std::string& media_type, const std::string& text);

}  // namespace bodeflow::tools::report
