# Where Eigen comes from. Used by our own build and installed beside birm3dConfig.cmake for C++ users.
#
#   birm3d_find_eigen([OPTIONAL] [DOWNLOADS <bool>])
#
# defines the imported target Eigen3::Eigen from the first of
#   1. an installed Eigen: system package, conda, or -DEigen3_ROOT=<prefix>;
#   2. the Python package cmeel-eigen of the interpreter in use (Python_EXECUTABLE, or else the first one found);
#   3. with DOWNLOADS or FETCHCONTENT_SOURCE_DIR_EIGEN: the Eigen source tree of a fixed release;
# and otherwise stops with the remedies (or, with OPTIONAL, returns without the target).
# Sets birm3d_eigen_version and birm3d_eigen_origin.

set(birm3d_eigen_remedies
    "BIRM3D needs Eigen 3.4 or newer and found none. Any of these helps:
  - install the system package (Debian: libeigen3-dev), or give -DEigen3_ROOT=<prefix>
  - pip install cmeel-eigen, and give -DPython_EXECUTABLE=<that interpreter>
  - let our build fetch it: -DBIRM3D_DOWNLOADS=ON, or -DFETCHCONTENT_SOURCE_DIR_EIGEN=<source tree>")

# A macro: find_package must set Eigen3_FOUND and Eigen3_VERSION in the caller's scope.
# Two calls, because Eigen's own version file accepts neither 5.x for "3.4" nor, in 3.4.0, a version range.
macro(_birm3d_try_eigen)
    if(NOT Eigen3_FOUND)
        find_package(Eigen3 3.4 CONFIG QUIET ${ARGN})
    endif()
    if(NOT Eigen3_FOUND)
        find_package(Eigen3 5 CONFIG QUIET ${ARGN})
    endif()
endmacro()

# Prefixes in which cmeel wheels install, for the packages that the interpreter can import. sys.path and not
# sysconfig: within pip's isolated build the build requirements are on sys.path only.
function(_birm3d_cmeel_prefixes out)
    set(${out} "" PARENT_SCOPE)
    if(NOT Python_EXECUTABLE)
        find_package(Python COMPONENTS Interpreter QUIET)
    endif()
    if(NOT Python_EXECUTABLE)
        return()
    endif()
    execute_process(
        COMMAND
            "${Python_EXECUTABLE}" -c
            "import pathlib, sys; print(*(q.as_posix() for p in sys.path if (q := pathlib.Path(p, 'cmeel.prefix')).is_dir()), sep=';')"
        OUTPUT_VARIABLE prefixes
        OUTPUT_STRIP_TRAILING_WHITESPACE
        RESULT_VARIABLE status
    )
    if(status EQUAL 0)
        set(${out} "${prefixes}" PARENT_SCOPE)
    endif()
endfunction()

macro(birm3d_find_eigen)
    cmake_parse_arguments(_birm3d_eigen "OPTIONAL" "DOWNLOADS" "" ${ARGN})
    if(TARGET Eigen3::Eigen)
        set(birm3d_eigen_version "${Eigen3_VERSION}")
        set(birm3d_eigen_origin "target of the including project")
    else()
        _birm3d_try_eigen()
        if(NOT Eigen3_FOUND)
            _birm3d_cmeel_prefixes(_birm3d_prefixes)
            if(_birm3d_prefixes)
                _birm3d_try_eigen(PATHS ${_birm3d_prefixes} NO_DEFAULT_PATH)
            endif()
        endif()
        if(Eigen3_FOUND)
            set(birm3d_eigen_version "${Eigen3_VERSION}")
            set(birm3d_eigen_origin "${Eigen3_DIR}")
        elseif(_birm3d_eigen_DOWNLOADS OR FETCHCONTENT_SOURCE_DIR_EIGEN)
            include(FetchContent)
            # SOURCE_SUBDIR does not exist, on purpose: Eigen's own CMake files would add hundreds of test targets, and
            # its install rules would put Eigen into our wheel.
            FetchContent_Declare(
                eigen
                GIT_REPOSITORY https://gitlab.com/libeigen/eigen.git
                GIT_TAG 3147391d946bb4b6c68edd901f2add6ac1f31f8c # 3.4.0
                SOURCE_SUBDIR no-cmake-here
            )
            FetchContent_MakeAvailable(eigen)
            # Imported, so that it counts as SYSTEM and our exported targets refer to it by name only.
            add_library(Eigen3::Eigen INTERFACE IMPORTED)
            set_target_properties(Eigen3::Eigen PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${eigen_SOURCE_DIR}")
            set(birm3d_eigen_version "source tree")
            set(birm3d_eigen_origin "${eigen_SOURCE_DIR}")
        elseif(NOT _birm3d_eigen_OPTIONAL)
            message(FATAL_ERROR "${birm3d_eigen_remedies}")
        endif()
    endif()
endmacro()
