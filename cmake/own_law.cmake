# own_law(FOLDER): puts control/laws/table.h into FOLDER with one row more, MINE, law_mine_step(). A build that looks there first has a fifth law,
# and no file of the product is touched (docs/my_law.md).
set(OWN_LAW_ROOT "${CMAKE_CURRENT_LIST_DIR}/..")
function(own_law folder)
    set(file control/laws/table.h)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${OWN_LAW_ROOT}/${file}")
    file(READ "${OWN_LAW_ROOT}/${file}" rows)
    # The last row is the one whose line does not go on.
    string(REGEX REPLACE "(\n    LAW\\([^)]*\\))\n" "\\1 \\\\\n    LAW(MINE, law_mine_step, CYCLES_BY_HEIGHT)\n" more "${rows}")
    if(more STREQUAL rows)
        message(FATAL_ERROR "${file} has no row that MINE can follow")
    endif()
    file(CONFIGURE OUTPUT "${folder}/${file}" CONTENT "${more}" @ONLY)
endfunction()
