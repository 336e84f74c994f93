# What seedframe's pages consist of, put into the program: page/web/ and Chart.js as Debian has it.
set(web ${PROJECT_SOURCE_DIR}/scheduler/page/web)
find_file(CHART_JS chart.min.js PATHS /usr/share/javascript/chart.js REQUIRED NO_DEFAULT_PATH)
# In the order in which they are read.
set(page_scripts data dom theme filter charts picture overview grid filter_panel frame_view variables_view
    run_view live main)
set(page_files kTemplate=${web}/index.html kStyle=${web}/page.css kChart=${CHART_JS}
    kChartLicense=${web}/chart_license.txt)
foreach(script ${page_scripts})
  list(APPEND page_files kScript=${web}/${script}.js)
endforeach()
list(TRANSFORM page_files REPLACE "^[^=]+=" "" OUTPUT_VARIABLE page_paths)
set(page_source ${PROJECT_BINARY_DIR}/web_files.cpp)
add_custom_command(OUTPUT ${page_source} VERBATIM
  COMMAND ${CMAKE_COMMAND} -D output=${page_source} "-D files=${page_files}" -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
  DEPENDS ${page_paths} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake)
target_sources(seedframe_page PRIVATE ${page_source})
set_source_files_properties(${page_source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
