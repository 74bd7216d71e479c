# Fails if a file that is compiled for an instruction set (*_simd.cpp) defines a weak function outside the set's namespace.
# The linker keeps one copy of a weak function for the whole program. An older processor can not run that of a newer set.
#   cmake -DNM=nm -DINSTRUCTION_SET=avx2 "-DOBJECTS=a.o;b.o" -P check_symbols.cmake
# Inline functions and instances of templates are weak. Those of the standard library count, too: no kernel needs them.

if(NOT OBJECTS)
    message(FATAL_ERROR "no objects of ${INSTRUCTION_SET} to read")
endif()
set(own_functions 0)
set(shared "")
foreach(object IN LISTS OBJECTS)
    execute_process(
        COMMAND "${NM}" --demangle --defined-only "${object}"
        OUTPUT_VARIABLE table
        RESULT_VARIABLE status
    )
    if(NOT status EQUAL 0)
        message(FATAL_ERROR "${NM} can not read ${object}")
    endif()
    get_filename_component(file "${object}" NAME)
    # Brackets and semicolons would join or split the entries of a list.
    string(REGEX REPLACE "[][;]" "_" table "${table}")
    string(REPLACE "\n" ";" table "${table}")
    foreach(line IN LISTS table)
        # Upper T: a function of this file that others call. W: weak.
        if(NOT line MATCHES "^[0-9a-f]+ ([TW]) (.*)$")
            continue()
        endif()
        set(kind "${CMAKE_MATCH_1}")
        set(function "${CMAKE_MATCH_2}")
        if(function MATCHES "birm3d::${INSTRUCTION_SET}::")
            math(EXPR own_functions "${own_functions} + 1")
        elseif(kind STREQUAL "W")
            string(APPEND shared "\n  ${file}: ${function}")
        endif()
    endforeach()
endforeach()
if(shared)
    message(FATAL_ERROR "shared with other instruction sets; use BIRM3D_INLINE or the namespace:${shared}")
endif()
if(own_functions EQUAL 0)
    message(FATAL_ERROR "no function of birm3d::${INSTRUCTION_SET} was found: the symbols were not read")
endif()
message(STATUS "${INSTRUCTION_SET}: ${own_functions} functions, none is shared")
