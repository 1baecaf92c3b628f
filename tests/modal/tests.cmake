shb_test(modal/hdf5 UNIT h5_content INTEGRATION h5 LIBRARIES shb_model)
shb_test(modal/hdf5 INTEGRATION stamp LIBRARIES shb_modal_hdf5 DEFINITIONS
  DAMAGED="${CMAKE_CURRENT_SOURCE_DIR}/modal/hdf5/damaged/heap.h5"
  ENDLESS="${CMAKE_CURRENT_SOURCE_DIR}/modal/hdf5/damaged/endless.h5"
  WRITTEN_OVER="${CMAKE_CURRENT_SOURCE_DIR}/modal/hdf5/damaged/written_over.h5")
shb_test(modal/model INTEGRATION model UNIT spline residual_series receptance mode_selection damping
  LIBRARIES shb_model)
shb_test(modal/model UNIT golden LIBRARIES shb_model
  ARGUMENTS ${CMAKE_CURRENT_SOURCE_DIR}/modal/model/golden)
shb_test(modal/model UNIT reduce joined_pairs INTEGRATION speeds
  LIBRARIES tests_models tests_fem shb_modal)
shb_test(modal/common UNIT random_vector session INTEGRATION completeness HAND team
  LIBRARIES tests_fem shb_modal)
shb_test(modal/eigen UNIT block_products block_lanczos missed_modes inertia_count participation
  INTEGRATION eigen LIBRARIES tests_fem shb_modal)
shb_test(modal/condense UNIT face_partition residual_modes static_deflection load_patterns
  contact_patches INTEGRATION many_columns condense
  LIBRARIES tests_fem shb_modal PkgConfig::LAPACKE)
shb_test(modal/cyclic UNIT small_hermitian wave_basis wave_condense wave_fields wave_operator
  wave_ritz wave_search wave_coriolis INTEGRATION wave_modes blade_on_disc
  LIBRARIES tests_waves tests_box shb_modal shb_mesh_blade shb_mhb_integration)
shb_test(modal/stage UNIT rotating materials modal_stress vtkhdf
  INTEGRATION stage coriolis sector HAND ranks LIBRARIES tests_fem shb_modal shb_mhb_structure)

# The same programs on 1, 2 and 3 ranks.
foreach(ranks 1 2 3)
  set(ranked ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} --oversubscribe)
  shb_add_test(modal.common.team_${ranks} UNIT ${ranked} $<TARGET_FILE:test_modal_common> team)
  shb_add_test(modal.stage.ranks_${ranks} INTEGRATION ${ranked} $<TARGET_FILE:test_modal_stage>
    ranks)
  set(both modal.common.team_${ranks} modal.stage.ranks_${ranks})
  set_tests_properties(${both} PROPERTIES PROCESSORS 2)
  set_property(TEST ${both} APPEND PROPERTY ENVIRONMENT
    "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1")
endforeach()

# Between programs; skipped where python3 has no h5py.
if(SHROUDHB_PYTHON)
  shb_test(modal/model INTEGRATION python LIBRARIES shb_model ARGUMENTS ${SHROUDHB_PYTHON}
    ${CMAKE_CURRENT_SOURCE_DIR}/modal/model/foreign.py
    ${PROJECT_SOURCE_DIR}/cases/bring_your_own/write_modal.py)
endif()

# Against CalculiX; skipped where it is not installed.
set(calculix)
if(SHROUDHB_CCX)
  set(calculix ARGUMENTS ${SHROUDHB_CCX})
endif()
foreach(room stage cyclic)
  shb_test(modal/${room} INTEGRATION calculix LIBRARIES tests_fem shb_modal ${calculix})
endforeach()
