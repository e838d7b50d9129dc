#include <sys/stat.h>

#include "catch.hpp"
#include "runtime/trust/folder.hpp"
#include "trust/documents.hpp"
#include "trust/security.hpp"

namespace {

namespace fs = std::filesystem;
using namespace bodeflow::trust;
using bodeflow::test::content;
using bodeflow::test::kDay;
using bodeflow::test::must;
using bodeflow::test::put;

const Time kNow = std::chrono::system_clock::from_time_t(1800000000);  // 2027-01-15

/// A lab with the hosts bench and motor.
struct Made {
  bodeflow::test::TrustFolder folder;
  Files lab{folder.path() / "lab"};

  Made() {
    must(init(lab.folder, {"motion", 3650}, kNow));
    must(add(lab.folder, host("bench"), kNow));
    must(add(lab.folder, host("motor"), kNow));
  }
  NewHost host(const std::string& name) const {
    NewHost host;
    host.name = name;
    host.bundle = folder.path() / (name + ".tar");
    return host;
  }
  fs::path path(const std::string& name) const { return folder.path() / name; }
  std::string problem(const std::string& host = "bench", Time now = kNow) const {
    const auto security = security_of(lab.folder, host, now);
    return security ? "" : security.error();
  }
};

std::string in(const fs::path& path, const std::string& what) { return "'" + path.string() + "': " + what; }

bool begins(const std::string& text, const std::string& with) { return text.compare(0, with.size(), with) == 0; }

}  // namespace

TEST_CASE("what a host joins with is its own files and those of the lab") {
  const Made made;
  const auto security = must(security_of(made.lab.folder, "motor", kNow));
  REQUIRE(security);
  CHECK(security->authority == made.lab.folder / "authority.pem");
  CHECK(security->certificate == made.lab.folder / "hosts/motor/certificate.pem");
  CHECK(security->key == made.lab.folder / "hosts/motor/key.pem");
  CHECK(security->governance == made.lab.folder / "governance.p7s");
  CHECK(security->permissions == made.lab.folder / "hosts/motor/permissions.p7s");
  CHECK(security->revocations == made.lab.folder / "revoked.pem");
}

TEST_CASE("without a folder of trust or with an empty one there is no security") {
  const bodeflow::test::TrustFolder folder;
  CHECK_FALSE(must(security_of(folder.path(), "bench", kNow)));
  CHECK_FALSE(must(security_of(folder.path() / "none", "bench", kNow)));
  CHECK_FALSE(must(security_of("", "bench", kNow)));
}

TEST_CASE("a folder of trust that is not whole is refused rather than taken for no security") {
  const Made made;
  for (const fs::path& path : {made.lab.authority, made.lab.governance, made.lab.revocations, made.lab.certificate("bench"),
                               made.lab.key("bench"), made.lab.permissions("bench")}) {
    const std::string kept = content(path);
    fs::remove(path);
    CHECK(made.problem() == in(path, "is missing; unpack the host's bundle again"));
    put(path, kept);
    fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  }
  CHECK(made.problem().empty());
  CHECK(made.problem("desk") == "'" + made.lab.folder.string() +
                                    "' has no certificate of host 'desk', but of: bench, motor; 'bodeflow trust add desk' "
                                    "makes one");
  CHECK(made.problem("../bench") == "host name '../bench': expected 1 to 64 letters, digits, _ and -, no - first");
}

TEST_CASE("a certificate is refused outside of its time with that time") {
  const Made made;
  const fs::path certificate = made.lab.certificate("bench");
  CHECK(made.problem("bench", kNow + 730 * kDay - std::chrono::seconds(1)).empty());
  CHECK(made.problem("bench", kNow + 730 * kDay) == in(certificate, "expired on 2029-01-14T08:00:00Z"));
  CHECK(made.problem("bench", kNow - std::chrono::hours(23)).empty());  // clocks of a lab differ
  CHECK(
      made.problem("bench", kNow - std::chrono::hours(25)) ==
      in(made.lab.authority, "valid from 2027-01-14T08:00:00Z, and it is 2027-01-14T07:00:00Z: is this machine's clock right?"));
}

