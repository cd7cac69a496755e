# FindCMock: CMock and its vendored Unity.
#   CMOCK_ROOT (cache or environment) -> /usr/share/cmock (Debian's cmock) -> FetchContent when CMOCK_FETCH is ON.
# Defines: CMOCK_ROOT_DIR CMOCK_RB CMOCK_RUNNER_RB Unity::Unity CMock::CMock CMock_FOUND
include_guard(GLOBAL)
option(CMOCK_FETCH "Fetch CMock from GitHub when it is not installed" OFF)
set(CMOCK_ROOT "" CACHE PATH "A CMock tree with lib/cmock.rb and vendor/unity")

find_program(Ruby_EXECUTABLE NAMES ruby ruby3.3 ruby3.1 DOC "Ruby, which CMock's generators need")

find_path(CMOCK_ROOT_DIR NAMES lib/cmock.rb
    HINTS "${CMOCK_ROOT}" ENV CMOCK_ROOT
    PATHS /usr/share/cmock /usr/local/share/cmock
    NO_DEFAULT_PATH)

if(NOT CMOCK_ROOT_DIR AND CMOCK_FETCH)
    include(FetchContent)
    # the very commit Debian packages as 2.5.3+git40-g379a9a8; vendor/unity is a submodule
    FetchContent_Declare(cmock_upstream
        GIT_REPOSITORY https://github.com/ThrowTheSwitch/CMock.git
        GIT_TAG 379a9a8d5dd5cdff8fd345710dd70ae26f966c71
        GIT_SUBMODULES vendor/unity vendor/c_exception
        SOURCE_SUBDIR no-cmake-here) # CMock has no top CMakeLists.txt: populate only
    FetchContent_MakeAvailable(cmock_upstream)
    set(CMOCK_ROOT_DIR "${cmock_upstream_SOURCE_DIR}" CACHE PATH "" FORCE)
endif()

set(CMOCK_RB "${CMOCK_ROOT_DIR}/lib/cmock.rb")
set(CMOCK_RUNNER_RB "${CMOCK_ROOT_DIR}/vendor/unity/auto/generate_test_runner.rb")
if(CMOCK_ROOT_DIR AND EXISTS "${CMOCK_ROOT_DIR}/src/cmock.h")
    file(STRINGS "${CMOCK_ROOT_DIR}/src/cmock.h" _v REGEX "define CMOCK_VERSION_(MAJOR|MINOR|BUILD) ")
    string(REGEX REPLACE "[^0-9]+" "." CMock_VERSION "${_v}")
    string(REGEX REPLACE "^\\.|\\.$" "" CMock_VERSION "${CMock_VERSION}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CMock
    REQUIRED_VARS CMOCK_ROOT_DIR Ruby_EXECUTABLE
    VERSION_VAR CMock_VERSION
    REASON_FAILURE_MESSAGE "install Debian's 'cmock' (see `tools/setup/setup.sh test`), or pass -DCMOCK_ROOT=<CMock tree>, or -DCMOCK_FETCH=ON")

if(CMock_FOUND AND NOT TARGET Unity::Unity)
    # Set UNITY_CONFIG_DIR to the directory of your unity_config.h before find_package(CMock).
    add_library(unity_lib STATIC "${CMOCK_ROOT_DIR}/vendor/unity/src/unity.c")
    target_include_directories(unity_lib SYSTEM PUBLIC "${CMOCK_ROOT_DIR}/vendor/unity/src")
    if(UNITY_CONFIG_DIR)
        target_include_directories(unity_lib PUBLIC "${UNITY_CONFIG_DIR}")
        target_compile_definitions(unity_lib PUBLIC UNITY_INCLUDE_CONFIG_H)
    endif()
    if(UNIX)
        target_link_libraries(unity_lib PUBLIC m)
    endif()
    target_compile_options(unity_lib PRIVATE -w)
    add_library(Unity::Unity ALIAS unity_lib)

    add_library(cmock_lib STATIC "${CMOCK_ROOT_DIR}/src/cmock.c")
    target_include_directories(cmock_lib SYSTEM PUBLIC "${CMOCK_ROOT_DIR}/src")
    target_compile_definitions(cmock_lib PUBLIC CMOCK_MEM_DYNAMIC)
    target_link_libraries(cmock_lib PUBLIC unity_lib)
    target_compile_options(cmock_lib PRIVATE -w)
    add_library(CMock::CMock ALIAS cmock_lib)
endif()
