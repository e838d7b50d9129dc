#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plugins/instance.hpp"

namespace bodeflow::record {

/// Whose data it is; `repeat` counts from 0.
struct Origin {
  std::string phase;
  int repeat = 0;
  std::string block;
  std::string port;
};

/// "<phase>.<block>.<port>", "<phase>@2.<block>.<port>" in its second repetition, "<block>.<port>" for a phase without a name.
std::string key_of(const Origin& origin);

struct StreamTarget {
  Origin origin;
  StreamFacts facts;
};

struct TimedRecord {
  SharedRecord record;
  double time_s = 0.0;
};

/// Writes data.h5: /streams/[phase/]block.port (samples x channels) and /records/[phase/]block.port/{bytes, index}.
///
/// While a phase runs the file is in HDF5's single-writer-multiple-reader mode: after each `flush` it is whole for readers,
/// and stays so when the process is killed. Between phases datasets are added in a way that keeps the old file until the
/// end (see set_deferred_driver). One thread at a time.
class DataWriter {
 public:
  /// How many records of a port, and how many bytes of them, are also written as groups with one dataset an array.
  static constexpr std::uint64_t kDecodedRecords = 1000;
  static constexpr std::uint64_t kDecodedBytes = std::uint64_t{256} << 20U;

  using Result = tl::expected<void, std::string>;

  /// A new file; one that exists is refused. Error: why not, with the path.
  static tl::expected<std::unique_ptr<DataWriter>, std::string> create(const std::filesystem::path& path);
  ~DataWriter();

  /// Makes the datasets of a phase and opens them for appending.
  Result begin(const std::vector<StreamTarget>& streams, const std::vector<Origin>& records);
  /// Appends `count` rows of one sample a channel to the stream of that index in `begin`.
  Result append_samples(std::size_t stream, const void* rows, std::uint64_t count);
  /// Appends records to the message output of that index in `begin`.
  Result append_records(std::size_t port, std::span<const TimedRecord> records);
  /// Makes all that was appended readable for others, also after a kill.
  Result flush();
  /// Ends the phase. `decode`: writes the last records of each port as /records/[phase/]block.port/<n>/ with their arrays and
  /// attributes.
  Result end(bool decode);

 private:
  DataWriter();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bodeflow::record
