// `bodeflow trust` as users type it; what it makes is checked by the program openssl.
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

namespace {

namespace fs = std::filesystem;
using bodeflow::test::Ended;
using bodeflow::test::Folder;
using Words = std::vector<std::string>;

/// A folder in which commands run, with a lab in `lab`.
struct Lab {
  Folder folder;

  explicit Lab(const std::string& name = "motion") { REQUIRE(trust({"init", "--lab", name}).exit_code == 0); }
  Ended trust(const Words& words) const {
    Words all{"trust"};
    all.insert(all.end(), words.begin(), words.end());
    return bodeflow::test::run_bodeflow(all, folder.path(), {"BODEFLOW_TRUST=" + (folder.path() / "lab").string()});
  }
  nlohmann::json json(Words words) const {
    words.emplace_back("--json");
    const Ended ended = trust(words);
    CAPTURE(ended.err);
    REQUIRE(ended.exit_code == 0);
    return nlohmann::json::parse(ended.out);
  }
  std::string openssl(const Words& words, int exit_code = 0) const {
    Words all{"openssl"};
    all.insert(all.end(), words.begin(), words.end());
    const Ended ended = bodeflow::test::run_program(all, folder.path());
    CAPTURE(words, ended.out, ended.err);
    REQUIRE(ended.exit_code == exit_code);
    return ended.out + ended.err;
  }
};

unsigned mode(const fs::path& path) {
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  return status.st_mode & 0777U;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string kBench = "lab/hosts/bench/";

}  // namespace

TEST_CASE("trust add: openssl verifies the host's certificate against the authority") {
  const Lab lab;
  REQUIRE(lab.trust({"add", "bench", "--days", "30"}).exit_code == 0);
  CHECK(lab.openssl({"verify", "-CAfile", "lab/authority.pem", "-x509_strict", kBench + "certificate.pem"}) ==
        kBench + "certificate.pem: OK\n");
  lab.openssl({"verify", "-CAfile", "lab/authority.pem", "-purpose", "smimesign", kBench + "certificate.pem"}, 2);
  const std::string text = lab.openssl({"x509", "-in", kBench + "certificate.pem", "-noout", "-text", "-nameopt", "RFC2253"});
  CHECK(has(text, "Subject: CN=bench,O=motion\n"));
  CHECK(has(text, "Issuer: CN=bodeflow authority,O=motion\n"));
  CHECK(has(text, "ASN1 OID: prime256v1"));
  CHECK(has(text, "Signature Algorithm: ecdsa-with-SHA256"));
  CHECK(has(text, "CA:FALSE"));
  lab.openssl({"x509", "-in", kBench + "certificate.pem", "-noout", "-checkend", std::to_string(30 * 86400 - 600)});
  lab.openssl({"x509", "-in", kBench + "certificate.pem", "-noout", "-checkend", std::to_string(30 * 86400 + 600)}, 1);
  const std::string authority = lab.openssl({"x509", "-in", "lab/authority.pem", "-noout", "-text"});
  CHECK(has(authority, "CA:TRUE, pathlen:0"));
  CHECK(has(authority, "Digital Signature, Certificate Sign, CRL Sign"));
}

TEST_CASE("trust add: openssl verifies the documents which name the host and its topics") {
  const Lab lab;
  REQUIRE(lab.trust({"add", "bench", "--topic", "bodeflow/*", "--topic", "rt/speed"}).exit_code == 0);
  const auto content = [&](const std::string& file) {
    return lab.openssl({"smime", "-verify", "-text", "-in", file, "-CAfile", "lab/authority.pem"});
  };
  const std::string permissions = content(kBench + "permissions.p7s");
  CHECK(has(permissions, "<subject_name>CN=bench,O=motion</subject_name>"));
  CHECK(has(permissions, "<topic>bodeflow/*</topic>"));
  CHECK(has(permissions, "<topic>rt/speed</topic>"));
  CHECK(has(permissions, "<default>DENY</default>"));
  const std::string governance = content("lab/governance.p7s");
  CHECK(has(governance, "<allow_unauthenticated_participants>false<"));
  CHECK(has(governance, "<enable_join_access_control>true<"));
  CHECK(has(governance, "<data_protection_kind>ENCRYPT<"));
}

TEST_CASE("trust revoke: openssl refuses the revoked certificate by the list and no other") {
  const Lab lab;
  for (const char* host : {"bench", "motor"}) REQUIRE(lab.trust({"add", host}).exit_code == 0);
  const auto verified = [&](const std::string& host, int exit_code) {
    return lab.openssl({"verify", "-CAfile", "lab/authority.pem", "-CRLfile", "lab/revoked.pem", "-crl_check",
                        "lab/hosts/" + host + "/certificate.pem"},
                       exit_code);
  };
  verified("bench", 0);
  const Ended ended = lab.trust({"revoke", "bench"});
  CHECK(ended.exit_code == 0);
  CHECK(has(ended.out, "restart their agents"));
  CHECK(has(verified("bench", 2), "certificate revoked"));
  verified("motor", 0);
  CHECK(has(lab.openssl({"crl", "-in", "lab/revoked.pem", "-CAfile", "lab/authority.pem", "-noout"}), "verify OK"));

  const Ended again = lab.trust({"revoke", "bench"});
  CHECK(again.exit_code == 1);
  CHECK(again.err == "error: host 'bench' is revoked already\n");
  const Ended nobody = lab.trust({"revoke", "desk"});
  CHECK(nobody.exit_code == 1);
  CHECK(nobody.err == "error: there is no host 'desk'; 'bodeflow trust list' shows them\n");
}

TEST_CASE("trust list: prints who is trusted until when as a table and as JSON") {
  const Lab lab;
  const auto added = lab.json({"add", "bench", "--days", "10"});
  REQUIRE(lab.trust({"add", "motor"}).exit_code == 0);
  REQUIRE(lab.trust({"revoke", "motor"}).exit_code == 0);
  const auto listed = lab.json({"list"});
  CHECK(listed["lab"] == "motion");
  CHECK(listed["authority"]["key"] == true);
  REQUIRE(listed["hosts"].size() == 2);
  const auto &bench = listed["hosts"][0], &motor = listed["hosts"][1];
  CHECK(bench["host"] == "bench");
  CHECK(bench["state"] == "valid");
  CHECK(bench["topics"] == nlohmann::json{"bodeflow/*"});
  CHECK(bench["fingerprint"] == added["fingerprint"]);
  CHECK(motor["state"] == "revoked");
  const std::string fingerprint = lab.openssl({"x509", "-in", kBench + "certificate.pem", "-noout", "-fingerprint", "-sha256"});
  CHECK(fingerprint == "sha256 Fingerprint=" + bench["fingerprint"].get<std::string>() + "\n");

  const std::string table = lab.trust({"list"}).out;
  CHECK(has(table, "Lab 'motion' in " + (lab.folder.path() / "lab").string() + "\n"));
  CHECK(has(table, "bench                valid    until " + bench["valid_until"].get<std::string>()));
  CHECK(has(table, "motor                revoked  until "));
  CHECK(has(table, bench["fingerprint"].get<std::string>()));
}

TEST_CASE("trust add: the archive is unpacked to a folder of trust for that host alone") {
  const Lab lab;
  for (const char* host : {"bench", "motor"}) REQUIRE(lab.trust({"add", host}).exit_code == 0);
  CHECK(mode(lab.folder.path() / "bench.tar") == 0600);
  fs::create_directory(lab.folder.path() / "there");
  const Ended unpacked = bodeflow::test::run_program({"tar", "-xf", "bench.tar", "-C", "there"}, lab.folder.path());
  CHECK(unpacked.exit_code == 0);
  CHECK(unpacked.err.empty());
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(lab.folder.path() / "there"))
    if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), lab.folder.path() / "there").string());
  std::sort(files.begin(), files.end());
  CHECK(files == Words{"authority.pem", "governance.p7s", "hosts/bench/certificate.pem", "hosts/bench/key.pem",
                       "hosts/bench/permissions.p7s", "revoked.pem"});
  for (const std::string& file : files) CHECK(lab.folder.read("there/" + file) == lab.folder.read("lab/" + file));
  CHECK(mode(lab.folder.path() / "there/hosts/bench/key.pem") == 0600);

  const auto listed = lab.json({"list", "--dir", "there"});
  CHECK(listed["hosts"].size() == 1);
  CHECK(listed["authority"]["key"] == false);
  const Ended added = lab.trust({"add", "desk", "--dir", "there"});
  CHECK(added.exit_code == 1);
  CHECK(has(added.err,
            "has no key of the authority: hosts are added and revoked on the machine where 'bodeflow trust init' was run"));
}

