foreach(noun units keys lists)
  shb_test(cases/parse ${noun} shb_case)
endforeach()

if(SHROUDHB_PYTHON)
  add_test(NAME cases.schema.key_schema
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/schema/test_key_schema.py
            $<TARGET_FILE:shroudhb> ${PROJECT_SOURCE_DIR}/cases)
  set_tests_properties(cases.schema.key_schema PROPERTIES SKIP_RETURN_CODE 77)
endif()

foreach(noun case faults stage_settings motion nodal_diameters)
  shb_test(cases/schema ${noun} shb_case)
endforeach()

shb_test(cases/contact hysteresis_picture shb_cases_contact)
shb_test(cases/commands up_to_date shb_cases_commands)
shb_test(cases/commands balance_run shb_cases_commands tests_models)
shb_test(cases/commands modal_changes shb_cases_commands)
shb_test(cases/commands contact_points shb_cases_commands tests_models)
target_sources(test_cases_commands_contact_points PRIVATE bench/shroud_face.c)
add_test(NAME cases.commands.commands
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/commands/test_commands.sh $<TARGET_FILE:shroudhb>)
if(NOT SHROUDHB_SANITIZE AND NOT SHROUDHB_FUZZ AND NOT SHROUDHB_TSAN) # they reserve more
  add_test(NAME cases.commands.address_space
    COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/commands/test_address_space.sh
            $<TARGET_FILE_DIR:shroudhb>)