TEST_CASE("files of another authority are refused although it has the same name") {
  const Made made, other;
  const std::string kAnother = "it is of another authority than authority.pem";
  const auto with = [&](const fs::path& to, const fs::path& from) {
    const std::string kept = content(to);
    put(to, content(from));
    const std::string problem = made.problem();
    put(to, kept);
    return problem;
  };
  CHECK(begins(with(made.lab.certificate("bench"), other.lab.certificate("bench")), in(made.lab.certificate("bench"), kAnother)));
  CHECK(begins(with(made.lab.revocations, other.lab.revocations), in(made.lab.revocations, kAnother)));
  const std::string kUnsigned = "it was changed, or the lab's authority did not sign it";
  CHECK(begins(with(made.lab.governance, other.lab.governance), in(made.lab.governance, kUnsigned)));
  CHECK(
      begins(with(made.lab.permissions("bench"), other.lab.permissions("bench")), in(made.lab.permissions("bench"), kUnsigned)));
  CHECK(begins(with(made.lab.key("bench"), other.lab.key("bench")),
               in(made.lab.key("bench"), "it is not the key of certificate.pem")));
  CHECK(with(made.lab.certificate("bench"), made.lab.certificate("motor")) ==
        in(made.lab.certificate("bench"), "it is the certificate of 'motor', not of 'bench'"));
  CHECK(with(made.lab.permissions("bench"), made.lab.permissions("motor")) ==
        in(made.lab.permissions("bench"), "it grants nothing to 'CN=bench,O=motion'"));
  CHECK(made.problem().empty());
}

TEST_CASE("a key that others can read is refused") {
  const Made made;
  ::chmod(made.lab.key("bench").c_str(), 0640);
  CHECK(made.problem() == in(made.lab.key("bench"), "others can read this key (mode 0640); chmod 600 it"));
}

TEST_CASE("files that are no certificates or documents are refused by name") {
  const Made made;
  for (const fs::path& path : {made.lab.authority, made.lab.governance, made.lab.revocations, made.lab.certificate("bench"),
                               made.lab.key("bench"), made.lab.permissions("bench")})
    for (const std::string& text :
         {std::string(), std::string("nothing\n"), content(path).substr(0, 200), std::string(5000, '\0')}) {
      const std::string kept = content(path);
      put(path, text);
      CHECK(begins(made.problem(), "'" + path.string() + "': "));
      put(path, kept);
    }
  CHECK(made.problem().empty());
}

TEST_CASE("a document changed by one letter is refused") {
  const Made made;
  for (const fs::path& path : {made.lab.governance, made.lab.permissions("bench")}) {
    const std::string kept = content(path);
    std::string changed = kept;
    changed.replace(changed.find("<dds>") + 1, 3, "ddt");
    put(path, changed);
    CHECK(begins(made.problem(), in(path, "it was changed, or the lab's authority did not sign it")));
    put(path, kept);
  }
}

TEST_CASE("a host's key signs no permissions") {
  const Made made;
  const auto authority = must(read_certificate(content(made.lab.authority)));
  const auto host = must(read_certificate(content(made.lab.certificate("bench"))));
  const auto key = must(read_key(content(made.lab.key("bench"))));
  const std::string all = permissions_text("bench", "motion", {"*"}, kNow - kDay, kNow + kDay);
  put(made.lab.permissions("bench"), must(signed_text(all, *host, *key)));
  CHECK(begins(made.problem(), in(made.lab.permissions("bench"), "it was changed, or the lab's authority did not sign it")));
}

TEST_CASE("a revoked host is refused by the new list and keeps its place on all later ones") {
  const Made made;
  const std::string first = content(made.lab.revocations);
  CHECK(must(revoke(made.lab.folder, "bench", kNow)).revoked);
  const std::string second = content(made.lab.revocations);
  CHECK(made.problem() == in(made.lab.revocations, "the certificate of host 'bench' is revoked"));
  CHECK(made.problem("motor").empty());
  must(revoke(made.lab.folder, "motor", kNow));
  CHECK(made.problem() == in(made.lab.revocations, "the certificate of host 'bench' is revoked"));
  CHECK(made.problem("motor") == in(made.lab.revocations, "the certificate of host 'motor' is revoked"));
  CHECK(revoke(made.lab.folder, "motor", kNow).error() == "host 'motor' is revoked already");

  // an earlier list takes nothing back, a later one comes in place of the present
  CHECK_FALSE(must(take_revocations(made.lab.folder, second)));
  CHECK_FALSE(made.problem("motor").empty());
  put(made.lab.revocations, first);
  CHECK(must(take_revocations(made.lab.folder, second)));
  CHECK_FALSE(made.problem().empty());
  CHECK(made.problem("motor").empty());
  const Made other;
  must(revoke(other.lab.folder, "bench", kNow));
  must(revoke(other.lab.folder, "motor", kNow));
  CHECK(begins(take_revocations(made.lab.folder, content(other.lab.revocations)).error(),
               "the list of revoked certificates is not of the lab's authority"));
  CHECK(content(made.lab.revocations) == second);
}

TEST_CASE("a list of revoked certificates from the future is refused with its time") {
  const Made made;
  must(revoke(made.lab.folder, "bench", kNow + 10 * kDay));
  CHECK(made.problem("motor") ==
        in(made.lab.revocations,
           "valid from 2027-01-24T08:00:00Z, and it is 2027-01-15T08:00:00Z: is this machine's clock right?"));
}

