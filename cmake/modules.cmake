# Warnings, sanitizers and the one way to declare a module.

# Plugins are looked for in bin/../lib, so that the folders can be moved together, and where they were built.
set(BRISANCE_PLUGIN_FOLDER ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_BUILD_RPATH "$ORIGIN/../lib;${BRISANCE_PLUGIN_FOLDER}")

add_library(brisance_options INTERFACE)
target_compile_options(brisance_options INTERFACE -Wall -Wextra -Wpedantic -Wno-psabi)
if(BRISANCE_WERROR)
    target_compile_options(brisance_options INTERFACE -Werror)
endif()
# Without math-errno square roots and the like vectorise; no other floating-point rule is relaxed: NaN stays NaN.
target_compile_options(brisance_options INTERFACE -fno-math-errno)
target_compile_definitions(brisance_options INTERFACE GLM_FORCE_XYZW_ONLY)
if(BRISANCE_SANITIZE)
    target_compile_options(brisance_options INTERFACE -fsanitize=${BRISANCE_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(brisance_options INTERFACE -fsanitize=${BRISANCE_SANITIZE})
    # The sanitizers' own dlopen knows no run path but the kind that the whole program inherits.
    target_link_options(brisance_options INTERFACE -Wl,--disable-new-dtags)
endif()
# The modules whose readers are fuzzed. The others are linked for what the targets `shot` and `look` know of them, and would take
# most of the time of that build with their templates optimised and instrumented.
set(BRISANCE_FUZZED_MODULES core codec volume surfaces scene film reference shot first_look)
if(BRISANCE_FUZZ)
    target_compile_options(brisance_options INTERFACE -fsanitize=fuzzer-no-link)
    # What is instrumented in a plugin reports to libFuzzer, which is in the program.
    set(CMAKE_ENABLE_EXPORTS ON)
endif()

# brisance_module(name SOURCES ... USES modules... WALLS libraries...)
# WALLS are libraries that must not leak out of the module; include directions are checked by tools/check_includes.py.
function(brisance_module name)
    cmake_parse_arguments(arg "" "" "SOURCES;USES;WALLS" ${ARGN})
    add_library(brisance_${name} STATIC ${arg_SOURCES})
    target_include_directories(brisance_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
    list(TRANSFORM arg_USES PREPEND brisance_)
    target_link_libraries(brisance_${name} PUBLIC ${arg_USES} glm::glm PRIVATE brisance_options ${arg_WALLS})
    if(BRISANCE_FUZZ AND NOT name IN_LIST BRISANCE_FUZZED_MODULES)
        target_compile_options(brisance_${name} PRIVATE -O0 -fno-sanitize=all)
    endif()
endfunction()
