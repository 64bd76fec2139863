# Run by CTest: one test for each suite of `program`, but for those of its tests that are left out. Most quick tests run
# in less time than a process takes to start. Variables: `program`; `left_out`, patterns of --gtest_filter behind a minus,
# or nothing; `prefix`, of the tests' names; `list`, the file that keeps what the program listed; `properties` of each
# test. The file that sets them includes this one.
if(NOT EXISTS "${program}")
    add_test("${prefix}_NOT_BUILT" "${prefix}_NOT_BUILT")
    return()
endif()
if(NOT EXISTS "${list}" OR NOT "${list}" IS_NEWER_THAN "${program}" OR
    NOT "${list}" IS_NEWER_THAN "${CMAKE_PARENT_LIST_FILE}")
    execute_process(COMMAND "${program}" --gtest_list_tests "--gtest_filter=*${left_out}"
        OUTPUT_FILE "${list}" RESULT_VARIABLE result TIMEOUT 60)
    if(NOT result EQUAL 0)
        file(REMOVE "${list}")
        message(FATAL_ERROR "${program} does not list its tests: ${result}")
    endif()
endif()

# Tests are indented; types of parameters stand behind their suite's name.
file(STRINGS "${list}" suites REGEX "^[A-Za-z0-9_/]+\\.( |$)")
foreach(suite IN LISTS suites)
    string(REGEX REPLACE "\\..*" "" suite "${suite}")
    string(REPLACE "/" "" name "${prefix}.${suite}")
    add_test("${name}" "${program}" "--gtest_filter=${suite}.*${left_out}")
    set_tests_properties("${name}" PROPERTIES ${properties})
endforeach()
