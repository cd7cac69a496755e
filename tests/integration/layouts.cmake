# The program with another ray layout or bit rate: firmware/mounting.h with those lines changed, as its comment says, found
# before the product's own. Only the two sources that include it are compiled again; the linker takes them before the archive.
#
# layout_program(<layout> <stream rate>): the target fly_<layout>_<rate>, which is `plomada fly`.
file(READ "${PROJECT_SOURCE_DIR}/firmware/mounting.h" MOUNTING)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/firmware/mounting.h")
function(layout_program layout rate)
    set(name ${layout}_${rate})
    string(REGEX REPLACE "(#define LASER_LAYOUT )[A-Z_]+" "\\1SCIP_LAYOUT_${layout}" mounting "${MOUNTING}")
    string(REGEX REPLACE "(#define LASER_STREAM_RATE )[0-9]+" "\\1${rate}" mounting "${mounting}")
    file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/${name}/firmware/mounting.h" CONTENT "${mounting}" @ONLY)
    room(mounting_${name} "${PROJECT_SOURCE_DIR}/firmware/main.c" "${PROJECT_SOURCE_DIR}/firmware/task_receive_laser.c")
    target_include_directories(mounting_${name} BEFORE PRIVATE "${CMAKE_CURRENT_BINARY_DIR}/${name}" "${PROJECT_SOURCE_DIR}")
    target_compile_definitions(mounting_${name} PRIVATE main=firmware_main)
    target_link_libraries(mounting_${name} PRIVATE control drivers bsp sim_sysbios)
    add_executable(fly_${name} fly_layout.c)
    add_dependencies(fly_${name} mounting_${name})
    target_link_libraries(fly_${name} PRIVATE -Wl,--whole-archive $<TARGET_FILE:mounting_${name}> -Wl,--no-whole-archive plomada_fly)
endfunction()
