#include "acquisition/frequency_response_block.hpp"

#include <cmath>

#include "catch.hpp"
#include "plugins/block_driver.hpp"
#include "read_whole.hpp"

using namespace bodeflow;
using acquisition::FrequencyResponseBlock;
using test::BlockDriver;
using test::failure_of;
using test::TemporaryFile;

namespace {

const char* const kTable = "f [Hz],re(G11) [V/A],im(G11) [V/A],re(G21) [V/A],im(G21) [V/A]\n1,1,0,3,4\n2,2,0,6,8\n3,3,0,0,0\n";

std::string failure(const std::string& text, const std::function<void(BlockDriver<FrequencyResponseBlock>&)>& set) {
  const TemporaryFile file(".csv", text);
  BlockDriver<FrequencyResponseBlock> block;
  block.set("file", file.path());
  set(block);
  std::string said = failure_of([&] { block.configure(); });
  if (said.rfind(file.path(), 0) == 0) said = "F" + said.substr(file.path().size());
  return said;
}

}  // namespace

TEST_CASE("frequency response block: one record at the end holds the file's response, and no invented variance") {
  const TemporaryFile file(".csv", kTable);
  BlockDriver<FrequencyResponseBlock> block;
  block.set("file", file.path()).set("band", std::vector<double>{2, 10});
  block.configure();
  CHECK(block.log() ==
        std::vector<std::string>{file.path() +
                                 ": CSV, frequency in column 'f [Hz]' [Hz]; 2 points, 2 to 3 Hz; outputs y1, y2; inputs u1; "
                                 "unit V/A; no variance; G11 from real and imaginary part; G21 from real and imaginary part; "
                                 "1 point outside the band left out"});
  block.resolve({});
  block.activate(1, {});
  block.finish();
  block.reset();
  block.finish();
  REQUIRE(block.records().size() == 2);
  const RecordView r(*block.records()[1]);
  CHECK(r.type() == "frequency_response");
  CHECK(r.text("form") == "imported");
  CHECK(r.text("method") == "file");
  CHECK(r.boolean("variance_known") == false);
  CHECK(r.texts("output_names") == std::vector<std::string_view>{"y1", "y2"});
  CHECK(r.texts("response_units") == std::vector<std::string_view>{"V/A", "V/A"});
  CHECK_FALSE(r.array("variance"));
  CHECK_FALSE(r.array("confidence_radius"));
  const auto response = r.array("response");
  REQUIRE(response);
  CHECK(std::vector<std::uint64_t>(response->shape.begin(), response->shape.end()) == std::vector<std::uint64_t>{2, 2, 1});
  CHECK(response->as<std::complex<double>>()[1] == std::complex<double>(6, 8));
  CHECK(r.array("frequency")->as<double>()[0] == 2.0);
}

TEST_CASE("frequency response block: a stated deviation becomes variance, with its confidence circle by the degrees of freedom") {
  const TemporaryFile file(".csv", kTable);
  BlockDriver<FrequencyResponseBlock> block;
  block.set("file", file.path()).set("deviation.relative", 0.1).set("deviation.absolute", 2.0).set("degrees_of_freedom", 3.0);
  block.set("quantity", std::vector<std::string>{"G21"});
  block.configure();
  block.resolve({});
  block.activate(1, {});
  block.finish();
  const RecordView r(*block.records()[0]);
  const auto variance = r.array("variance")->as<double>(), radius = r.array("confidence_radius")->as<double>();
  CHECK(variance[0] == Approx(0.25 + 4.0).epsilon(1e-14));
  CHECK(variance[2] == Approx(4.0).epsilon(1e-14));
  CHECK(r.array("variance")->unit == "(V/A)^2");
  CHECK(radius[2] == Approx(std::sqrt(4.0 * 3 * (std::pow(0.05, -1.0 / 3) - 1))).epsilon(1e-12));
}

TEST_CASE("frequency response block: parameters that contradict the file are refused") {
  using Block = BlockDriver<FrequencyResponseBlock>;
  const std::string with_variance = "f,re(G),im(G),var(G)\n1,1,0,1\n";
  CHECK(failure(with_variance, [](Block& b) { b.set("deviation.relative", 0.1); }) ==
        "F: the file has variances; leave deviation.relative and deviation.absolute away");
  CHECK(failure(kTable, [](Block& b) { b.set("unit", "ohm"); }) == "no failure");
  CHECK(failure(kTable, [](Block& b) { b.set("unit", "V"); }) == "F: unit 'V', but the file says 'V/A'");
  CHECK(failure(kTable, [](Block& b) { b.set("unit", "furlong"); }) == "F: unit 'furlong' is not known");
  CHECK(failure(kTable, [](Block& b) { b.set("band", std::vector<double>{1}); }) ==
        "band has 1 frequencies; allowed: two, lowest and highest");
  CHECK(failure(kTable, [](Block& b) {
          b.set("band", std::vector<double>{2, 1});
        }) == "band must rise from a frequency of at least 0 Hz");
  CHECK(failure(kTable, [](Block& b) {
          b.set("band", std::vector<double>{7, 9});
        }) == "F: no point within the band from 7 to 9 Hz; the file has 1 to 3 Hz");
  CHECK(failure(kTable, [](Block& b) { b.set("quantity", std::vector<std::string>{"Z"}); }) ==
        "F:1: no quantity of those wanted; the file has G11, G21");
  CHECK(failure(kTable, [](Block& b) { b.set("degrees_of_freedom", 5.0); }) ==
        "F: degrees_of_freedom without variances; the file has none, deviation.relative or deviation.absolute states one");
}
