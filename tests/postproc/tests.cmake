shb_test(postproc/draw UNIT colour number_format text_buffer plot LIBRARIES shb_post)
shb_test(postproc/analysis UNIT outputs abscissa curves curve_distance convergence response_analysis
  campbell file_origin findings resonances stability_findings LIBRARIES tests_responses)
shb_test(postproc/report UNIT csv ring_charts page_data tables picture safe_diagram
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

# The pages in a browser, where there is one.
if(SHROUDHB_CHROMIUM)
  shb_python_test(postproc.study.page_script INTEGRATION postproc/study/test_page_script.py
    $<TARGET_FILE:test_postproc_study> ${SHROUDHB_CHROMIUM})
  shb_python_test(postproc.report.page_script INTEGRATION postproc/report/test_page_script.py
    $<TARGET_FILE:test_postproc_report> ${SHROUDHB_CHROMIUM})
  shb_python_test(postproc.report.page_numbers INTEGRATION postproc/report/test_point_numbers.py
    $<TARGET_FILE:test_postproc_report> ${SHROUDHB_CHROMIUM})
endif()
