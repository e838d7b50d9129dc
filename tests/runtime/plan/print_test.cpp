#include <nlohmann/json.hpp>

#include "net.hpp"
#include "plan/fold.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

Net example() {
  Net net;
  net.phase.name = "identify";
  net.phase.run.duration_s = 8.192;
  net.source("excitation", {250, 1});
  net.hold("hold", 40);
  net.sum("sum");
  net.lag("motor");
  net.estimator("dft");
  net.connect("excitation", "hold");
  net.connect("hold", "sum.in");
  net.connect("sum", "motor");
  net.connect("motor", "sum.feedback");
  net.connect("motor", "dft");
  return net;
}

}  // namespace

TEST_CASE("print: the plan as text") {
  const Net net = example();
  const plan::Facts facts = net.facts();
  CHECK(plan::to_text(net.phase, facts, net.plan(1024)) ==
        "plan of phase 'identify': 1 thread, chunks of 100 ms (25 periods), latency 100 ms, 24.06 kB of buffers\n"
        "\n"
        "thread 1: 3.05 ms of declared work a chunk, 24.06 kB of buffers\n"
        "  excitation  test.excitation, 250 Hz: 25 firings, 2048 in all; out: 250 Hz f64 x 1 -> buffer 0\n"
        "  hold        test.hold, 250 Hz: 25 firings, 2048 in all; out: 10 kHz f64 x 1 -> buffer 1\n"
        "  loop, a pass is 100 us: motor, sum\n"
        "    motor       test.motor, 10 kHz: 1000 firings, 81920 in all; out: 10 kHz f64 x 1 -> buffer 3\n"
        "    sum         test.sum, 10 kHz: 1000 firings, 81920 in all; out: 10 kHz f64 x 1 -> buffer 2\n"
        "  dft         test.dft, 10 kHz: 1000 firings, 81920 in all\n"
        "\n"
        "buffers:\n"
        "  0: excitation.out, 25 samples x 1 channel, 256 B at 16064 of thread 1\n"
        "  1: hold.out, 1000 samples x 1 channel, 8 kB at 8064 of thread 1\n"
        "  2: sum.out, 1000 samples x 1 channel, history of 1, 8.064 kB at 0 of thread 1\n"
        "  3: motor.out, 1000 samples x 1 channel, 8 kB at 16064 of thread 1\n");
}

TEST_CASE("print: the plan as JSON has the same facts") {
  const Net net = example();
  const plan::Facts facts = net.facts();
  const nlohmann::json json = plan::to_json(net.phase, facts, net.plan(1024));
  CHECK(json["phase"] == "identify");
  CHECK(json["repetitions"] == 25);
  CHECK(json["period_s"] == nlohmann::json{{"value", 0.004}, {"num", 1}, {"den", 250}});
  CHECK(json["blocks"][3]["firings"] == 81920);
  CHECK(json["blocks"][3]["inputs"][0]["delay"] == 1);
  CHECK(json["blocks"][3]["rate_hz"]["value"] == 10000.0);
  CHECK(json["buffers"][2]["history"] == 1);
  CHECK(json["order"] == nlohmann::json{"excitation", "hold", "motor", "sum", "dft"});
  CHECK(json["threads"][0]["steps"][0] == nlohmann::json{{"kind", "call"}, {"block", "excitation"}});
  CHECK(json["threads"][0]["steps"][2]["schedule"] ==
        nlohmann::json::parse(R"([{"times": 1, "firings": [{"block": "motor", "count": 1}, {"block": "sum", "count": 1}]}])"));
}

TEST_CASE("print: a schedule is folded where parts repeat") {
  std::vector<plan::Firing> schedule{{0, 1}};
  for (int i = 0; i < 10; ++i) {
    schedule.push_back({1, 1});
    schedule.push_back({2, 4});
  }
  schedule.push_back({3, 1});
  const auto folds = plan::fold_schedule(schedule);
  REQUIRE(folds.size() == 3);
  CHECK(folds[0].times == 1);
  CHECK(folds[1].times == 10);
  CHECK(folds[1].firings.size() == 2);
  CHECK(folds[2].firings[0].block == 3);
}
