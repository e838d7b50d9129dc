#include "record/join.hpp"

#include "record/data_file.hpp"

namespace bodeflow::record {
namespace {

namespace fs = std::filesystem;
using Done = tl::expected<void, std::string>;

/// Values, and records, that are in memory at once.
constexpr std::uint64_t kValues = std::uint64_t{1} << 20, kRecords = 256;

StreamFacts facts_of(const StoredStream& stream) {
  StreamFacts facts;
  facts.known = true;
  facts.element = stream.element;
  facts.channels = stream.channels;
  facts.rate = stream.rate;
  facts.length = static_cast<std::int64_t>(stream.length);
  facts.unit = stream.unit;
  facts.clock = stream.clock;
  facts.channel_names = stream.channel_names;
  facts.channel_units = stream.channel_units;
  return facts;
}

Done copy(const DataFile& from, const StoredStream& stream, DataWriter& to, std::size_t index) {
  const std::uint64_t rows = std::max<std::uint64_t>(1, kValues / stream.channels);
  for (std::uint64_t first = 0; first < stream.length; first += rows) {
    const std::uint64_t count = std::min(rows, stream.length - first);
    const auto values = from.read(stream, first, count);
    if (!values) return tl::unexpected(values.error());
    if (auto done = to.append_samples(index, values->data(), count); !done) return done;
  }
  return {};
}

Done copy(const DataFile& from, const StoredRecords& records, DataWriter& to, std::size_t index) {
  for (std::uint64_t first = 0; first < records.count; first += kRecords) {
    const auto some = from.read(records, first, std::min(kRecords, records.count - first));
    if (!some) return tl::unexpected(some.error());
    if (auto done = to.append_records(index, *some); !done) return done;
  }
  return {};
}

/// What one file gives, and where it stands in the joined one.
template <class Stored>
struct Piece {
  const DataFile* file;
  const Stored* stored;
};

template <class Stored>
Done copy_all(const std::vector<Piece<Stored>>& pieces, DataWriter& to) {
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (auto done = copy(*pieces[i].file, *pieces[i].stored, to, i); !done) return done;
  return {};
}

}  // namespace

Done join_data(const std::vector<fs::path>& files, const fs::path& into,
               const std::function<bool(const std::string& block)>& keep) {
  std::vector<std::unique_ptr<DataFile>> open;
  std::vector<Piece<StoredStream>> streams;
  std::vector<Piece<StoredRecords>> records;
  std::vector<StreamTarget> targets;
  std::vector<Origin> ports;
  for (const fs::path& path : files) {
    auto file = DataFile::open(path);
    if (!file) return tl::unexpected(file.error());
    open.push_back(std::move(*file));
    for (const StoredStream& stream : open.back()->streams()) {
      if (!keep(stream.origin.block)) continue;
      streams.push_back({open.back().get(), &stream});
      targets.push_back({stream.origin, facts_of(stream)});
    }
    for (const StoredRecords& stored : open.back()->records()) {
      if (!keep(stored.origin.block)) continue;
      records.push_back({open.back().get(), &stored});
      ports.push_back(stored.origin);
    }
  }
  auto writer = DataWriter::create(into);
  if (!writer) return tl::unexpected(writer.error());
  Done done = (*writer)->begin(targets, ports);
  if (done) done = copy_all(streams, **writer);
  if (done) done = copy_all(records, **writer);
  if (done) done = (*writer)->end(true);
  return done;
}

}  // namespace bodeflow::record
