#pragma once

#include <bodeflow/error.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace bodeflow::output {

/// A text file that is written from start to end through a buffer of 64 KiB. Errors name the file and the system's reason.
class TextFile {
 public:
  /// Creates the file, or empties it.
  static Expected<TextFile> create(const std::string& path);

  /// Adds text.
  Expected<void> write(std::string_view text);
  /// Hands what is buffered to the system.
  Expected<void> flush();
  /// Flushes and closes: disks report some errors only here. The destructor closes too, silently.
  Expected<void> close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  Unexpected<Error> refuse(int number) const;

  std::string path_;
  std::string buffer_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Appends the shortest digits that read back as the value: "0.1", "1e-09"; "nan", "inf", "-inf".
void append_number(std::string& text, double value);

/// The same without an exponent: "0.0004", not "4e-04".
void append_decimal(std::string& text, double value);

}  // namespace bodeflow::output
