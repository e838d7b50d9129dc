#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "plugins/instance.hpp"
#include "plugins/registry.hpp"

namespace bodeflow::test {

inline std::filesystem::path fixture(const std::string& name) {
  return std::filesystem::path(BODEFLOW_FIXTURES) / (name + ".so");
}

/// A folder of a test's own, gone with it.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "bodeflow-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write(const std::filesystem::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

inline Registry::Options options(std::vector<std::filesystem::path> path) {
  Registry::Options made;
  made.path = std::move(path);
  made.probe_command = BODEFLOW_PROBE_HELPER;
  return made;
}

/// The default values of a block's parameters, as a graph that sets none would give them.
inline std::vector<ParameterValue> defaults(const BlockDescription& block) {
  std::vector<ParameterValue> values;
  for (const ParameterDescription& p : block.parameters) values.push_back(p.fallback);
  return values;
}

inline StreamFacts real_stream(std::uint32_t channels) {
  StreamFacts facts;
  facts.known = true;
  facts.channels = channels;
  facts.rate = Rate(1000, 1);
  facts.unit = "V";
  return facts;
}

/// One process call of a block on planar samples, as the executor makes it.
class Call {
 public:
  Call(const Instance& instance, std::vector<std::vector<double>> input, std::size_t output_channels)
      : input_(std::move(input)), output_(output_channels, std::vector<double>(input_.empty() ? kSource : input_[0].size())) {
    for (auto& channel : input_) in_places_.push_back(channel.data());
    for (auto& channel : output_) out_places_.push_back(channel.data());
    const std::uint64_t count = output_.empty() ? 0 : output_[0].size();
    const bf_stream in{in_places_.data(), 0, count, static_cast<std::uint32_t>(in_places_.size()), BF_F64};
    const bf_stream out{out_places_.data(), 0, count, static_cast<std::uint32_t>(out_places_.size()), BF_F64};
    bf_process process{sizeof(bf_process), 0, nullptr, &in, &out, 0, count, count, this, &Call::emit};
    result = instance.c().process(instance.c().self, &process);
  }

  static constexpr std::size_t kSource = 4;  ///< samples of a block without input
  std::int32_t result = BF_FAILED;
  const std::vector<double>& output(std::size_t channel) const { return output_[channel]; }
  std::vector<SharedRecord> records;

 private:
  static void emit(bf_process* process, std::uint32_t, bf_record* record, std::uint64_t) {
    static_cast<Call*>(process->context)->records.push_back(SharedRecord::adopt(record));
  }

  std::vector<std::vector<double>> input_, output_;
  std::vector<void*> in_places_, out_places_;
};

}  // namespace bodeflow::test
