# Plugins for tests, each a shared library of its own below fixtures/ of the build folder.
set(fixtures "")
function(plugin_fixture name source)
  add_library(fixture_${name} MODULE fixtures/${source})
  target_link_libraries(fixture_${name} PRIVATE bodeflow::sdk)
  target_compile_definitions(fixture_${name} PRIVATE ${ARGN})
  target_compile_options(fixture_${name} PRIVATE $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-fno-gnu-unique>)
  set_target_properties(fixture_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden
                        VISIBILITY_INLINES_HIDDEN ON LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/fixtures)
  list(APPEND fixtures fixture_${name})
  set(fixtures ${fixtures} PARENT_SCOPE)
endfunction()

plugin_fixture(good good.cpp)
plugin_fixture(plain plain.c)
plugin_fixture(twin_one twin.cpp TWIN="twin_one" START=0.0)
plugin_fixture(twin_two twin.cpp TWIN="twin_two" START=0.5)
plugin_fixture(throws_in_static throws_in_static.cpp)
plugin_fixture(parts parts.cpp)
plugin_fixture(only_effect only_effect.cpp EFFECT_ID="lone.offset")
plugin_fixture(same_effect only_effect.cpp EFFECT_ID="lone.offset")
plugin_fixture(like_a_block only_effect.cpp EFFECT_ID="parts.asker")
foreach(way PLAIN REFUSES UNKNOWN_ACTS HUGE_MEMORY NO_KIND NULL_KINDS TWICE BASE UNKNOWN_KIND)
  string(TOLOWER ${way} name)
  plugin_fixture(part_${name} broken_part.c ${way})
endforeach()
plugin_fixture(part_base_with_ports broken_part.c BASE BASE_WITH_PORTS)
plugin_fixture(part_base_without_summary broken_part.c BASE BASE_WITHOUT_SUMMARY)
foreach(way CRASH_IN_CONSTRUCTOR HANG_IN_CONSTRUCTOR EXIT_IN_CONSTRUCTOR NOISE UNDEFINED NULL_PORT_NAME REFUSES REFUSES_SILENTLY NO_PROCESS
        SMALL_BLOCK CRASH_IN_FACTORIES FACTORIES_FAIL NULL_ID OTHER_ID TWICE MANY_PORTS CHANGES NO_SYMBOL WRONG_MAGIC NO_NOTE CRASH_IN_CREATE CRASH_IN_PROCESS)
  string(TOLOWER ${way} name)
  plugin_fixture(${name} broken.c ${way})
endforeach()
plugin_fixture(wrong_abi broken.c MAJOR=2 MINOR=0 CRASH_IN_CONSTRUCTOR)  # refused before it could crash
plugin_fixture(newer_abi broken.c MAJOR=1 MINOR=1 CRASH_IN_CONSTRUCTOR)
plugin_fixture(two_minds_on_abi broken.c SYMBOL_MAJOR=3)
plugin_fixture(duplicate broken.c ID="fixture.gain")
# An undefined symbol in a module is an error at load time only where the linker lets it pass.
target_link_options(fixture_undefined PRIVATE -Wl,-z,undefs)
# Address sanitizers catch the crash that a fixture is for.
foreach(name crash_in_constructor crash_in_factories)
  target_compile_options(fixture_${name} PRIVATE -fno-sanitize=all)
endforeach()

add_custom_command(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/fixtures/stripped.so
  COMMAND ${CMAKE_STRIP} --strip-all -o ${CMAKE_CURRENT_BINARY_DIR}/fixtures/stripped.so $<TARGET_FILE:fixture_good> DEPENDS fixture_good VERBATIM)
add_custom_target(fixture_stripped DEPENDS ${CMAKE_CURRENT_BINARY_DIR}/fixtures/stripped.so)
list(APPEND fixtures fixture_stripped)
