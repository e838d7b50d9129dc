#pragma once

#include "record/data_writer.hpp"

namespace bodeflow::record {

/// A recorded stream as data.h5 describes it.
struct StoredStream {
  Origin origin;
  std::string path;  ///< in the file
  std::uint32_t element = BF_F64;
  std::uint32_t channels = 1;
  std::uint64_t length = 0;  ///< samples
  Rate rate;                 ///< hertz
  std::string unit;
  std::string clock;
  std::vector<std::string> channel_names;  ///< one a channel, "" where it has none
  std::vector<std::string> channel_units;
  std::int64_t first_position = 0;  ///< of the first sample, on the stream's own clock
};

/// The records of a message output as data.h5 describes them.
struct StoredRecords {
  Origin origin;
  std::string path;
  std::uint64_t count = 0;
};

/// Reads data.h5: of a finished run, of one that is being written, and of one that was killed. Any thread.
class DataFile {
 public:
  /// Error: why not, with the path.
  static tl::expected<std::unique_ptr<DataFile>, std::string> open(const std::filesystem::path& path);
  ~DataFile();

  /// Streams and message outputs in the order of their names, as they were when the file was opened.
  const std::vector<StoredStream>& streams() const;
  const std::vector<StoredRecords>& records() const;
  /// By key ("phase.block.port", see key_of), or nullptr.
  const StoredStream* stream(const std::string& key) const;
  const StoredRecords* records_of(const std::string& key) const;

  /// Samples first .. first + count, interleaved: count x channels values, for c64 pairs re, im. Error: beyond the end.
  tl::expected<std::vector<double>, std::string> read(const StoredStream& stream, std::uint64_t first, std::uint64_t count) const;
  /// Records first .. first + count. Error: beyond the end, or damaged bytes.
  tl::expected<std::vector<TimedRecord>, std::string> read(const StoredRecords& records, std::uint64_t first,
                                                           std::uint64_t count) const;

 private:
  DataFile();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bodeflow::record
