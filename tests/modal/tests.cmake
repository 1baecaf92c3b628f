shb_test(modal/hdf5 h5 fast shb_model)
shb_test(modal/model model fast shb_model)
shb_test(modal/model spline fast shb_model)
shb_test(modal/model speeds fast tests_fem shb_modal)
shb_test(modal/model reduce fast tests_models)
shb_test(modal/model residual_series fast shb_model)
shb_test(modal/model receptance fast shb_model)
shb_test(modal/model mode_selection fast shb_model)
shb_test(modal/common damping fast shb_modal)
shb_test(modal/common random_vector fast)
shb_test(modal/common completeness fast tests_fem shb_modal)
shb_test(modal/eigen eigen slow tests_fem shb_modal)
shb_test(modal/eigen block_lanczos fast tests_fem shb_modal)
shb_test(modal/eigen missed_modes fast tests_fem shb_modal)
shb_test(modal/eigen inertia_count fast tests_fem shb_modal)
shb_test(modal/eigen participation fast tests_fem shb_modal)
shb_test(modal/condense face_partition fast tests_fem shb_modal)
shb_test(modal/condense residual_modes fast shb_modal)
shb_test(modal/condense static_deflection fast tests_fem shb_modal)
shb_test(modal/condense load_patterns fast tests_fem shb_modal)
shb_test(modal/condense contact_patches fast tests_fem shb_modal)
shb_test(modal/condense condense slow tests_fem shb_modal PkgConfig::LAPACKE)
foreach(noun rotating materials stage vtkhdf)
  shb_test(modal/stage ${noun} fast tests_fem shb_modal)
endforeach()

# The same program on 1, 2 and 3 ranks.
add_executable(test_modal_stage_ranks modal/stage/test_ranks.c)
target_link_libraries(test_modal_stage_ranks PRIVATE tests_fem shb_modal)
foreach(ranks 1 2 3)
  add_test(NAME modal.stage.ranks_${ranks} COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG}
    ${ranks} --oversubscribe $<TARGET_FILE:test_modal_stage_ranks>)
  set_tests_properties(modal.stage.ranks_${ranks} PROPERTIES LABELS fast TIMEOUT 600 PROCESSORS 2
    ENVIRONMENT "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1")
endforeach()

# Between programs; skipped where python3 has no h5py.
if(SHROUDHB_PYTHON)
  add_executable(test_modal_model_python modal/model/test_python.c)
  target_link_libraries(test_modal_model_python PRIVATE shb_model tests_support)
  add_test(NAME modal.model.python COMMAND test_modal_model_python ${SHROUDHB_PYTHON}
    ${CMAKE_CURRENT_SOURCE_DIR}/modal/model/foreign.py
    ${PROJECT_SOURCE_DIR}/cases/bring_your_own/write_modal.py)
  set_tests_properties(modal.model.python PROPERTIES LABELS fast TIMEOUT 120 SKIP_RETURN_CODE 77)
endif()

# Against CalculiX; skipped where it is not installed.
add_executable(test_modal_stage_calculix modal/stage/test_calculix.c)
target_link_libraries(test_modal_stage_calculix PRIVATE tests_fem shb_modal)
if(SHROUDHB_CCX)
  add_test(NAME modal.stage.calculix COMMAND test_modal_stage_calculix ${SHROUDHB_CCX})
else()
  add_test(NAME modal.stage.calculix COMMAND test_modal_stage_calculix)
endif()
set_tests_properties(modal.stage.calculix PROPERTIES LABELS fast TIMEOUT 600 SKIP_RETURN_CODE 77
  ENVIRONMENT OPENBLAS_NUM_THREADS=1)