TEST_CASE("trust: keys are for their owner only") {
  const Lab lab;
  REQUIRE(lab.trust({"add", "bench"}).exit_code == 0);
  CHECK(mode(lab.folder.path() / "lab") == 0700);
  CHECK(mode(lab.folder.path() / "lab/authority.key") == 0600);
  CHECK(mode(lab.folder.path() / kBench / "key.pem") == 0600);
}

TEST_CASE("trust: nothing that exists is overwritten") {
  const Lab lab;
  const std::string authority = lab.folder.read("lab/authority.pem");
  const Ended made = lab.trust({"init"});
  CHECK(made.exit_code == 1);
  CHECK(made.err == "error: '" + (lab.folder.path() / "lab").string() + "' exists already and is not empty\n");
  CHECK(lab.folder.read("lab/authority.pem") == authority);

  lab.folder.write("bench.tar", "mine");
  const Ended added = lab.trust({"add", "bench"});
  CHECK(added.exit_code == 1);
  CHECK(added.err == "error: 'bench.tar' exists already\n");
  CHECK(lab.folder.read("bench.tar") == "mine");
  CHECK_FALSE(fs::exists(lab.folder.path() / kBench));

  REQUIRE(lab.trust({"add", "bench", "--out", "first.tar"}).exit_code == 0);
  const Ended again = lab.trust({"add", "bench", "--out", "second.tar"});
  CHECK(again.exit_code == 1);
  CHECK(has(again.err, "'bodeflow trust revoke bench' comes before another one"));
  CHECK_FALSE(fs::exists(lab.folder.path() / "second.tar"));
}

