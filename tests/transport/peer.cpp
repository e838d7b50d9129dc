// One end of an edge in a process of its own, for the tests: `peer send|receive name=value ...`.
// Each sample of a stream is its own index; the receiver compares every one and prints what it saw as `name=value` lines.
#include <bodeflow/abi.h>
#include <linux/filter.h>
#include <sys/socket.h>

#include <chrono>
#include <cstring>
#include <iostream>
#include <map>
#include <thread>

#include "transport/link.hpp"

using namespace bodeflow::transport;

namespace {

std::map<std::string, std::string> options;

double number(const std::string& name, double otherwise) {
  const auto found = options.find(name);
  return found == options.end() ? otherwise : std::stod(found->second);
}
std::string text(const std::string& name, const std::string& otherwise) {
  const auto found = options.find(name);
  return found == options.end() ? otherwise : found->second;
}

Edge edge_of_options() {
  Edge edge;
  edge.topic = text("topic", "test");
  edge.stream = static_cast<std::uint64_t>(number("stream", 1));
  edge.epoch = static_cast<std::uint32_t>(number("epoch", 0));
  edge.lossless = number("lossless", 1) != 0;
  edge.keeps_last = number("keeps_last", 0) != 0;
  edge.tolerance_s = number("tolerance", 10);
  edge.queue_bytes = static_cast<std::uint64_t>(number("queue", 4 << 20));
  edge.readers = static_cast<int>(number("readers", 1));
  edge.open = number("open", 0) != 0;
  return edge;
}

Settings settings_of_options() {
  using Carrier = Settings::Carrier;
  Settings settings;
  settings.domain = static_cast<std::uint32_t>(number("domain", 0));
  settings.lease_s = number("lease", 30);
  settings.datagram = static_cast<std::uint32_t>(number("datagram", 1400));
  const std::map<std::string, Carrier> carriers = {
      {"automatic", Carrier::automatic}, {"udp", Carrier::udp}, {"tcp", Carrier::tcp}, {"shared_memory", Carrier::shared_memory}};
  settings.carrier = carriers.at(text("carrier", "automatic"));
  if (options.contains("peer")) {
    settings.discovery = Settings::Discovery::peers;
    if (!text("peer", "").empty()) settings.peers = {text("peer", "")};
  }
  if (options.contains("server")) {
    settings.discovery = Settings::Discovery::server;
    settings.peers = {text("server", "")};
  }
  if (options.contains("keys")) {
    const std::filesystem::path keys = text("keys", "");
    const auto name = text("name", "");
    settings.security = Security{keys / "authority.pem",
                                 keys / (name + ".pem"),
                                 keys / (name + "_key.pem"),
                                 keys / "governance.smime",
                                 keys / (name + "_permissions.smime"),
                                 {}};
  }
  return settings;
}

/// Each UDP socket of this process loses that share of what comes, by chance: a filter in the kernel.
void lose(double share) {
  if (share <= 0.0) return;
  const auto limit = static_cast<std::uint32_t>(share * 4294967295.0);
  sock_filter code[] = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(SKF_AD_OFF + SKF_AD_RANDOM)),
                        BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, limit, 1, 0), BPF_STMT(BPF_RET | BPF_K, 0),
                        BPF_STMT(BPF_RET | BPF_K, 0xFFFFFFFF)};
  const sock_fprog program{4, code};
  int filtered = 0;
  for (int file = 3; file < 200; ++file) {
    int type = 0, family = 0;
    socklen_t size = sizeof type;
    if (getsockopt(file, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) continue;
    size = sizeof family;
    if (getsockopt(file, SOL_SOCKET, SO_DOMAIN, &family, &size) != 0 || family != AF_INET) continue;
    if (setsockopt(file, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) == 0) ++filtered;
  }
  std::cout << "filtered=" << filtered << std::endl;
}

void report(const EdgeState& state) {
  std::cout << "messages=" << state.messages << "\nsamples=" << state.samples << "\ngaps=" << state.gaps
            << "\nrefused=" << state.refused << "\nreconnects=" << state.reconnects << "\nwaited=" << state.waited_s
            << "\np50=" << state.latency_p50_s << "\np99=" << state.latency_p99_s << '\n';
}

long resident_kb() {
  long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    long all = 0;
    if (std::fscanf(file, "%ld %ld", &all, &pages) != 2) pages = 0;
    std::fclose(file);
  }
  return pages * 4;
}

int failed(const Failure& failure) {
  static const char* kinds[] = {"stopped", "tolerance", "peer", "refused", "library"};
  std::cout << "failure=" << kinds[static_cast<int>(failure.kind)] << "\nerror=" << failure.text << std::endl;
  return 1;
}

void pause() {
  if (const double us = number("pause_us", 0); us > 0) std::this_thread::sleep_for(std::chrono::duration<double, std::micro>(us));
}

