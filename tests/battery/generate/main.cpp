#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "common/sha256.hpp"
#include "generate/case.hpp"
#include "generate/write.hpp"

/// Writes a battery: cases in DIR/cases, DIR/manifest.json with the digest of every file and of the salted truth, and the truth
/// itself in DIR/sealed.

namespace {

using namespace battery;

const char* const kUsage =
    "battery_generate --seed TEXT --clean N --single N --outside N --out DIR [--plants motor,mechanical] [--only EFFECT,...] "
    "[--threads N]\n";

struct Options {
  std::string seed, out;
  int clean = 0, single = 0, outside = 0, threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<std::string> plants{"motor", "mechanical"}, only;
};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

int count(const std::string& name, const std::string& text) {
  std::size_t used = 0;
  int value = -1;
  try {
    value = std::stoi(text, &used);
  } catch (const std::exception&) {
  }
  if (used != text.size() || value < 0 || value > 9999)
    throw std::invalid_argument(name + " must be a number from 0 to 9999, not '" + text + "'");
  return value;
}

Options read(int argc, char** argv) {
  Options o;
  for (int n = 1; n < argc; n += 2) {
    const std::string name = argv[n];
    if (n + 1 == argc) throw std::invalid_argument("'" + name + "' needs a value");
    const std::string value = argv[n + 1];
    if (name == "--seed")
      o.seed = value;
    else if (name == "--out")
      o.out = value;
    else if (name == "--clean")
      o.clean = count(name, value);
    else if (name == "--single")
      o.single = count(name, value);
    else if (name == "--outside")
      o.outside = count(name, value);
    else if (name == "--threads")
      o.threads = std::max(1, count(name, value));
    else if (name == "--plants")
      o.plants = split(value);
    else if (name == "--only")
      o.only = split(value);
    else
      throw std::invalid_argument("unknown option '" + name + "'");
  }
  if (o.seed.empty() || o.out.empty()) throw std::invalid_argument("--seed and --out are needed");
  if (o.clean + o.single + o.outside == 0) throw std::invalid_argument("no cases: --clean, --single or --outside is needed");
  for (const auto& plant : o.plants) {
    if (plant != "motor" && plant != "mechanical")
      throw std::invalid_argument("unknown plant '" + plant + "'; motor, mechanical");
  }
  return o;
}

/// Effects in turn, each plant's in an order of its own, so that all come equally often.
std::vector<Wish> wishes_of(const Options& o, Random& random) {
  std::vector<Wish> wishes;
  const auto add = [&](Kind kind, int cases) {
    std::vector<std::vector<std::string>> effects;
    for (const auto& plant : o.plants) {
      auto names = effects_of(plant, kind);
      if (!o.only.empty())
        std::erase_if(names, [&](const auto& name) { return std::find(o.only.begin(), o.only.end(), name) == o.only.end(); });
      random.shuffle(names);
      effects.push_back(names);
    }
    std::vector<std::size_t> next(o.plants.size(), 0);
    std::vector<std::size_t> open;
    for (std::size_t p = 0; p < o.plants.size(); ++p) {
      if (kind == Kind::clean || !effects[p].empty()) open.push_back(p);
    }
    if (open.empty() && cases > 0) throw std::invalid_argument("no plant has any of these effects");
    for (int n = 0; n < cases; ++n) {
      const std::size_t p = open[static_cast<std::size_t>(n) % open.size()];
      Wish w{kind, o.plants[p], "", o.seed + "/case/" + std::to_string(wishes.size())};
      if (kind != Kind::clean) w.effect = effects[p][next[p]++ % effects[p].size()];
      wishes.push_back(w);
    }
  };
  add(Kind::clean, o.clean);
  add(Kind::single, o.single);
  add(Kind::outside, o.outside);
  random.shuffle(wishes);
  return wishes;
}

std::string number(std::size_t n) {
  const std::string text = std::to_string(n + 1);
  return std::string(4 - std::min<std::size_t>(4, text.size()), '0') + text;
}

struct Written {
  std::string truth, manifest;
};

Written write_case(const std::filesystem::path& out, const std::string& name, const Wish& wish) {
  const Case c = draw_case(wish);
  const auto folder = out / "cases" / name;
  std::filesystem::create_directories(folder);
  Written w;
  const auto put = [&](const std::string& file, const std::string& bytes) {
    write_file(folder / file, bytes);
    w.manifest += (w.manifest.empty() ? "" : ",\n") + ("  \"" + name + "/" + file) + "\": \"" + sha256_hex(bytes) + "\"";
  };
  put("case.json", case_json(name, c));
  for (const CaseRecord& r : c.records) put(r.name + ".csv", csv_text(c, r));
  w.truth = truth_json(name, c);
  return w;
}

void write_battery(const Options& o) {
  Random random(o.seed + "/battery");
  const auto wishes = wishes_of(o, random);
  const std::filesystem::path out = o.out;
  if (std::filesystem::exists(out / "cases")) throw std::invalid_argument(o.out + " already has cases");
  std::filesystem::create_directories(out / "sealed");
  std::vector<Written> written(wishes.size());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failed;
  const auto work = [&] {
    for (std::size_t n = next++; n < wishes.size(); n = next++) {
      try {
        written[n] = write_case(out, number(n), wishes[n]);
      } catch (...) {
        const std::lock_guard lock(mutex);
        failed = std::current_exception();
        return;
      }
    }
  };
  std::vector<std::thread> threads;
  for (int n = 0; n < o.threads; ++n) threads.emplace_back(work);
  for (auto& thread : threads) thread.join();
  if (failed) std::rethrow_exception(failed);

  std::string truth = "{\"battery\": 1, \"seed\": \"" + o.seed + "\", \"cases\": [\n", files;
  for (std::size_t n = 0; n < written.size(); ++n) {
    truth += (n ? ",\n" : "") + written[n].truth;
    files += (n ? ",\n" : "") + written[n].manifest;
  }
  truth += "]}\n";
  const std::string salt = sha256_hex(o.seed + "/salt");
  write_file(out / "sealed" / "truth.json", truth);
  write_file(out / "sealed" / "salt", salt);
  write_file(out / "manifest.json", "{\"battery\": 1, \"cases\": " + std::to_string(wishes.size()) + ",\n \"truth_sha256\": \"" +
                                        sha256_hex(salt + truth) + "\",\n \"files_sha256\": {\n" + files + "}}\n");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = read(argc, argv);
    if (options.seed.find_first_of("\"\\\n") != std::string::npos)
      throw std::invalid_argument("--seed must not hold quotes, backslashes or line ends");
    write_battery(options);
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "battery_generate: %s\n%s", e.what(), kUsage);
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "battery_generate: %s\n", e.what());
    return 1;
  }
  return 0;
}
