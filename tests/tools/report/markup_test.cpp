#include "report/markup.hpp"

#include "catch.hpp"

using namespace bodeflow::tools::report;

TEST_CASE("report text: what means something in HTML and SVG becomes an entity") {
  CHECK(escaped("a<b>&\"'") == "a&lt;b&gt;&amp;&quot;&#39;");
  CHECK(escaped("µ ≤ 5 °") == "µ ≤ 5 °");
}

TEST_CASE("report text: control characters, broken UTF-8 and marks that turn the writing become replacement characters") {
  const std::string mark = "\xEF\xBF\xBD";
  CHECK(escaped(std::string("a\0b", 3)) == "a" + mark + "b");
  CHECK(escaped("a\x1b[31m") == "a" + mark + "[31m");
  CHECK(escaped("\xff\xfe") == mark + mark);
  CHECK(escaped("\xc0\xaf") == mark + mark);             // too long a form of '/'
  CHECK(escaped("\xed\xa0\x80") == mark + mark + mark);  // half of a surrogate pair
  CHECK(escaped("\xe2\x82") == mark + mark);             // cut off
  CHECK(escaped("x\xe2\x80\xaey") == "x" + mark + "y");  // right-to-left override
  CHECK(escaped("a\tb\nc") == "a\tb\nc");
}

TEST_CASE("report text: a name becomes a file name that stays in its folder") {
  CHECK(slug("fine.response") == "fine.response");
  CHECK(slug("../../etc/passwd") == "etc-passwd");
  CHECK(slug("..") == "unnamed");
  CHECK(slug("") == "unnamed");
  CHECK(slug("a b/<c>") == "a-b-c-");
  CHECK(slug(std::string(500, 'x')).size() == 80);
}

TEST_CASE("report text: a long text is cut at a character, not at a byte") {
  CHECK(shortened("abc", 3) == "abc");
  CHECK(shortened("abcd", 3) == "ab…");
  CHECK(shortened("µµµµ", 3) == "µµ…");
  CHECK(length_of("µ°a") == 3);
}

TEST_CASE("report markup: attributes and texts are escaped, coordinates are always finite") {
  Markup markup;
  markup.element("text", {{"x", 1.25}, {"y", std::nan("")}, {"class", "\"><script>"}}, "<b>");
  CHECK(markup.str() == "<text x=\"1.3\" y=\"0\" class=\"&quot;&gt;&lt;script&gt;\">&lt;b&gt;</text>");
}
