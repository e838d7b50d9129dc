include(CMakeFindDependencyMacro)
find_dependency(Eigen3 NO_MODULE)
find_dependency(tl-expected)
include(${CMAKE_CURRENT_LIST_DIR}/bodeflow-numerics-targets.cmake)