int send(const std::shared_ptr<Participant>& participant) {
  auto outlet = open_outlet(participant, edge_of_options());
  if (!outlet) return failed(outlet.error());
  if (auto done = (*outlet)->connect({}); !done) return failed(done.error());
  std::cout << "connected" << std::endl;
  const auto count = static_cast<std::uint64_t>(number("count", 100));
  const auto samples = static_cast<std::size_t>(number("bytes", 8192)) / 8;
  std::vector<double> values(samples);
  double stalled = 0.0;
  const auto go_on = [&] {
    stalled = std::max(stalled, (*outlet)->state().stalled_s);
    return true;
  };
  std::int64_t position = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    for (std::size_t n = 0; n < samples; ++n) values[n] = static_cast<double>(position + static_cast<std::int64_t>(n));
    Header header;
    header.kind = Kind::samples;
    header.position = position;
    header.count = samples;
    header.channels = 1;
    header.rate_num = 1000;
    header.element = BF_F64;
    const std::span<const std::byte> parts[] = {std::as_bytes(std::span(values))};
    if (auto done = (*outlet)->send(header, parts, go_on); !done) {
      report((*outlet)->state());
      std::cout << "stalled=" << stalled << '\n';
      return failed(done.error());
    }
    position += static_cast<std::int64_t>(samples);
    pause();
  }
  if (number("drain", 1) != 0) {
    if (auto done = (*outlet)->drain({}); !done) return failed(done.error());
  }
  report((*outlet)->state());
  std::cout << "stalled=" << stalled << "\nresident_kb=" << resident_kb() << std::endl;
  std::this_thread::sleep_for(std::chrono::duration<double>(number("linger", 0)));
  return 0;
}

int receive(const std::shared_ptr<Participant>& participant) {
  auto inlet = open_inlet(participant, edge_of_options());
  if (!inlet) return failed(inlet.error());
  const auto count = static_cast<std::uint64_t>(number("count", 100));
  const auto die_after = static_cast<std::uint64_t>(number("die_after", 0));
  double stalled = 0.0;
  const auto go_on = [&] {
    stalled = std::max(stalled, (*inlet)->state().stalled_s);
    return true;
  };
  std::uint64_t wrong = 0;
  std::int64_t position = static_cast<std::int64_t>(number("first", 0));
  for (std::uint64_t k = 0; k < count; ++k) {
    auto message = (*inlet)->next(go_on);
    if (!message) {
      report((*inlet)->state());
      std::cout << "wrong=" << wrong << "\nstalled=" << stalled << '\n';
      return failed(message.error());
    }
    if (k == 0 && number("any_first", 0) != 0) position = message->header.position;
    if (k == count / 10) std::cout << "resident_begin_kb=" << resident_kb() << std::endl;
    if (k == 0) std::cout << "first_sequence=" << message->header.sequence << "\nepoch=" << message->header.epoch << std::endl;
    if (message->header.position != position) ++wrong;
    for (std::size_t n = 0; n < message->header.count; ++n) {
      double value = 0.0;
      std::memcpy(&value, message->payload.data() + 8 * n, 8);
      if (value != static_cast<double>(position + static_cast<std::int64_t>(n))) ++wrong;
    }
    position += static_cast<std::int64_t>(message->header.count);
    if (die_after != 0 && k + 1 == die_after) {
      std::cout << "dying" << std::endl;
      std::_Exit(9);
    }
    pause();
  }
  report((*inlet)->state());
  std::cout << "wrong=" << wrong << "\nstalled=" << stalled << "\nresident_kb=" << resident_kb() << std::endl;
  std::this_thread::sleep_for(std::chrono::duration<double>(number("linger", 0.1)));
  return 0;
}

int mail(const std::shared_ptr<Participant>& participant, bool sends) {
  if (sends) {
    auto done = post(participant, text("topic", "mail"), std::string(static_cast<std::size_t>(number("bytes", 10)), 'x'),
                     number("seconds", 5));
    return done ? 0 : failed(done.error());
  }
  auto mailbox = open_mailbox(participant, text("topic", "mail"));
  if (!mailbox) return failed(mailbox.error());
  const auto got = (*mailbox)->receive(number("seconds", 5));
  std::cout << "got=" << (got ? static_cast<long>(got->size()) : -1) << std::endl;
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  return 0;
}

int board(const std::shared_ptr<Participant>& participant) {
  auto board = open_board(participant, text("topic", "board"), options.contains("say"));
  if (!board) return failed(board.error());
  if (options.contains("say")) {
    if (auto done = (*board)->say(text("say", "")); !done) return failed(done.error());
  }
  const int steps = static_cast<int>(number("seconds", 2) * 10);
  for (int step = 0; step < steps; ++step) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::cout << "t" << step << "=";
    for (const auto& note : (*board)->texts()) std::cout << note << ",";
    std::cout << std::endl;
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  const std::string what = count > 1 ? arguments[1] : "";
  for (int i = 2; i < count; ++i) {
    const std::string argument = arguments[i];
    const auto equals = argument.find('=');
    options[argument.substr(0, equals)] = argument.substr(equals + 1);
  }
  auto participant = join(settings_of_options());
  if (!participant) {
    std::cout << "error=" << participant.error() << std::endl;
    return 2;
  }
  std::cout << "joined" << std::endl;
  lose(number("loss", 0.0));
  if (what == "send") return send(*participant);
  if (what == "receive") return receive(*participant);
  if (what == "post") return mail(*participant, true);
  if (what == "mailbox") return mail(*participant, false);
  if (what == "board") return board(*participant);
  std::cerr << "peer send|receive|post|mailbox|board name=value ...\n";
  return 2;
}