TEST_CASE("trust: bad names and numbers are usage errors that make nothing") {
  const Lab lab;
  for (const char* name : {"a b", "../bench", "a,O=lab", "<a>"}) {
    const Ended ended = lab.trust({"add", name});
    CHECK(ended.exit_code == 2);
    CHECK(ended.err == "error: host name '" + std::string(name) + "': expected 1 to 64 letters, digits, _ and -, no - first\n");
  }
  CHECK(lab.trust({"add", "bench", "--days", "0"}).exit_code == 2);
  CHECK(lab.trust({"add", "bench", "--topic", "<a>"}).exit_code == 2);
  CHECK(lab.trust({"add"}).exit_code == 2);
  CHECK(lab.trust({}).exit_code == 2);
  CHECK(lab.trust({"init", "--lab", "our lab", "--dir", "other"}).exit_code == 2);
  CHECK_FALSE(fs::exists(lab.folder.path() / "other"));
  CHECK_FALSE(fs::exists(lab.folder.path() / "lab/hosts"));
}

TEST_CASE("trust: what needs an authority tells how to make one") {
  const Folder folder;
  for (const Words& words : {Words{"list"}, Words{"add", "bench"}, Words{"revoke", "bench"}}) {
    Words all{"trust"};
    all.insert(all.end(), words.begin(), words.end());
    const Ended ended = bodeflow::test::run_bodeflow(all, folder.path(), {"BODEFLOW_TRUST=" + folder.path().string()});
    CHECK(ended.exit_code == 1);
    CHECK(ended.err == "error: '" + folder.path().string() + "' has no authority: begin with 'bodeflow trust init'\n");
  }
}