endif()
add_test(NAME cases.commands.modes_alone
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/commands/test_modes_alone.sh $<TARGET_FILE:shroudhb>
          ${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml)
add_test(NAME cases.commands.contact
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/commands/test_contact.sh
          $<TARGET_FILE:shroudhb-mhb> ${PROJECT_SOURCE_DIR}/cases/prescribed_motion
          "${SHROUDHB_PYTHON}")
if(SHROUDHB_PYTHON)
  add_test(NAME cases.commands.json
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/commands/test_json.py
            $<TARGET_FILE:shroudhb> ${PROJECT_SOURCE_DIR}/cases/bring_your_own
            ${PROJECT_SOURCE_DIR}/docs/user/summary.md)
  set_tests_properties(cases.commands.json PROPERTIES SKIP_RETURN_CODE 77)
  add_test(NAME cases.commands.revision
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/commands/test_revision.py
            $<TARGET_FILE:shroudhb> ${PROJECT_SOURCE_DIR}/cases/first_case/case.yaml)
  set_tests_properties(cases.commands.revision PROPERTIES SKIP_RETURN_CODE 77)
  add_test(NAME cases.commands.integrate
    COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/commands/test_integrate.sh
            $<TARGET_FILE_DIR:shroudhb-integrate> ${PROJECT_SOURCE_DIR}/cases/bring_your_own
            ${SHROUDHB_PYTHON})
  set_tests_properties(cases.commands.integrate PROPERTIES SKIP_RETURN_CODE 77)
endif()

# Sampling and statistics.
shb_test(cases/plan sampling shb_cases_plan m)
shb_test(cases/plan statistics shb_cases_plan PkgConfig::GSL m)
shb_test(cases/plan sobol_indices shb_cases_plan m)
shb_test(cases/plan design_statistics shb_cases_plan m)
shb_test(cases/peaks design_run shb_cases_peaks tests_models)
shb_test(cases/study line_minimum shb_cases_study)
shb_test(cases/study optimiser shb_cases_study)

# What is installed, by `cmake --install` and as a Debian package, works on its own.
add_test(NAME cases.install.install
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/install/test_install.sh ${CMAKE_COMMAND}
          ${PROJECT_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR}/cases_install)
set_tests_properties(cases.install.install PROPERTIES SKIP_RETURN_CODE 77)

# Speed against error, from end to end.
shb_test(cases/converge converge shb_post tests_models)
target_compile_definitions(test_cases_converge_converge PRIVATE
  SHROUDHB="$<TARGET_FILE:shroudhb>")
add_dependencies(test_cases_converge_converge programs)
shb_test(cases/converge points_ladder shb_post tests_models)
target_sources(test_cases_converge_points_ladder PRIVATE bench/shroud_face.c)
target_compile_definitions(test_cases_converge_points_ladder PRIVATE
  SHROUDHB="$<TARGET_FILE:shroudhb>")
add_dependencies(test_cases_converge_points_ladder programs)
shb_test(cases/converge resized_case shb_cases_converge)
shb_test(cases/converge compare shb_cases_converge tests_models)

# The moving blade; skipped where python3 has no h5py.
if(SHROUDHB_PYTHON)
  add_test(NAME cases.field.field
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/field/test_field.py
            $<TARGET_FILE_DIR:shroudhb-field>)
  set_tests_properties(cases.field.field PROPERTIES SKIP_RETURN_CODE 77)
endif()

# A study over its programs, with one and with three ranks.
if(SHROUDHB_PYTHON)
  add_test(NAME cases.study.study
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/study/test_study.py
            $<TARGET_FILE_DIR:shroudhb-study> ${PROJECT_SOURCE_DIR}/cases/bring_your_own)
  set_tests_properties(cases.study.study PROPERTIES SKIP_RETURN_CODE 77)
  add_test(NAME cases.study.samples
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/study/test_samples.py
            $<TARGET_FILE_DIR:shroudhb-study> ${PROJECT_SOURCE_DIR}/cases/bring_your_own)
  set_tests_properties(cases.study.samples PROPERTIES SKIP_RETURN_CODE 77)
  add_test(NAME cases.study.ring_samples
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/study/test_ring_samples.py
            $<TARGET_FILE_DIR:shroudhb-study> ${PROJECT_SOURCE_DIR}/cases/mistuned_ring)
  add_test(NAME cases.study.eval
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/study/test_eval.py
            $<TARGET_FILE_DIR:shroudhb-study> ${PROJECT_SOURCE_DIR}/cases/bring_your_own)
  set_tests_properties(cases.study.eval PROPERTIES SKIP_RETURN_CODE 77)
  add_test(NAME cases.study.blade_study
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/study/test_blade_study.py
            $<TARGET_FILE_DIR:shroudhb-study>)
endif()

# shb_scene_test(noun scene libraries...): a shipped scene from mesh to curves.
function(shb_scene_test noun scene)
  shb_test(cases/scenes ${noun} shb_case shb_mhb tests_responses ${ARGN})
  target_compile_definitions(test_cases_scenes_${noun} PRIVATE SHROUDHB="$<TARGET_FILE:shroudhb>"
    SCENE="${PROJECT_SOURCE_DIR}/cases/${scene}")
  add_dependencies(test_cases_scenes_${noun} programs)
endfunction()
target_compile_definitions(tests_responses PRIVATE SHROUDHB="$<TARGET_FILE:shroudhb>")
shb_scene_test(z_notch z_notch_blade/case.yaml)
shb_scene_test(slip_onset z_notch_blade)
shb_scene_test(run_up z_notch_blade)
foreach(figure paper_fig7 paper_fig8 paper_fig9 paper_fig10)
  shb_scene_test(${figure} ${figure})
endforeach()
shb_scene_test(paper_fig8_direct paper_fig8 shb_modal)
shb_scene_test(lost_curves paper_fig8)
shb_scene_test(mistuned_ring mistuned_ring)
shb_scene_test(bladed_disc bladed_disc shb_modal)
shb_scene_test(snubber_blade snubber_blade)
shb_scene_test(optimum_preload optimum_preload)
shb_scene_test(tracked_peaks "" shb_cases_commands tests_models)
if(TARGET shroudhb-study)
  shb_scene_test(shroud_angle shroud_angle)
  shb_scene_test(robust_preload robust_preload)
  shb_scene_test(soft_contact z_notch_blade)
endif()

if(SHROUDHB_PYTHON)
  add_test(NAME cases.scenes.read_results
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/scenes/test_read_results.py
            $<TARGET_FILE:shroudhb> ${PROJECT_SOURCE_DIR}/cases/first_case/case.yaml
            ${PROJECT_SOURCE_DIR}/cases/read_results)
  set_tests_properties(cases.scenes.read_results PROPERTIES SKIP_RETURN_CODE 77)
  add_test(NAME cases.scenes.disc_vary
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/cases/scenes/test_disc_vary.py
            $<TARGET_FILE_DIR:shroudhb> ${PROJECT_SOURCE_DIR}/cases/bladed_disc)
  set_tests_properties(cases.scenes.disc_vary PROPERTIES SKIP_RETURN_CODE 77)
endif()

# The example of cases/bring_your_own; skipped where python3 has no h5py.
if(SHROUDHB_PYTHON)
  add_executable(test_cases_scenes_bring_your_own cases/scenes/test_bring_your_own.c)
  target_link_libraries(test_cases_scenes_bring_your_own PRIVATE shb_mhb_response tests_support)
  add_test(NAME cases.scenes.bring_your_own COMMAND test_cases_scenes_bring_your_own
    ${SHROUDHB_PYTHON} ${PROJECT_SOURCE_DIR}/cases/bring_your_own $<TARGET_FILE:shroudhb-mhb>)
  set_tests_properties(cases.scenes.bring_your_own PROPERTIES SKIP_RETURN_CODE 77)
endif()
