#include "plugins/sha256.hpp"

#include "catch.hpp"
#include "support.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

std::string hex(const std::string& text) { return sha256_hex(std::as_bytes(std::span(text))); }

}  // namespace

TEST_CASE("SHA-256 gives the digests of FIPS 180-4") {
  CHECK(hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(hex(std::string(1000000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("SHA-256 in pieces equals that of the whole, and goes on after a look") {
  Sha256 sum;
  sum.update("a", 1);
  CHECK(sum.hex() == hex("a"));
  sum.update("bc", 2);
  CHECK(sum.hex() == hex("abc"));
}

TEST_CASE("SHA-256 of a file is that of its bytes, or names the file that can't be read") {
  const Folder folder;
  const std::string text(700001, 'x');
  write(folder / "a", text);
  CHECK(sha256_of_file(folder / "a").value() == hex(text));
  const auto missing = sha256_of_file(folder / "b");
  REQUIRE_FALSE(missing);
  CHECK(missing.error() == "can't read '" + (folder / "b").string() + "': No such file or directory");
}