TEST_CASE("a host gets another certificate only when the last one is revoked or expired") {
  const Made made;
  NewHost again = made.host("bench");
  again.bundle = made.path("again.tar");
  CHECK(add(made.lab.folder, again, kNow).error() ==
        "host 'bench' has a certificate until 2029-01-14T08:00:00Z; 'bodeflow trust revoke bench' comes before another one");
  CHECK_FALSE(fs::exists(again.bundle));
  const std::string before = list(made.lab.folder)->hosts[0].fingerprint, old = content(made.lab.certificate("bench"));

  must(revoke(made.lab.folder, "bench", kNow));
  CHECK(must(add(made.lab.folder, again, kNow)).fingerprint != before);
  CHECK(made.problem().empty());
  put(made.lab.certificate("bench"), old);  // the first one stays revoked
  CHECK_FALSE(made.problem().empty());

  NewHost later = made.host("motor");
  later.bundle = made.path("later.tar");
  CHECK(add(made.lab.folder, later, kNow + 731 * kDay));
  CHECK(made.problem("motor", kNow + 731 * kDay).empty());
}

TEST_CASE("a host is trusted at most as long as the authority") {
  const Made made;
  NewHost host = made.host("desk");
  host.days = 36500;
  CHECK(must(add(made.lab.folder, host, kNow)).until == kNow + 3650 * kDay);
  host.name = "late";
  host.bundle = made.path("late.tar");
  CHECK(add(made.lab.folder, host, kNow + 3650 * kDay).error() == "the lab's authority expired on 2037-01-12T08:00:00Z");
}

TEST_CASE("permissions that would not fit into a datagram of the handshake are refused") {
  const Made made;
  NewHost host = made.host(std::string(64, 'h'));
  host.topics.assign(20, "bodeflow/speed_*");
  CHECK(add(made.lab.folder, host, kNow));
  host.name = "desk";
  host.topics.assign(60, "bodeflow/speed_*");
  host.bundle = made.path("desk.tar");
  const std::string why = add(made.lab.folder, host, kNow).error();
  CHECK(begins(why, "the permissions of host 'desk' have "));
  CHECK(why.find(" bytes, 4096 are allowed: give fewer or shorter topics") != std::string::npos);
}

TEST_CASE("names and patterns that could mean something to a document or a folder are refused") {
  for (const char* name : {"", "a b", "a/b", "..", ".", "a,b", "a=b", "<a>", "a&b", "-a", "a.b", "a\n", "\xc3\xa4"})
    CHECK_FALSE(name_problem(name).empty());
  CHECK_FALSE(name_problem(std::string(65, 'a')).empty());
  for (const std::string& name : {std::string("bench-2_B"), std::string("2"), std::string(64, 'a')})
    CHECK(name_problem(name).empty());
  for (const char* pattern : {"", "<topic>", "a&b", "[a]", "a b", "a\\"}) CHECK_FALSE(topic_problem(pattern).empty());
  for (const char* pattern : {"bodeflow/*", "rt/a_b?", "*"}) CHECK(topic_problem(pattern).empty());
}

TEST_CASE("what fails half way leaves nothing behind") {
  const Made made;
  NewHost host = made.host("desk");
  host.bundle = made.path("none/desk.tar");
  CHECK(begins(add(made.lab.folder, host, kNow).error(), "'" + host.bundle.string() + "': "));
  CHECK_FALSE(fs::exists(made.lab.hosts / "desk"));
  put(made.path("file"), "");
  CHECK_FALSE(init(made.path("file") / "lab", {}, kNow));
  CHECK(content(made.path("file")).empty());
  for (const auto& entry : fs::recursive_directory_iterator(made.folder.path()))
    CHECK(entry.path().filename().string().front() != '.');
}

TEST_CASE("the folder of trust comes from the environment") {
  const auto with = [](const char* own, const char* config, const char* home) {
    for (const auto& [name, value] : {std::pair{"BODEFLOW_TRUST", own}, {"XDG_CONFIG_HOME", config}, {"HOME", home}})
      value == nullptr ? ::unsetenv(name) : ::setenv(name, value, 1);
    return default_folder();
  };
  const auto now = [](const char* name) { return std::getenv(name) == nullptr ? std::string() : std::string(std::getenv(name)); };
  const std::string own = now("BODEFLOW_TRUST"), config = now("XDG_CONFIG_HOME"), home = now("HOME");
  CHECK(with("/a", "/b", "/c") == "/a");
  CHECK(with(nullptr, "/b", "/c") == "/b/bodeflow/trust");
  CHECK(with("", "relative", "/c") == "/c/.config/bodeflow/trust");
  CHECK(with(nullptr, nullptr, nullptr).empty());
  with(own.c_str(), config.c_str(), home.c_str());
}
