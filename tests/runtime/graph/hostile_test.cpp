#include <fmt/format.h>

#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

const std::string kHead = "bodeflow: 1\nblocks: {}\ntitle: ";

std::string repeat(const std::string& text, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

}  // namespace

TEST_CASE("graph: deep nesting is refused before it can exhaust the stack") {
  CHECK(problems(kHead + repeat("[", 300) + repeat("]", 300)) == "g.yaml:3:71: lists and maps are nested deeper than 64 levels");
  CHECK(problems(kHead + repeat("[", 100'000)).find("lists and maps are nested deeper than 64 levels") != std::string::npos);
  CHECK(problems(kHead + repeat("{a: ", 100'000)) == "g.yaml:3:260: lists and maps are nested deeper than 64 levels");
  CHECK(problems(kHead + "\n" + repeat("- ", 100'000)) == "g.yaml:4:127: lists and maps are nested deeper than 64 levels");
  CHECK(problems(kHead + repeat("[", 63) + repeat("]", 63)) == "g.yaml:3:8: title: found a list, allowed: a text");
}

TEST_CASE("graph: aliases that multiply are refused before they fill the memory") {
  std::string text = "bodeflow: 1\nblocks: {}\na0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 10; ++i) text += fmt::format("a{}: &a{} [{}*a{}]\n", i, i, repeat(fmt::format("*a{}, ", i - 1), 9), i - 1);
  CHECK(problems(text) == "g.yaml:7:40: the file has more than 100000 values, aliases expanded");
}

TEST_CASE("graph: variables that multiply are refused before they fill the memory") {
  std::string lists = "bodeflow: 1\nblocks: {}\nvariables:\n  v0: [x, x, x, x, x, x, x, x, x, x]\n";
  std::string texts = "bodeflow: 1\nblocks: {}\nvariables:\n  v0: xxxxxxxxxx\n";
  for (int i = 1; i < 10; ++i) {
    const std::string use = fmt::format("${{v{}}}", i - 1);
    lists += fmt::format("  v{}: [{}'{}']\n", i, repeat("'" + use + "', ", 9), use);
    texts += fmt::format("  v{}: {}\n", i, repeat(use, 10));
  }
  CHECK(problems(lists) == "g.yaml:8:71: the graph with its variables put in has more than 100000 values or 4194304 bytes");
  CHECK(problems(texts) == "g.yaml:10:7: the graph with its variables put in has more than 100000 values or 4194304 bytes");
}

TEST_CASE("graph: a long chain of variables is refused before it can exhaust the stack") {
  std::string text = "bodeflow: 1\nblocks: {}\nvariables:\n";
  for (int i = 0; i < 10'000; ++i) text += fmt::format("  v{}: ${{v{}}}\n", i, i + 1);
  CHECK(problems(text).find("g.yaml:67:8: variables refer to each other over more than 64 levels") == 0);
}

TEST_CASE("graph: bytes that are no text are refused with their place") {
  CHECK(problems(kHead + "a\xFFz") == "g.yaml:3:9: byte 0xFF is not UTF-8: save the file as UTF-8");
  CHECK(problems(kHead + "\xC2\xB5 \xC3") == "g.yaml:3:10: byte 0xC3 is not UTF-8: save the file as UTF-8");
  CHECK(problems(kHead + "\xED\xA0\x80") == "g.yaml:3:8: byte 0xED is not UTF-8: save the file as UTF-8");
  CHECK(problems(kHead + std::string("a\0b", 3)) == "g.yaml:3:9: a NUL byte: this is not a text file");
  CHECK(problems(kHead + "end\x04\nunknown: 3\n") == "g.yaml:3:11: control character 0x04");
  CHECK(problems("\xFF\xFE"
                 "b\0o\0") == "g.yaml:1:1: the file is UTF-16: save it as UTF-8");
}

TEST_CASE("graph: a file that is too large is refused unread") {
  CHECK(problems("#" + std::string(4u << 20, 'x')) == "g.yaml: the file has 4194305 bytes, allowed: 4194304");
}

TEST_CASE("graph: Windows line ends and a byte order mark change nothing") {
  const std::string unix_text = "bodeflow: 1\nblocks:\n  a: {block: generators.sine, frequency: 2 Hz}\n";
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : unix_text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(good(windows).expanded == good(unix_text).expanded);
}

TEST_CASE("graph: a message stays on its line and short, whatever the text") {
  CHECK(problems("bodeflow: 1\nblocks: {a: {block: \"x\\n\\e[31m\"}}") ==
        "g.yaml:2:21: block 'a': unknown block 'x\\n\\x1b[31m'");
  CHECK(problems("bodeflow: 1\nblocks: {a: {block: " + std::string(1000, 'x') + "}}").size() < 200);
}

}  // namespace bodeflow::graph
