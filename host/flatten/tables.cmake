# SPDX-License-Identifier: Apache-2.0
# sunstone_tables: make_tables() with the albedo tables that make_tables.cpp integrates at build time. Needs the kernels' headers and nothing else, so
# that tests can have it alone. (A library of this folder may also list tables.cpp itself: the properties below go with the file.)
add_executable(sunstone_make_tables make_tables.cpp)
# Always optimised, never instrumented: it integrates for seconds.
target_compile_options(sunstone_make_tables PRIVATE -O2 -ffp-contract=off -Wall -Wextra -Werror)
target_include_directories(sunstone_make_tables PRIVATE ${PROJECT_SOURCE_DIR}/kernels)
set_target_properties(sunstone_make_tables PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
set(energy_tables ${CMAKE_CURRENT_BINARY_DIR}/tables/energy_tables.inc)
add_custom_command(OUTPUT ${energy_tables}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/tables
  COMMAND sunstone_make_tables ${energy_tables}
  DEPENDS sunstone_make_tables COMMENT "Integrating the albedo tables" VERBATIM)
sunstone_library(tables SOURCES tables.cpp ${energy_tables})
set_source_files_properties(tables.cpp PROPERTIES OBJECT_DEPENDS ${energy_tables} INCLUDE_DIRECTORIES ${CMAKE_CURRENT_BINARY_DIR}/tables)
