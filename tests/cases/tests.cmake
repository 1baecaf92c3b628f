shb_test(cases units fast shb_case)
shb_test(cases keys fast shb_case)
foreach(noun case faults settings lists motion)
  shb_test(cases ${noun} fast shb_case)
  target_sources(test_cases_${noun} PRIVATE cases/scratch.c)
endforeach()

add_test(NAME cases.commands
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/test_commands.sh $<TARGET_FILE:shroudhb>)
set_tests_properties(cases.commands PROPERTIES LABELS fast TIMEOUT 120)

shb_test(cases loops fast shb_loops)
add_test(NAME cases.contact
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/test_contact.sh $<TARGET_FILE:shroudhb-mhb>
          ${PROJECT_SOURCE_DIR}/cases/prescribed_motion "${SHROUDHB_PYTHON}")
set_tests_properties(cases.contact PROPERTIES LABELS fast TIMEOUT 120)

if(SHROUDHB_PYTHON AND TARGET shroudhb-post)
  add_test(NAME cases.integrate
    COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/test_integrate.sh $<TARGET_FILE_DIR:shroudhb-integrate>
            ${PROJECT_SOURCE_DIR}/cases/bring_your_own ${SHROUDHB_PYTHON})
  set_tests_properties(cases.integrate PROPERTIES LABELS fast TIMEOUT 120 SKIP_RETURN_CODE 77)
endif()

if(TARGET shroudhb-post)
  shb_test(cases z_notch slow shb_post)
  target_sources(test_cases_z_notch PRIVATE cases/scene.c cases/scratch.c)
  target_compile_definitions(test_cases_z_notch PRIVATE
    SHROUDHB="$<TARGET_FILE:shroudhb>" SCENE="${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml")
  add_dependencies(test_cases_z_notch shroudhb shroudhb-mesh shroudhb-modal shroudhb-mhb shroudhb-post)
endif()

if(TARGET shroudhb-post)
  shb_test(cases run_up slow shb_response)
  target_sources(test_cases_run_up PRIVATE cases/scratch.c)
  target_compile_definitions(test_cases_run_up PRIVATE SHROUDHB="$<TARGET_FILE:shroudhb>")
  add_dependencies(test_cases_run_up shroudhb shroudhb-mesh shroudhb-modal shroudhb-mhb shroudhb-post)
endif()

# The paper's figures on our own blade, from mesh to curves.
if(TARGET shroudhb-post)
  function(figure_test noun scene)
    shb_test(cases ${noun} slow shb_post shb_mhb ${ARGN})
    target_sources(test_cases_${noun} PRIVATE cases/scene.c cases/scratch.c)
    target_compile_definitions(test_cases_${noun} PRIVATE SHROUDHB="$<TARGET_FILE:shroudhb>"
      SCENE="${PROJECT_SOURCE_DIR}/cases/${scene}")
    add_dependencies(test_cases_${noun} shroudhb shroudhb-mesh shroudhb-modal shroudhb-mhb shroudhb-post)
  endfunction()
  figure_test(paper_fig7 paper_fig7 shb_case)
  add_dependencies(test_cases_paper_fig7 shroudhb-integrate)
  figure_test(paper_fig8 paper_fig8)
  figure_test(paper_fig8_direct paper_fig8 shb_modal shb_case)
  figure_test(paper_fig9 paper_fig9 shb_case)
  figure_test(paper_fig10 paper_fig10 shb_case)
  figure_test(lost_curves paper_fig8)
  figure_test(snubber_blade snubber_blade)
  figure_test(slip_onset z_notch_blade)
endif()

# Speed against error, from end to end.
shb_test(cases converge fast shb_mhb shb_post)
target_sources(test_cases_converge PRIVATE cases/scratch.c mhb/three_degree.c)
target_compile_definitions(test_cases_converge PRIVATE SHROUDHB="$<TARGET_FILE:shroudhb>")
add_dependencies(test_cases_converge shroudhb shroudhb-converge shroudhb-rung shroudhb-mhb shroudhb-post shroudhb-integrate)
shb_test(cases derive fast shb_case shb_post)
target_sources(test_cases_derive PRIVATE cases/scratch.c ${PROJECT_SOURCE_DIR}/cases/derive.c)
