foreach(noun colour number_format text_buffer plot)
  shb_test(postproc/draw ${noun} shb_post)
endforeach()
foreach(noun outputs abscissa curves curve_distance convergence response_analysis campbell
    file_origin findings resonances stability_findings)
  shb_test(postproc/analysis ${noun} tests_responses)
endforeach()
foreach(noun csv ring_charts report publish page_data tables picture)
  shb_test(postproc/report ${noun} tests_responses)
endforeach()
foreach(noun diameter_table inspect mac mode_table phase_table value_range value_table)
  shb_test(postproc/inspect ${noun} tests_responses)
endforeach()
shb_test(postproc/field peak_stress shb_post tests_models)
shb_test(postproc/field whole_period shb_post tests_models)
shb_test(postproc/field stress_section shb_post)
shb_test(postproc/field strain_gauge shb_post tests_box)
shb_test(postproc/study study_file shb_post)
foreach(noun study_effects study_page)
  shb_test(postproc/study ${noun} tests_studies)
endforeach()

shb_test(postproc/comparison run_comparison tests_responses)
shb_test(postproc/report safe_diagram tests_responses tests_models)
shb_test(postproc/report contact_points tests_responses)
shb_test(postproc/report point_numbers tests_responses tests_models)
shb_test(postproc/report blade_view tests_responses tests_box)

# The pages in a browser, where there is one.
find_program(SHROUDHB_CHROMIUM NAMES chromium chromium-browser google-chrome)
if(SHROUDHB_CHROMIUM AND SHROUDHB_PYTHON)
  add_test(NAME postproc.study.page_script
    COMMAND ${SHROUDHB_PYTHON} -B
      ${CMAKE_CURRENT_SOURCE_DIR}/postproc/study/test_page_script.py
      $<TARGET_FILE:test_postproc_study_study_page> ${SHROUDHB_CHROMIUM})
  add_test(NAME postproc.report.page_script
    COMMAND ${SHROUDHB_PYTHON} -B
      ${CMAKE_CURRENT_SOURCE_DIR}/postproc/report/test_page_script.py
      $<TARGET_FILE:test_postproc_report_contact_points>
      $<TARGET_FILE:test_postproc_report_blade_view> ${SHROUDHB_CHROMIUM})
  add_test(NAME postproc.report.page_numbers
    COMMAND ${SHROUDHB_PYTHON} -B
      ${CMAKE_CURRENT_SOURCE_DIR}/postproc/report/test_point_numbers.py
      $<TARGET_FILE:test_postproc_report_point_numbers> ${SHROUDHB_CHROMIUM})
  set_tests_properties(postproc.report.page_numbers PROPERTIES SKIP_RETURN_CODE 77)
endif()

# The program itself: exit codes and the one line of an error.
shb_test(postproc/report command tests_responses tests_studies)
add_dependencies(test_postproc_report_command shroudhb-post)
set_tests_properties(postproc.report.command PROPERTIES ENVIRONMENT
  "SHROUDHB_POST=$<TARGET_FILE:shroudhb-post>")
