#include "report/table.hpp"

#include <cmath>

#include "catch.hpp"

using namespace bodeflow::tools::report;

TEST_CASE("report table: captions, headings and cells are escaped, and rows have heads") {
  Markup body;
  add_table(body, {"<c>", {{"a", false}, {"b"}}, {{"<x>", "1"}}});
  CHECK(body.str().find("<caption>&lt;c&gt;</caption>") != std::string::npos);
  CHECK(body.str().find("<th scope=\"row\" class=\"w\">&lt;x&gt;</th><td class=\"n\">1</td>") != std::string::npos);
}

TEST_CASE("report table: a column of sentences gets room, one of words does not") {
  Markup body;
  add_table(body, {"c",
                   {{"a", false}, {"b", false}, {"c", false}},
                   {{"x", "word", "improves the fit no more than chance does: p = 0.18, needed below 0.001"}}});
  CHECK(body.str().find("<td class=\"w\">word</td><td class=\"w s\">improves") != std::string::npos);
}

TEST_CASE("report table: without rows there is no table") {
  Markup body;
  add_table(body, {"c", {{"a"}}, {}});
  CHECK(body.empty());
}

TEST_CASE("report table: CSV quotes its titles and leaves out what is not finite") {
  CHECK(csv_text({{"f [Hz]", {1.0, 2.5}}, {"say \"x\"\n", {std::nan(""), 0.1}}}) ==
        "\"f [Hz]\",\"say \"\"x\"\" \"\n1,\n2.5,0.1\n");
}

TEST_CASE("report table: a text as an address holds no character that could leave it") {
  CHECK(data_address("text/csv", "a\"<b>\n1,2") == "data:text/csv;charset=utf-8,a%22%3Cb%3E%0A1,2");
}
