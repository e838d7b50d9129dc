#pragma once

#include <string_view>

namespace bodeflow::tools::exports {

/// The shared library that plays any linear system of an FMU, as it was built with bodeflow for this platform.
std::string_view fmu_library();
/// Its C source.
std::string_view fmu_source();
/// The platform's folder in an FMU, such as linux64.
const char* fmu_platform();

}  // namespace bodeflow::tools::exports
