# SPDX-License-Identifier: GPL-3.0-or-later
# ramify_layer(NAME SOURCES a.cpp b.cpp USES lower_layer … [PUBLIC lib …] [PRIVATE lib …])
# One folder of src/ramify is one static library that names the layers it may use.
# tests/check_layers.py reads the #include lines and the USES lists and fails on any other arrow.
function(ramify_layer name)
  cmake_parse_arguments(L "" "" "SOURCES;USES;PUBLIC;PRIVATE" ${ARGN})
  add_library(ramify_${name} STATIC ${L_SOURCES})
  target_include_directories(ramify_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
  foreach(lower ${L_USES})
    target_link_libraries(ramify_${name} PUBLIC ramify_${lower})
  endforeach()
  target_link_libraries(ramify_${name} PUBLIC ${L_PUBLIC} PRIVATE ${L_PRIVATE})
endfunction()

# ramify_test(NAME SOURCES a_test.cpp … USES layer … [LIBS lib …]): one Catch2 program, one ctest entry a case.
function(ramify_test name)
  cmake_parse_arguments(T "" "" "SOURCES;USES;LIBS" ${ARGN})
  add_executable(${name} ${T_SOURCES})
  foreach(layer ${T_USES})
    target_link_libraries(${name} PRIVATE ramify_${layer})
  endforeach()
  target_link_libraries(${name} PRIVATE ramify_test_main ${T_LIBS})
  catch_discover_tests(${name} TEST_PREFIX "${name}: " PROPERTIES TIMEOUT 300)
endfunction()
