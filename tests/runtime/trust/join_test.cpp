// Who gets into a lab: real processes with real Fast DDS on the loopback, some of which cheat.
#include <arpa/inet.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "catch.hpp"
#include "runtime/trust/folder.hpp"

extern char** environ;

namespace {

namespace fs = std::filesystem;
using namespace bodeflow::trust;
using bodeflow::test::kDay;
using bodeflow::test::must;
using Words = std::vector<std::string>;

/// A member of the domain that runs until end() or, a reader, until it has enough.
class Member {
 public:
  Member(const std::string& role, const fs::path& out, const Words& more) : out_(out) {
    const std::string domain = std::to_string(domain_of_this_process());
    Words words{BODEFLOW_TRUST_MEMBER, role, "bodeflow/test", domain};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::array<int, 2> input{};
    if (::pipe2(input.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const int error = posix_spawn(&process_, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(input[0]);
    input_ = input[1];
    if (error != 0) throw std::runtime_error("can't start " + words[0]);
  }
  Member(Member&& other) noexcept
      : process_(std::exchange(other.process_, -1)), input_(std::exchange(other.input_, -1)), out_(std::move(other.out_)) {}
  Member& operator=(Member&&) = delete;
  ~Member() {
    if (process_ > 0) end();
  }

  /// What it says at its end; waits for it.
  std::string says() {
    if (process_ > 0) ::waitpid(std::exchange(process_, -1), nullptr, 0);
    if (input_ >= 0) ::close(std::exchange(input_, -1));
    std::string text = bodeflow::test::content(out_);
    if (!text.empty()) text.pop_back();  // the end of the line
    return text;
  }
  bool runs() const {
    siginfo_t ended{};
    return process_ > 0 && ::waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           ended.si_pid == 0;
  }
  std::string end() {
    ::close(std::exchange(input_, -1));
    return says();
  }

  static unsigned domain_of_this_process() { return 20 + static_cast<unsigned>(::getpid()) % 80; }

 private:
  pid_t process_ = -1;
  int input_ = -1;
  fs::path out_;
};

/// A lab with hosts for every case, another lab of the same name, and members that take part with their files.
class Bench {
 public:
  Bench() {
    const Time now = std::chrono::system_clock::now(), earlier = now - 10 * kDay;
    must(init(lab_.folder, {"lab", 3650}, earlier));
    for (const char* host : {"bench", "motor", "early", "stolen"}) must(add(lab_.folder, new_host(host), earlier));
    NewHost expired = new_host("expired"), printer = new_host("printer");
    expired.days = 3;
    printer.topics = {"printing/*"};
    must(add(lab_.folder, expired, earlier));
    must(add(lab_.folder, printer, earlier));
    fs::copy_file(lab_.revocations, earlier_list());
    must(revoke(lab_.folder, "stolen", now));

    must(init(foreign_.folder, {"lab", 3650}, earlier));
    NewHost foreigner = new_host("motor");
    foreigner.bundle = folder_.path() / "foreign.tar";
    must(add(foreign_.folder, foreigner, earlier));
  }

  const Files& lab() const { return lab_; }
  const Files& foreign() const { return foreign_; }
  fs::path earlier_list() const { return folder_.path() / "earlier.pem"; }
  fs::path path(const std::string& name) const { return folder_.path() / name; }

  static Words files(const Files& files, const std::string& host) {
    return {"authority=" + files.authority.string(), "certificate=" + files.certificate(host).string(),
            "key=" + files.key(host).string(), "governance=" + files.governance.string(),
            "permissions=" + files.permissions(host).string()};
  }

  /// With the list of revoked certificates as it is now.
  Member honest(const std::string& role, const std::string& host, const Words& more) {
    Words words = files(lab_, host);
    words.push_back("revocations=" + lab_.revocations.string());
    return start(role, words, more);
  }
  Member start(const std::string& role, Words files, const Words& more) {
    files.insert(files.end(), more.begin(), more.end());
    return {role, path("out" + std::to_string(members_++)), files};
  }

 private:
  NewHost new_host(const std::string& name) const {
    NewHost host;
    host.name = name;
    host.bundle = folder_.path() / (name + ".tar");
    return host;
  }

  bodeflow::test::TrustFolder folder_;
  Files lab_{folder_.path() / "lab"}, foreign_{folder_.path() / "foreign"};
  int members_ = 0;
};

struct Intruder {
  const char* name;
  Words files;
};

std::string days_ago(int days) { return "--clock=" + std::to_string(-86400L * days); }

std::vector<Intruder> intruders(const Bench& bench) {
  const Files &lab = bench.lab(), &foreign = bench.foreign();
  const auto with = [](Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const std::string foreign_authority = "permissions_authority=" + foreign.authority.string();
  return {{"without security", {}},
          {"of another authority of the same name", Bench::files(foreign, "motor")},
          {"expired, with a wrong clock", with(Bench::files(lab, "expired"), {days_ago(9)})},
          {"revoked, without the list", Bench::files(lab, "stolen")},
          {"without permission for the topic, which it grants itself", with(Bench::files(lab, "printer"), {"--permit"})},
          {"with permissions of another authority",
           with(Bench::files(lab, "motor"), {foreign_authority, "governance=" + foreign.governance.string(),
                                             "permissions=" + foreign.permissions("motor").string()})}};
}

/// False, and says so, where the installed Fast DDS can't do what is tested.
bool has_security() {
  const bodeflow::test::TrustFolder folder;
  Member member("reader", folder.path() / "out", {});
  if (member.end() != "no security") return true;
  WARN("skipped: the installed Fast DDS is built without security");
  return false;
}

/// A plain RTPS message with one sample in the name of a writer, to a reader; both as 32 hexadecimal digits.
std::string forged_sample(const std::string& writer, const std::string& reader, unsigned sequence, char mark) {
  const auto bytes = [](const std::string& digits) {
    std::string all;
    for (std::size_t k = 0; k + 1 < digits.size(); k += 2) all += static_cast<char>(std::stoi(digits.substr(k, 2), nullptr, 16));
    return all;
  };
  const auto number = [](std::uint32_t value, int size) {
    std::string all;
    for (int k = 0; k < size; ++k) all += static_cast<char>(value >> (8 * k) & 0xffU);
    return all;
  };
  const std::string to = bytes(reader), from = bytes(writer);
  const std::string data = number(0, 2) + number(16, 2) + to.substr(12) + from.substr(12) + number(0, 4) + number(sequence, 4) +
                           std::string("\0\1\0\0", 4) + std::string(100, mark);
  return "RTPS" + std::string("\2\3\1\17") + from.substr(0, 12) + "\16\1" + number(12, 2) + to.substr(0, 12) + "\25\5" +
         number(static_cast<std::uint32_t>(data.size()), 2) + data;
}

/// Waits for the reader to tell whom it reads, and sends forged samples to it while it runs, `rounds` times at most.
void forge(const Member& member, const fs::path& told, unsigned rounds) {
  for (int k = 0; k < 2000 && !fs::exists(told); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::ifstream file(told);
  std::string writer, reader;
  file >> writer >> reader;
  REQUIRE(reader.size() == 32);
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  for (unsigned round = 0; round < rounds && member.runs(); ++round) {
    for (unsigned sequence = 1; sequence < 40; ++sequence) {
      const std::string message = forged_sample(writer, reader, sequence, 'x');
      for (unsigned participant = 0; participant < 4; ++participant) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        to.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * Member::domain_of_this_process() + 11 + 2 * participant));
        ::sendto(socket, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ::close(socket);
}

}  // namespace

TEST_CASE("a host of the lab reads from hosts of the lab and from nobody else") {
  if (!has_security()) return;
  Bench bench;
  std::vector<Member> outside;
  Member reader = bench.honest("reader", "bench", {"--enough=me"});
  for (const Intruder& intruder : intruders(bench)) outside.push_back(bench.start("writer", intruder.files, {"--mark=x"}));
  Member motor = bench.honest("writer", "motor", {"--mark=m"});
  // what keeps the expired one out is not its wrong clock
  Member early = bench.start("writer", Bench::files(bench.lab(), "early"), {"--mark=e", days_ago(9)});

  const std::string read = reader.says();
  CAPTURE(read);
  CHECK(read.find('m') != std::string::npos);
  CHECK(read.find('e') != std::string::npos);
  CHECK(read.find('x') == std::string::npos);
  for (std::size_t k = 0; k < outside.size(); ++k) {
    INFO(intruders(bench)[k].name);
    CHECK(outside[k].end() == "nobody");
  }
  CHECK(motor.end().front() == 'm');
  CHECK(early.end().front() == 'e');
}

TEST_CASE("a host of the lab is read by hosts of the lab and by nobody else") {
  if (!has_security()) return;
  Bench bench;
  std::vector<Member> outside;
  Member writer = bench.honest("writer", "bench", {"--mark=b"});
  for (const Intruder& intruder : intruders(bench)) outside.push_back(bench.start("reader", intruder.files, {}));
  Member motor = bench.honest("reader", "motor", {"--enough=b"});
  Member early = bench.start("reader", Bench::files(bench.lab(), "early"), {"--enough=b", days_ago(9)});

  CHECK(motor.says().front() == 'b');
  CHECK(early.says().front() == 'b');
  for (std::size_t k = 0; k < outside.size(); ++k) {
    INFO(intruders(bench)[k].name);
    CHECK(outside[k].end() == "nobody");
  }
}

TEST_CASE("a revoked host gets in where the list is not yet the new one") {
  if (!has_security()) return;
  Bench bench;
  Member reader =
      bench.start("reader", Bench::files(bench.lab(), "bench"), {"--enough=s", "revocations=" + bench.earlier_list().string()});
  Member stolen = bench.start("writer", Bench::files(bench.lab(), "stolen"), {"--mark=s"});
  CHECK(reader.says().front() == 's');
}

TEST_CASE("an honest host without permission or with an expired or revoked certificate is refused by its own library") {
  if (!has_security()) return;
  Bench bench;
  for (const char* host : {"printer", "expired", "stolen"}) {
    INFO(host);
    CHECK(bench.honest("writer", host, {}).says() == "refused");
  }
}

TEST_CASE("a plain sample in the name of a known writer is taken without security and refused with it") {
  if (!has_security()) return;
  Bench bench;
  const bool secure = GENERATE(false, true);
  CAPTURE(secure);
  const std::string tell = "--tell=" + bench.path("told").string();
  Member reader = secure ? bench.honest("reader", "bench", {tell}) : bench.start("reader", {}, {tell, "--enough=x"});
  Member writer = secure ? bench.honest("writer", "motor", {"--samples=1"}) : bench.start("writer", {}, {"--samples=1"});
  forge(reader, bench.path("told"), secure ? 30 : 3000);
  const bool taken = reader.end().find('x') != std::string::npos;
  CHECK(taken == !secure);
}
