#pragma once

#include "export/model_file.hpp"

namespace bodeflow::tools::exports {

/// A Functional Mock-up Unit for co-simulation, FMI 2.0, as the bytes of its archive: modelDescription.xml, the matrices in
/// resources/system.txt, and the program that plays them, compiled for this platform in binaries/ and as C in sources/.
/// Inputs are held over a communication step, which may have any length: a continuous system is advanced by its exact zero-order
/// hold, a discrete one sample by sample. Errors: a delay, which it does not play.
Result<std::string> fmu_of(const ModelFile& file);

/// A name that FMI and file systems take: letters, digits and underscores, beginning with a letter.
std::string identifier_of(const std::string& name);

}  // namespace bodeflow::tools::exports
