foreach(noun colour number_format text_buffer plot)
  shb_test(postproc/draw ${noun} shb_post)
endforeach()
foreach(noun outputs abscissa curves curve_distance convergence response_analysis campbell
    file_origin findings stability_findings)
  shb_test(postproc/analysis ${noun} tests_responses)
endforeach()
foreach(noun csv report publish page_data tables picture)
  shb_test(postproc/report ${noun} tests_responses)
endforeach()
foreach(noun inspect mac mode_table phase_table value_table)
  shb_test(postproc/inspect ${noun} tests_responses)
endforeach()
shb_test(postproc/study study_file shb_post)
foreach(noun study_effects study_page)
  shb_test(postproc/study ${noun} tests_studies)
endforeach()

# The program itself: exit codes and the one line of an error.
shb_test(postproc/report command tests_responses tests_studies)
add_dependencies(test_postproc_report_command shroudhb-post)
set_tests_properties(postproc.report.command PROPERTIES ENVIRONMENT
  "SHROUDHB_POST=$<TARGET_FILE:shroudhb-post>")
