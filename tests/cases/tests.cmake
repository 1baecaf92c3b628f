set(PROGRAMS_FOLDER $<TARGET_FILE_DIR:shroudhb>)
set(CASES ${PROJECT_SOURCE_DIR}/cases)

shb_test(cases/options UNIT options command_table LIBRARIES shb_cases_options)
shb_test(cases/parse UNIT units keys lists LIBRARIES shb_case)
shb_test(cases/schema UNIT case faults stage_settings motion nodal_diameters LIBRARIES shb_case)
shb_python_test(cases.schema.key_schema UNIT cases/schema/test_key_schema.py
  $<TARGET_FILE:shroudhb> ${CASES})

shb_test(cases/front UNIT pinned LIBRARIES shb_cases_front
  DEFINITIONS TESTS_SOURCE="${CMAKE_CURRENT_SOURCE_DIR}")

shb_test(cases/contact UNIT hysteresis_picture LIBRARIES shb_cases_contact)
shb_test(cases/commands UNIT up_to_date modal_changes balance_run INTEGRATION contact_points
  LIBRARIES shb_cases_commands tests_models)
shb_shell_test(cases.commands.commands INTEGRATION cases/commands/test_commands.sh
  $<TARGET_FILE:shroudhb>)
if(NOT SHROUDHB_INSTRUMENTED) # they reserve more
  shb_shell_test(cases.commands.address_space UNIT cases/commands/test_address_space.sh
    ${PROGRAMS_FOLDER})
endif()
shb_shell_test(cases.commands.modes_alone INTEGRATION cases/commands/test_modes_alone.sh
  $<TARGET_FILE:shroudhb> ${CASES}/z_notch_blade/case.yaml)
shb_shell_test(cases.commands.stale INTEGRATION cases/commands/test_stale.sh
  $<TARGET_FILE:shroudhb> ${CASES}/z_notch_blade/case.yaml)
shb_shell_test(cases.commands.contact UNIT cases/commands/test_contact.sh
  $<TARGET_FILE:shroudhb> ${CASES}/prescribed_motion "${SHROUDHB_PYTHON}")
shb_python_test(cases.commands.json INTEGRATION cases/commands/test_json.py
  $<TARGET_FILE:shroudhb> ${CASES}/bring_your_own ${PROJECT_SOURCE_DIR}/docs/user/summary.md)
shb_python_test(cases.commands.revision INTEGRATION cases/commands/test_revision.py
  $<TARGET_FILE:shroudhb> ${CASES}/first_case/case.yaml)
if(SHROUDHB_PYTHON)
  shb_shell_test(cases.commands.integrate INTEGRATION cases/commands/test_integrate.sh
    ${PROGRAMS_FOLDER} ${CASES}/bring_your_own ${SHROUDHB_PYTHON})
endif()

# Sampling and statistics.
shb_test(cases/plan UNIT sampling statistics sobol_indices design_statistics
  LIBRARIES shb_cases_plan PkgConfig::GSL m)
shb_test(cases/peaks INTEGRATION design_run LIBRARIES shb_cases_peaks tests_models)
shb_test(cases/designs UNIT design_table digest output_names refusals study_keys study_optimise
  study_plan study_schema study_spec study_table uncertain_keys LIBRARIES shb_cases_designs)
shb_test(cases/study UNIT line_minimum optimiser optimisation dakota_files design_message
  nearest_design crew study_summary study_run LIBRARIES shb_cases_study tests_studies)

# What is installed, by `cmake --install` and as a Debian package, works on its own.
shb_shell_test(cases.install.install NIGHTLY cases/install/test_install.sh ${CMAKE_COMMAND}
  ${PROJECT_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR}/cases_install)

# Speed against error, from end to end.
shb_test(cases/converge UNIT resized_case compare INTEGRATION points_ladder NIGHTLY converge
  LIBRARIES shb_post shb_cases_converge tests_models
  DEFINITIONS SHROUDHB="$<TARGET_FILE:shroudhb>")
add_dependencies(test_cases_converge programs)

