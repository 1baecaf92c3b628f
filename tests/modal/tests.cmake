shb_test(modal/hdf5 h5 shb_model)
shb_test(modal/hdf5 stamp shb_modal_hdf5)
target_compile_definitions(test_modal_hdf5_stamp PRIVATE
  DAMAGED="${CMAKE_CURRENT_SOURCE_DIR}/modal/hdf5/damaged/heap.h5"
  ENDLESS="${CMAKE_CURRENT_SOURCE_DIR}/modal/hdf5/damaged/endless.h5"
  WRITTEN_OVER="${CMAKE_CURRENT_SOURCE_DIR}/modal/hdf5/damaged/written_over.h5")
shb_test(modal/model model shb_model)
shb_test(modal/model spline shb_model)
shb_test(modal/model speeds tests_fem shb_modal)
shb_test(modal/model reduce tests_models)
shb_test(modal/model joined_pairs tests_models)
shb_test(modal/model residual_series shb_model)
shb_test(modal/model receptance shb_model)
shb_test(modal/model mode_selection shb_model)
shb_test(modal/model damping shb_model)
shb_test(modal/common random_vector)
shb_test(modal/common completeness tests_fem shb_modal)
shb_test(modal/eigen eigen tests_fem shb_modal)
shb_test(modal/eigen block_products tests_fem shb_modal)
shb_test(modal/eigen block_lanczos tests_fem shb_modal)
shb_test(modal/eigen missed_modes tests_fem shb_modal)
shb_test(modal/eigen inertia_count tests_fem shb_modal)
shb_test(modal/eigen participation tests_fem shb_modal)
shb_test(modal/condense face_partition tests_fem shb_modal)
shb_test(modal/condense residual_modes shb_modal)
shb_test(modal/condense static_deflection tests_fem shb_modal)
shb_test(modal/condense load_patterns tests_fem shb_modal)
shb_test(modal/condense contact_patches tests_fem shb_modal)
shb_test(modal/condense condense tests_fem shb_modal PkgConfig::LAPACKE)
shb_test(modal/cyclic wave_modes tests_fem shb_modal)
shb_test(modal/cyclic blade_on_disc tests_fem tests_box shb_modal shb_mesh_blade)
shb_test(modal/cyclic wave_coriolis tests_fem shb_modal shb_mhb_integration)
shb_test(modal/stage coriolis tests_fem shb_modal shb_mhb_structure)
foreach(noun rotating materials modal_stress sector stage vtkhdf)
  shb_test(modal/stage ${noun} tests_fem shb_modal)
endforeach()

# The same program on 1, 2 and 3 ranks.
add_executable(test_modal_stage_ranks modal/stage/test_ranks.c)
target_link_libraries(test_modal_stage_ranks PRIVATE tests_fem shb_modal)
foreach(ranks 1 2 3)
  add_test(NAME modal.stage.ranks_${ranks} COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG}
    ${ranks} --oversubscribe $<TARGET_FILE:test_modal_stage_ranks>)
  set_tests_properties(modal.stage.ranks_${ranks} PROPERTIES PROCESSORS 2
    ENVIRONMENT "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1")
endforeach()

# Between programs; skipped where python3 has no h5py.
if(SHROUDHB_PYTHON)
  add_executable(test_modal_model_python modal/model/test_python.c)
  target_link_libraries(test_modal_model_python PRIVATE shb_model tests_support)
  add_test(NAME modal.model.python COMMAND test_modal_model_python ${SHROUDHB_PYTHON}
    ${CMAKE_CURRENT_SOURCE_DIR}/modal/model/foreign.py
    ${PROJECT_SOURCE_DIR}/cases/bring_your_own/write_modal.py)
  set_tests_properties(modal.model.python PROPERTIES SKIP_RETURN_CODE 77)
endif()

# Against CalculiX; skipped where it is not installed.
foreach(room stage cyclic)
  add_executable(test_modal_${room}_calculix modal/${room}/test_calculix.c)
  target_link_libraries(test_modal_${room}_calculix PRIVATE tests_fem shb_modal)
  if(SHROUDHB_CCX)
    add_test(NAME modal.${room}.calculix COMMAND test_modal_${room}_calculix ${SHROUDHB_CCX})
  else()
    add_test(NAME modal.${room}.calculix COMMAND test_modal_${room}_calculix)
  endif()
  set_tests_properties(modal.${room}.calculix PROPERTIES SKIP_RETURN_CODE 77
    ENVIRONMENT OPENBLAS_NUM_THREADS=1)
endforeach()
