# The program with another bit rate: firmware/mounting.h with that line changed, found before the product's own. Only the sources
# that include it are compiled again; the linker takes them before the archive.
#
# rate_program(<stream rate>): the target fly_<rate>, which is `plomada fly`.
file(READ "${PROJECT_SOURCE_DIR}/firmware/mounting.h" MOUNTING)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/firmware/mounting.h")
function(rate_program rate)
    string(REGEX REPLACE "(#define LASER_STREAM_RATE )[0-9]+" "\\1${rate}" mounting "${MOUNTING}")
    file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/${rate}/firmware/mounting.h" CONTENT "${mounting}" @ONLY)
    room(mounting_${rate} "${PROJECT_SOURCE_DIR}/firmware/main.c" "${PROJECT_SOURCE_DIR}/firmware/task_send_laser.c")
    target_include_directories(mounting_${rate} BEFORE PRIVATE "${CMAKE_CURRENT_BINARY_DIR}/${rate}" "${PROJECT_SOURCE_DIR}")
    target_compile_definitions(mounting_${rate} PRIVATE main=firmware_main)
    target_link_libraries(mounting_${rate} PRIVATE control drivers bsp sim_sysbios)
    add_executable(fly_${rate} fly_layout.c)
    add_dependencies(fly_${rate} mounting_${rate})
    target_link_libraries(fly_${rate} PRIVATE -Wl,--whole-archive $<TARGET_FILE:mounting_${rate}> -Wl,--no-whole-archive plomada_fly)
endfunction()
