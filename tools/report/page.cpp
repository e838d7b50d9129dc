#include "report/page.hpp"

#include <fmt/format.h>

#include "report/page_style.hpp"

namespace bodeflow::tools::report {

std::string Page::unique(const std::string& name, std::set<std::string>& taken) {
  const std::string word = slug(name);
  std::string free = word;
  for (int i = 2; !taken.insert(free).second; ++i) free = fmt::format("{}-{}", word, i);
  return free;
}

void Page::open_section(const std::string& title, const std::string& kind) {
  const std::string anchor = unique(title, anchors_);
  contents_.push_back({anchor, title});
  body_.open("section", {{"id", anchor}}).open("h2").text(title);
  if (!kind.empty()) body_.text(" ").element("span", {{"class", "kind"}}, kind);
  body_.close("h2").trusted("\n");
}

void Page::close_section() { body_.close("section").trusted("\n"); }

/// The sentence after a figure's title.
void Page::add_caption(const std::string& caption) {
  if (!caption.empty()) body_.text(". " + caption + (caption.back() == '.' ? "" : "."));
}

std::string Page::keep_plot(const std::string& name, const Picture& picture) {
  plots_.push_back({unique(name, files_) + ".svg", standalone_svg(picture)});
  return plots_.back().file;
}

void Page::figure(const Picture& wide, const Picture& narrow, const std::string& name, const std::string& caption) {
  const std::string file = keep_plot(name, wide);
  body_.open("figure").open("div", {{"class", "wide"}}).add(inline_svg(wide)).close("div");
  body_.open("div", {{"class", "narrow"}}).add(inline_svg(narrow)).close("div");
  body_.open("figcaption").element("b", wide.title);
  add_caption(caption);
  body_.close("figcaption").close("figure").trusted("\n");
}

void Page::figure(const Chart& chart, const std::string& caption) {
  figure(draw_chart(chart, kWide), draw_chart(chart, kNarrow), chart.name, caption);
}

void Page::drawing(const Picture& wide, const Picture& narrow, const std::string& name, const std::string& caption) {
  keep_plot(name, wide);
  body_.open("figure");
  for (const auto& [style, picture] : {std::pair{"wide", &wide}, {"narrow", &narrow}})
    body_
        .open("div", {{"class", std::string("scroll natural ") + style},
                      {"tabindex", "0"},
                      {"role", "region"},
                      {"aria-label", picture->title}})
        .add(inline_svg(*picture))
        .close("div");
  body_.open("figcaption").element("b", wide.title);
  add_caption(caption);
  body_.close("figcaption").close("figure").trusted("\n");
}

void Page::grid(const std::vector<Chart>& charts, const std::string& caption) {
  if (charts.empty()) return;
  if (charts.size() == 1) return figure(charts[0], caption);
  body_.open("div", {{"class", "grid"}});
  for (const auto& chart : charts) {
    const Picture picture = draw_chart(chart, kSmall);
    keep_plot(chart.name, picture);
    body_.open("figure")
        .add(inline_svg(picture))
        .open("figcaption")
        .element("b", chart.title)
        .close("figcaption")
        .close("figure");
  }
  body_.close("div");
  if (!caption.empty()) body_.element("p", {{"class", "caption"}}, caption);
  body_.trusted("\n");
}

void Page::csv(const std::string& name, const std::vector<CsvColumn>& columns) {
  if (columns.empty() || columns[0].values.size() * columns.size() > csv_room_ / 8) {
    if (!columns.empty())
      paragraph(fmt::format("All {} lines stand in result.json: too many for this page.", columns[0].values.size()));
    return;
  }
  const std::string address = data_address("text/csv", csv_text(columns));
  if (address.size() > csv_room_) {
    paragraph(fmt::format("All {} lines stand in result.json: too many for this page.", columns[0].values.size()));
    return;
  }
  csv_room_ -= address.size();
  const std::string file = slug(name) + ".csv";
  body_.open("p").element("a", {{"href", address}, {"download", file}, {"class", "csv"}},
                          fmt::format("{} ({} lines)", file, columns[0].values.size()));
  body_.close("p").trusted("\n");
}

std::string Page::html(const std::string& title, const Markup& header) const {
  Markup page;
  page.trusted("<!DOCTYPE html>\n").open("html", {{"lang", "en"}}).open("head").single("meta", {{"charset", "utf-8"}});
  // Nothing is loaded and nothing runs, whatever the names in the files are
  page.single("meta",
              {{"http-equiv", "Content-Security-Policy"},
               {"content", "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'"}});
  page.single("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  page.single("meta", {{"name", "color-scheme"}, {"content", "light dark"}})
      .single("meta", {{"name", "generator"}, {"content", "bodeflow"}});
  page.element("title", title).open("style").trusted(page_style()).close("style").close("head").trusted("\n").open("body");
  page.open("div", {{"class", "layout"}}).open("nav", {{"aria-label", "Contents"}}).open("ol");
  for (const auto& entry : contents_)
    page.open("li").element("a", {{"href", "#" + entry.anchor}}, shortened(entry.title, 40)).close("li");
  page.close("ol").close("nav").open("main").add(header).add(body_).close("main").close("div");
  return page.close("body").close("html").trusted("\n").str();
}

}  // namespace bodeflow::tools::report
