#pragma once

#include <set>
#include <string>
#include <vector>

#include "report/chart.hpp"
#include "report/table.hpp"

namespace bodeflow::tools::report {

/// A drawing for DIR/plots.
struct Plot {
  std::string file;  ///< "name.svg"
  std::string text;
};

/// The report as it grows: sections with texts, tables and figures, and the figures as files.
class Page {
 public:
  Markup& body() { return body_; }

  /// A section with a heading that the table of contents names; `kind` stands beside the heading.
  void open_section(const std::string& title, const std::string& kind = "");
  void close_section();
  void heading(const std::string& title) { body_.element("h3", title); }
  void paragraph(const std::string& text) { body_.element("p", text); }
  /// A remark that matters: what was left out, what to do.
  void note(const std::string& text) { body_.element("p", {{"class", "note"}}, text); }

  /// A chart in both widths, with its caption.
  void figure(const Chart& chart, const std::string& caption = "");
  /// A drawing that keeps its size, and scrolls by itself where the page is narrower.
  void drawing(const Picture& wide, const Picture& narrow, const std::string& name, const std::string& caption);
  /// A drawing that has two widths.
  void figure(const Picture& wide, const Picture& narrow, const std::string& name, const std::string& caption);
  /// Small charts side by side; one alone takes the whole width.
  void grid(const std::vector<Chart>& charts, const std::string& caption = "");

  /// A link to the columns as CSV, part of the page while there is room for it.
  void csv(const std::string& name, const std::vector<CsvColumn>& columns);

  const std::vector<Plot>& plots() const { return plots_; }

  /// The whole file.
  std::string html(const std::string& title, const Markup& header) const;

 private:
  void add_caption(const std::string& caption);
  std::string keep_plot(const std::string& name, const Picture& picture);
  std::string unique(const std::string& name, std::set<std::string>& taken);

  struct Entry {
    std::string anchor, title;
  };

  Markup body_;
  std::vector<Entry> contents_;
  std::vector<Plot> plots_;
  std::set<std::string> anchors_, files_;
  std::size_t csv_room_ = 1U << 20U;  ///< bytes: the page stays below a few MB
};

}  // namespace bodeflow::tools::report
