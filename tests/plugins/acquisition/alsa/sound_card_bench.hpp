#pragma once

#include <nlohmann/json.hpp>
#include <sstream>

#include "catch.hpp"
#include "system/command.hpp"

namespace bodeflow::test {

inline const std::string kSoundCardGraphs = BODEFLOW_SOURCE_DIR "/graphs/acquisition/";

/// A folder with an ALSA configuration of one card, `loop`: that of loop_pcm.cpp with the settings that are told there.
class SoundCardBench {
 public:
  explicit SoundCardBench(const std::string& settings) {
    folder.write("asound.conf", "pcm_type.bodeflow_loop { lib \"" BODEFLOW_TEST_SOUND_CARD
                                "\" }\npcm.loop { type bodeflow_loop " +
                                    settings + " }\n");
  }
  Ended run(std::vector<std::string> words) const {
    words.insert(words.begin(), "run");
    std::filesystem::remove_all(folder.path() / "out");
    words.insert(words.end(), {"--out", "out"});
    return run_bodeflow(words, folder.path(), {"ALSA_CONFIG_PATH=" + (folder.path() / "asound.conf").string()});
  }
  /// A graph of ours on the card, with room for a busy machine.
  nlohmann::json measure(const std::string& graph, std::vector<std::string> settings, int skip = 6) const {
    settings.insert(settings.end(), {"device=loop", "blocks.response.skip=" + std::to_string(skip), "blocks.card.buffer=65536",
                                     "blocks.card.lead=24000"});
    std::vector<std::string> words{kSoundCardGraphs + graph};
    for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
    return results(words);
  }
  /// Of a run that must go well.
  nlohmann::json results(const std::vector<std::string>& words) const {
    const Ended ended = run(words);
    INFO(ended.err);
    REQUIRE(ended.exit_code == 0);
    return nlohmann::json::parse(folder.read("out/result.json"))["results"];
  }
  /// The graph of one capture block that records what it gives for `duration`.
  std::string capture(const std::string& parameters, const std::string& duration = "0.5 s",
                      const std::string& clock = "realtime") const {
    return folder
        .write("capture.yaml",
               "bodeflow: 1\nrun: {clock: " + clock + ", chunk: 256, duration: " + duration +
                   "}\nblocks:\n  adc: {block: acquisition.alsa_capture, device: loop, rate: 48 kHz, buffer: 65536, " +
                   parameters +
                   "}\n  file: {block: output.csv, file: x.csv}\n  gaps: {block: output.records, file: gaps.jsonl}\n"
                   "connections:\n  - adc -> file\n  - adc.gaps -> gaps\n")
        .string();
  }

  const Folder folder;
};

/// A column of a CSV text below its header.
inline std::vector<double> column(const std::string& text, std::size_t index) {
  std::vector<double> values;
  std::istringstream rows(text);
  std::string row;
  std::getline(rows, row);
  while (std::getline(rows, row)) {
    std::istringstream fields(row);
    for (std::size_t i = 0; i <= index; ++i) std::getline(fields, row, ',');
    values.push_back(std::stod(row));
  }
  return values;
}

}  // namespace bodeflow::test
