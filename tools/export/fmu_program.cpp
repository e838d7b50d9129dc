#include "export/fmu_program.hpp"

// The files become part of the program by the assembler: nothing has to be found at run time.
#define BODEFLOW_INCLUDE_BYTES(name, path)                                                                                      \
  __asm__(".section .rodata\n.global " name "_begin\n.hidden " name "_begin\n.global " name "_end\n.hidden " name "_end\n" name \
          "_begin:\n.incbin \"" path "\"\n" name "_end:\n.byte 0\n.previous\n")

BODEFLOW_INCLUDE_BYTES("bodeflow_fmu_library", BODEFLOW_FMU_LIBRARY);
BODEFLOW_INCLUDE_BYTES("bodeflow_fmu_source", BODEFLOW_FMU_SOURCE);

extern "C" {
extern const char bodeflow_fmu_library_begin[], bodeflow_fmu_library_end[], bodeflow_fmu_source_begin[],
    bodeflow_fmu_source_end[];
}

namespace bodeflow::tools::exports {

std::string_view fmu_library() {
  return {bodeflow_fmu_library_begin, static_cast<std::size_t>(bodeflow_fmu_library_end - bodeflow_fmu_library_begin)};
}

std::string_view fmu_source() {
  return {bodeflow_fmu_source_begin, static_cast<std::size_t>(bodeflow_fmu_source_end - bodeflow_fmu_source_begin)};
}

const char* fmu_platform() { return sizeof(void*) == 8 ? "linux64" : "linux32"; }

}  // namespace bodeflow::tools::exports
