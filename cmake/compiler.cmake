# Flags that hold for every target. Results are repeatable bit for bit: no contraction, no fast-math.
add_compile_options(-Wall -Wextra -Wconversion -Wshadow $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)  # false alarms on std::string (GCC bug 105651)
endif()
if(BODEFLOW_WERROR)
  add_compile_options(-Werror)
endif()
if(BODEFLOW_SANITIZE)
  add_compile_options(-fsanitize=${BODEFLOW_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${BODEFLOW_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-Wno-maybe-uninitialized)  # false alarms on std::function in instrumented code (GCC bug 105562)
  endif()
endif()

# With CMAKE_UNITY_BUILD (`./run` and `./test` set it) eight files of a target are compiled as one, which takes a third of the
# time. Files that can't share one translation unit with their neighbours, such as for names in anonymous namespaces, stand alone.
function(bodeflow_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
