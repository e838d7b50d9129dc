#include "lab/clock.hpp"

#include <time.h>

#include <chrono>
#include <limits>

#include "lab/channel.hpp"

namespace bodeflow::lab {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kQuestions = 16;

struct Ends {
  std::unique_ptr<transport::Outlet> outlet;
  std::unique_ptr<transport::Inlet> inlet;
};

std::int64_t wall_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

tl::expected<Ends, std::string> open(const std::shared_ptr<transport::Participant>& participant, const std::string& topic,
                                     bool asks, const transport::GoOn& go_on) {
  const auto edge = [&](const std::string& name) {
    transport::Edge made;
    made.topic = name;
    made.stream = transport::stream_id(name);
    return made;
  };
  auto outlet = transport::open_outlet(participant, edge(topic + (asks ? "/question" : "/answer")));
  if (!outlet) return tl::unexpected(outlet.error().text);
  auto inlet = transport::open_inlet(participant, edge(topic + (asks ? "/answer" : "/question")));
  if (!inlet) return tl::unexpected(inlet.error().text);
  if (auto connected = (*outlet)->connect(go_on); !connected) return tl::unexpected(connected.error().text);
  return Ends{std::move(*outlet), std::move(*inlet)};
}

transport::Header time_header(std::int64_t position) {
  transport::Header header;
  header.kind = transport::Kind::text;
  header.position = position;
  header.rate_num = 1;
  return header;
}

}  // namespace

tl::expected<ClockOffset, std::string> ask_clock(const std::shared_ptr<transport::Participant>& participant,
                                                 const std::string& topic, double seconds) {
  const auto until = Clock::now() + std::chrono::duration<double>(seconds);
  const transport::GoOn go_on = [&] { return Clock::now() < until; };
  auto ends = open(participant, topic, true, go_on);
  if (!ends) return tl::unexpected(ends.error());
  ClockOffset best{0.0, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < kQuestions; ++i) {
    const std::int64_t sent = wall_ns();
    if (auto asked = ends->outlet->send(time_header(sent), {}, go_on); !asked) return tl::unexpected(asked.error().text);
    auto answer = ends->inlet->next(go_on);
    if (!answer) return tl::unexpected(answer.error().text);
    const std::int64_t back = wall_ns();
    const double half = 0.5e-9 * static_cast<double>(back - sent);
    if (half < best.uncertainty_s) best = {1e-9 * static_cast<double>(answer->header.position - sent) - half, half};
  }
  return best;
}

void answer_clock(const std::shared_ptr<transport::Participant>& participant, const std::string& topic, double seconds) {
  const auto until = Clock::now() + std::chrono::duration<double>(seconds);
  const transport::GoOn go_on = [&] { return Clock::now() < until; };
  auto ends = open(participant, topic, false, go_on);
  if (!ends) return;
  for (int i = 0; i < kQuestions; ++i) {
    if (!ends->inlet->next(go_on)) return;
    if (!ends->outlet->send(time_header(wall_ns()), {}, go_on)) return;
  }
  (void)ends->outlet->drain(go_on);
}

}  // namespace bodeflow::lab
