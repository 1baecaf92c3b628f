shb_test(postproc/draw UNIT colour number_format text_buffer template plot LIBRARIES shb_post)
shb_test(postproc/analysis UNIT outputs abscissa curves curve_distance convergence response_analysis
  campbell file_origin findings resonances stability_findings LIBRARIES tests_responses)
shb_test(postproc/report UNIT csv ring_data page_data tables picture safe_diagram
  contact_points INTEGRATION publish point_numbers report blade_view
  LIBRARIES tests_responses tests_models tests_box)
# The program itself: exit codes and the one line of an error.
shb_test(postproc/report UNIT command LIBRARIES tests_responses tests_studies)
add_dependencies(test_postproc_report shroudhb)
set_property(TEST postproc.report.command APPEND PROPERTY ENVIRONMENT
  "SHROUDHB_POST=$<TARGET_FILE_DIR:shroudhb>/shroudhb-post")
shb_test(postproc/inspect UNIT diameter_table inspect mac mode_table phase_table value_table
  INTEGRATION value_range LIBRARIES tests_responses)
shb_test(postproc/field UNIT peak_stress whole_period stress_section strain_gauge
  LIBRARIES shb_post tests_models tests_box)
shb_test(postproc/study UNIT study_file study_effects study_page LIBRARIES tests_studies)
shb_test(postproc/comparison UNIT run_comparison LIBRARIES tests_responses)

# The scripts of the pages: their modules under node, the pages in a browser, their numbers against
# the schemas. What a machine lacks is told as skipped.
file(GLOB SCRIPT_TESTS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/postproc/script CONFIGURE_DEPENDS
  ${CMAKE_CURRENT_SOURCE_DIR}/postproc/script/test_*.mjs)
foreach(script ${SCRIPT_TESTS})
  string(REGEX REPLACE "test_(.*)\\.mjs" "\\1" noun ${script})
  shb_tool_test(postproc.script.${noun} UNIT node "${SHROUDHB_NODE}"
    ${SHROUDHB_NODE} --test ${CMAKE_CURRENT_SOURCE_DIR}/postproc/script/${script})
endforeach()
shb_tool_test(postproc.script.eslint INTEGRATION eslint "${SHROUDHB_ESLINT}"
  ${SHROUDHB_ESLINT} --format unix --ext .js,.mjs postproc/script tests/postproc/script)
if(SHROUDHB_ESLINT)
  # where Debian's eslint has its libraries, for a node from elsewhere
  set_tests_properties(postproc.script.eslint PROPERTIES WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    ENVIRONMENT "NODE_PATH=/usr/share/nodejs:/usr/share/javascript")
endif()
shb_python_test(postproc.script.schema INTEGRATION postproc/script/test_schema.py
  $<TARGET_FILE:test_postproc_report> $<TARGET_FILE:test_postproc_study>)
foreach(room study report)
  set(script ${SHROUDHB_PYTHON} -B
    ${CMAKE_CURRENT_SOURCE_DIR}/postproc/${room}/test_page_script.py
    $<TARGET_FILE:test_postproc_${room}> ${SHROUDHB_CHROMIUM})
  shb_tool_test(postproc.${room}.page_script INTEGRATION chromium "${SHROUDHB_CHROMIUM}" ${script})
  shb_tool_test(postproc.${room}.page_script_all NIGHTLY chromium "${SHROUDHB_CHROMIUM}" ${script}
    all)
endforeach()
if(NOT SHROUDHB_CHROMIUM)
  set(SHROUDHB_CHROMIUM)
endif()
shb_tool_test(postproc.report.page_numbers INTEGRATION node "${SHROUDHB_NODE}"
  ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/postproc/report/test_point_numbers.py
  $<TARGET_FILE:test_postproc_report> ${SHROUDHB_NODE} ${SHROUDHB_CHROMIUM})
