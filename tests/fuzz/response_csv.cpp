// The reader of frequency responses in CSV on arbitrary bytes.
#include "acquisition/response_csv.hpp"

#include "response.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const std::vector<std::string>& wanted : {std::vector<std::string>{}, {"G"}}) {
    bodeflow::fuzz::read_response_text(data, size,
                                       [&](auto& source) { return bodeflow::acquisition::read_response_csv(source, wanted); });
  }
  return 0;
}