# The moving blade; skipped where python3 has no h5py.
shb_python_test(cases.field.field INTEGRATION cases/field/test_field.py ${PROGRAMS_FOLDER})

# A study over its programs, with one and with three ranks.
shb_python_test(cases.study.study INTEGRATION cases/study/test_study.py ${PROGRAMS_FOLDER}
  ${CASES}/bring_your_own)
shb_python_test(cases.study.samples INTEGRATION cases/study/test_samples.py ${PROGRAMS_FOLDER}
  ${CASES}/bring_your_own)
shb_python_test(cases.study.ring_samples NIGHTLY cases/study/test_ring_samples.py
  ${PROGRAMS_FOLDER} ${CASES}/mistuned_ring)
shb_python_test(cases.study.eval INTEGRATION cases/study/test_eval.py ${PROGRAMS_FOLDER}
  ${CASES}/bring_your_own)
shb_python_test(cases.study.blade_study INTEGRATION cases/study/test_blade_study.py
  ${PROGRAMS_FOLDER})

shb_python_test(cases.study.study_inputs INTEGRATION cases/study/test_study_inputs.py
  ${PROGRAMS_FOLDER} ${CASES}/bring_your_own)
shb_python_test(cases.study.one_answer INTEGRATION cases/study/test_one_answer.py
  ${PROGRAMS_FOLDER} ${CASES}/bring_your_own)
shb_python_test(cases.study.study_process INTEGRATION cases/study/test_study_process.py
  ${PROGRAMS_FOLDER} ${CASES}/bring_your_own)

# shb_scene_test(noun LABEL scene): a shipped scene from mesh to curves.
function(shb_scene_test noun label scene)
  shb_test(cases/scenes ${label} ${noun}
    LIBRARIES shb_case shb_mhb shb_cases_commands shb_modal tests_responses tests_models
    DEFINITIONS SHROUDHB="$<TARGET_FILE:shroudhb>" SCENE="${CASES}/${scene}")
endfunction()
target_compile_definitions(tests_responses PRIVATE SHROUDHB="$<TARGET_FILE:shroudhb>")
shb_scene_test(z_notch INTEGRATION z_notch_blade/case.yaml)
shb_scene_test(slip_onset INTEGRATION z_notch_blade)
shb_scene_test(run_up NIGHTLY z_notch_blade)
foreach(figure paper_fig7 paper_fig8)
  shb_scene_test(${figure} INTEGRATION ${figure})
endforeach()
foreach(figure paper_fig9 paper_fig10)
  shb_scene_test(${figure} NIGHTLY ${figure})
endforeach()
shb_scene_test(paper_fig8_direct NIGHTLY paper_fig8)
shb_scene_test(lost_curves NIGHTLY paper_fig8)
shb_scene_test(mistuned_ring NIGHTLY mistuned_ring)
shb_scene_test(bladed_disc NIGHTLY bladed_disc)
shb_scene_test(snubber_blade NIGHTLY snubber_blade)
shb_scene_test(optimum_preload INTEGRATION optimum_preload)
shb_scene_test(tracked_peaks NIGHTLY "")
shb_scene_test(shroud_angle NIGHTLY shroud_angle)
shb_scene_test(robust_preload NIGHTLY robust_preload)
shb_scene_test(soft_contact INTEGRATION z_notch_blade)
add_dependencies(test_cases_scenes programs)

shb_python_test(cases.scenes.read_results INTEGRATION cases/scenes/test_read_results.py
  $<TARGET_FILE:shroudhb> ${CASES}/first_case/case.yaml ${CASES}/read_results)
shb_python_test(cases.scenes.disc_vary NIGHTLY cases/scenes/test_disc_vary.py
  ${PROGRAMS_FOLDER} ${CASES}/bladed_disc)

# The example of cases/bring_your_own; skipped where python3 has no h5py.
if(SHROUDHB_PYTHON)
  shb_test(cases/scenes INTEGRATION bring_your_own LIBRARIES shb_mhb_response
    ARGUMENTS ${SHROUDHB_PYTHON} ${CASES}/bring_your_own ${PROGRAMS_FOLDER}/shroudhb-mhb)
endif()
