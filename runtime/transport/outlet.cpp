#include <algorithm>
#include <ctime>

#include "transport/ledger.hpp"

namespace bodeflow::transport {
namespace {

using middleware::Flow;
using middleware::Guid;
using middleware::Type;

std::int64_t wall_clock_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{1000000000} * now.tv_sec + now.tv_nsec;
}

class Readers final : public middleware::WriterSink {
 public:
  Readers(std::shared_ptr<Ledger> ledger, Way way) : ledger_(std::move(ledger)), way_(way) {}
  void matched(const Guid& reader, bool yes) override { ledger_->reader_matched(way_, reader, yes); }

 private:
  std::shared_ptr<Ledger> ledger_;
  Way way_;
};

class Credits final : public middleware::ReaderSink {
 public:
  Credits(std::shared_ptr<Ledger> ledger, Way way, const Guid& here) : ledger_(std::move(ledger)), way_(way), here_(here) {}
  bool room() override { return true; }
  void sample(std::span<const std::byte> bytes) override {
    if (const auto credit = decode_credit(bytes)) {
      ledger_->credit(way_, *credit, middleware::same_host(credit->reader, here_));
    } else {
      ledger_->refused();
    }
  }
  void matched(const Guid& /*writer*/, bool /*yes*/) override {}

 private:
  std::shared_ptr<Ledger> ledger_;
  Way way_;
  Guid here_;
};

class DdsOutlet final : public Outlet {
 public:
  DdsOutlet(std::shared_ptr<Participant> participant, const Edge& edge)
      : participant_(std::move(participant)),
        edge_(edge),
        ledger_(std::make_shared<Ledger>(edge, has_near(*participant_, edge))) {}

  tl::expected<void, Failure> open() {
    for (const auto way : {kFar, kNear}) {
      if (way == kNear && !has_near(*participant_, edge_)) continue;
      if (auto done = open(way); !done) return done;
    }
    return {};
  }

  tl::expected<void, Failure> connect(const GoOn& go_on) override {
    auto way = ledger_->wait_for_readers(go_on);
    if (!way) return tl::unexpected(way.error());
    return {};
  }

  tl::expected<void, Failure> send(Header header, std::span<const std::span<const std::byte>> parts, const GoOn& go_on) override {
    std::uint64_t payload = 0;
    for (const auto part : parts) payload += part.size();
    if (const auto wrong = refusal(header, payload); !wrong.empty()) {
      return tl::unexpected(Failure{Failure::Kind::refused, "topic '" + edge_.topic + "': not sent: " + wrong});
    }
    Ledger::Ticket ticket;
    if (edge_.lossless) {
      auto booked = ledger_->book(payload, go_on);
      if (!booked) return tl::unexpected(booked.error());
      ticket = *booked;
    } else {
      ticket.sequence = ledger_->book_latest();
    }
    header.stream = edge_.stream;
    header.epoch = edge_.epoch;
    header.sequence = ticket.sequence;
    header.source_ns = wall_clock_ns();
    const auto head = encode_head(header, payload);
    whole_.assign(1, head);
    whole_.insert(whole_.end(), parts.begin(), parts.end());
    auto done = edge_.lossless ? write(*sides_[ticket.way].writer, go_on) : write_latest();
    if (done) count(header, payload);
    return done;
  }

  tl::expected<void, Failure> drain(const GoOn& go_on) override {
    if (!edge_.lossless || ledger_->sent() == 0) return {};
    auto way = ledger_->wait_for_readers(go_on);
    if (!way) return tl::unexpected(way.error());
    return acknowledged(*sides_[*way].writer, go_on);
  }

  EdgeState state() const override {
    EdgeState state;
    ledger_->tell(state);
    state.messages = messages_.load();
    state.bytes = bytes_.load();
    state.samples = samples_.load();
    return state;
  }

 private:
  struct Side {
    std::shared_ptr<Readers> readers;
    std::shared_ptr<Credits> grants;
    std::unique_ptr<middleware::Writer> writer;
    std::unique_ptr<middleware::Reader> credits;
  };

  tl::expected<void, Failure> open(Way way) {
    auto& side = sides_[way];
    const auto topic = topic_on(way, edge_.topic);
    const auto flow = !edge_.lossless ? Flow::latest : edge_.keeps_last ? Flow::last : Flow::all;
    side.readers = std::make_shared<Readers>(ledger_, way);
    auto writer = participant_->node(way)->writer({topic, Type::message, flow}, side.readers);
    if (!writer) return tl::unexpected(writer.error());
    side.writer = std::move(*writer);
    if (!edge_.lossless) return {};
    side.grants = std::make_shared<Credits>(ledger_, way, side.writer->guid());
    auto credits = participant_->node(way)->reader({topic + ".credit", Type::credit, Flow::last}, side.grants);
    if (!credits) return tl::unexpected(credits.error());
    side.credits = std::move(*credits);
    return {};
  }

  /// The library refuses a write now and then although there will be room: it is tried again until the tolerance.
  tl::expected<void, Failure> write(middleware::Writer& writer, const GoOn& go_on) {
    if (edge_.keeps_last) {  // the library keeps one message: the next replaces it, so it must have arrived
      if (auto done = acknowledged(writer, go_on); !done) return done;
    }
    if (writer.write(whole_)) {
      ledger_->progress().made();
      return {};
    }
    const Progress::Wait wait(ledger_->progress());
    while (!writer.write(whole_)) {
      if (go_on && !go_on()) return tl::unexpected(ledger_->failure(Failure::Kind::stopped));
      if (ledger_->progress().too_long()) return tl::unexpected(ledger_->failure(Failure::Kind::tolerance));
    }
    ledger_->progress().made();
    return {};
  }

  tl::expected<void, Failure> write_latest() {
    if (ledger_->has_readers(kFar)) static_cast<void>(sides_[kFar].writer->write(whole_));
    return {};
  }

  tl::expected<void, Failure> acknowledged(middleware::Writer& writer, const GoOn& go_on) {
    const Progress::Wait wait(ledger_->progress());
    while (!writer.acknowledged(0.05)) {
      if (go_on && !go_on()) return tl::unexpected(ledger_->failure(Failure::Kind::stopped));
      if (ledger_->progress().too_long()) return tl::unexpected(ledger_->failure(Failure::Kind::tolerance));
    }
    // Without readers the library says yes at once.
    if (ledger_->sent() > 0 && !ledger_->still_there() && !edge_.open) {
      auto gone = ledger_->failure(Failure::Kind::tolerance);
      gone.kind = Failure::Kind::peer;
      return tl::unexpected(gone);
    }
    return {};
  }

  void count(const Header& header, std::uint64_t payload) {
    messages_.fetch_add(1);
    bytes_.fetch_add(payload);
    if (header.kind == Kind::samples) samples_.fetch_add(header.count);
  }

  std::shared_ptr<Participant> participant_;
  const Edge edge_;
  std::shared_ptr<Ledger> ledger_;
  std::array<Side, kWays> sides_;
  std::vector<std::span<const std::byte>> whole_;
  std::atomic<std::uint64_t> messages_{0}, bytes_{0}, samples_{0};
};

}  // namespace

tl::expected<std::unique_ptr<Outlet>, Failure> open_outlet(const std::shared_ptr<Participant>& participant, const Edge& edge) {
  auto outlet = std::make_unique<DdsOutlet>(participant, edge);
  if (auto done = outlet->open(); !done) return tl::unexpected(done.error());
  return outlet;
}

}  // namespace bodeflow::transport
