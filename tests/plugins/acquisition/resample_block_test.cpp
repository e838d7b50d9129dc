#include "acquisition/resample_block.hpp"

#include <cmath>

#include "catch.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using acquisition::Resample;
using test::BlockDriver;
using test::failure_of;

namespace {

StreamFacts stream(double rate, std::int64_t length, const std::string& clock = "") {
  StreamFacts f;
  f.known = true;
  f.channels = 2;
  f.rate = Rate::from_hz(rate);
  f.length = length;
  f.unit = "V";
  f.clock = clock;
  return f;
}

}  // namespace

TEST_CASE("resample block: rate, length and clock of the output are stated, the unit stays") {
  BlockDriver<Resample> block;
  block.set("rate", 48e3).set("clock", "");
  block.configure();
  const auto out = block.resolve({stream(44.1e3, 44100, "scope")});
  CHECK(out[0].rate == Rate(48000, 1));
  CHECK(out[0].length == 48000);
  CHECK(out[0].clock == "");
  CHECK(out[0].unit == "V");
  BlockDriver<Resample> same;
  same.set("rate", 22.05e3);
  same.configure();
  CHECK(same.resolve({stream(44.1e3, -1, "scope")})[0].clock == "scope");
}

TEST_CASE("resample block: the delay is told, and lines of the excitation beyond the pass band are warned of") {
  BlockDriver<Resample> block;
  block.set("rate", 500.0);
  block.configure();
  StreamFacts x = stream(1000, 10000);
  x.notes["excitation.frequencies"] = {10, 190, 210};
  CHECK(
      block.advise({x}) ==
      std::vector<std::string>{"delays by 34 output samples, 0.068 s",
                               "warning: the excitation has lines above 200 Hz, the end of the pass band: these are attenuated; "
                               "raise rate or pass_band, or excite lower lines"});
}

TEST_CASE("resample block: a buffer that drift will use up is refused before the run, or ends it by name") {
  BlockDriver<Resample> block;
  block.set("rate", 1000.0).set("drift", 50.0).set("buffer", 0.01);
  block.configure();
  CHECK(failure_of([&] { block.resolve({stream(1000, 1000000)}); }) ==
        "a drift of 50 ppm over 1000000 samples needs a buffer of 0.051 s; buffer gives 0.01 s");
  block.resolve({stream(1000, 100000)});

  BlockDriver<Resample> endless;
  endless.set("rate", 1000.0).set("drift", -10000.0);
  endless.configure();
  endless.resolve({stream(1000, -1)});
  CHECK(endless.advise({stream(1000, -1)}).back() ==
        "the length of the input is not known: the buffer lasts for 10 s, then the run ends; `buffer` makes it longer");
  endless.activate(1000, Rate(1000, 1));
  const std::vector<double> second(1000, 1.0);
  for (int i = 0; i < 10; ++i) endless.process({{second, second}}, 1000);
  CHECK(failure_of([&] {
          endless.process({{second, second}}, 1000);
        }) == "the buffer of 100 samples (0.1 s) is used up: a drift of -10000 ppm uses it in 10 s; raise buffer");
}

TEST_CASE("resample block: rates that can't be joined are refused") {
  BlockDriver<Resample> block;
  block.set("rate", 48001.0);
  block.configure();
  CHECK(failure_of([&] { block.resolve({stream(44.1e3, 100)}); }).substr(0, 52) ==
        "the output rate is 48001/44100 of the input rate; nu");
}
