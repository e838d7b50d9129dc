# bodeflow_plugin(FAMILY sources...): a plugin of our own, built as a third party builds one: hidden symbols, the SDK alone
# on its include path (and numerics, Eigen where it asks for them with target_link_libraries).
function(bodeflow_plugin family)
  add_library(bodeflow_${family} MODULE ${ARGN})
  target_link_libraries(bodeflow_${family} PRIVATE bodeflow::sdk)
  set_target_properties(bodeflow_${family} PROPERTIES PREFIX "" OUTPUT_NAME ${family} CXX_VISIBILITY_PRESET hidden
                        VISIBILITY_INLINES_HIDDEN ON LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/plugins)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(bodeflow_${family} PRIVATE -fno-gnu-unique)
  endif()
  set_property(GLOBAL APPEND PROPERTY BODEFLOW_PLUGINS bodeflow_${family})
  install(TARGETS bodeflow_${family} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/bodeflow/plugins)
endfunction()
