shb_test(modal h5 fast shb_model)
shb_test(modal spline fast shb_model)
shb_test(modal speeds fast tests_fem shb_modal)
shb_test(modal damping fast shb_modal)
shb_test(modal field fast tests_fem shb_modal)

shb_test(modal eigen slow tests_fem shb_modal)
shb_test(modal block_lanczos fast tests_fem shb_modal)
shb_test(modal check fast tests_fem shb_modal)
shb_test(modal rotating fast tests_fem shb_modal)
shb_test(modal participation fast tests_fem shb_modal)
shb_test(modal materials fast tests_fem shb_modal)
shb_test(modal interface fast tests_fem shb_modal)
shb_test(modal stage fast tests_fem shb_modal)
shb_test(modal condense slow tests_fem shb_modal PkgConfig::LAPACKE)

# The same program on 1, 2 and 3 ranks.
add_executable(test_modal_ranks modal/test_ranks.c)
target_link_libraries(test_modal_ranks PRIVATE tests_fem shb_modal)
foreach(ranks 1 2 3)
  add_test(NAME modal.ranks_${ranks} COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks}
    --oversubscribe $<TARGET_FILE:test_modal_ranks>)
  set_tests_properties(modal.ranks_${ranks} PROPERTIES LABELS fast TIMEOUT 600 PROCESSORS 2
    ENVIRONMENT "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1")
endforeach()
shb_test(modal model fast shb_model)

# Between programs; skipped where python3 has no h5py. Debian's python3 comes first: it is the one with h5py.
find_program(SHROUDHB_PYTHON NAMES python3 HINTS /usr/bin)
if(SHROUDHB_PYTHON)
  add_executable(test_modal_python modal/test_python.c)
  target_link_libraries(test_modal_python PRIVATE shb_model PkgConfig::CMOCKA m)
  add_test(NAME modal.python COMMAND test_modal_python ${SHROUDHB_PYTHON}
    ${CMAKE_CURRENT_SOURCE_DIR}/modal/foreign.py ${PROJECT_SOURCE_DIR}/cases/bring_your_own/write_modal.py)
  set_tests_properties(modal.python PROPERTIES LABELS fast TIMEOUT 120 SKIP_RETURN_CODE 77)
endif()

# Against CalculiX (Debian: calculix-ccx); skipped where it is not installed.
find_program(SHROUDHB_CCX NAMES ccx)
add_executable(test_modal_calculix modal/test_calculix.c)
target_link_libraries(test_modal_calculix PRIVATE tests_fem shb_modal PkgConfig::CMOCKA m)
if(SHROUDHB_CCX)
  add_test(NAME modal.calculix COMMAND test_modal_calculix ${SHROUDHB_CCX})
else()
  add_test(NAME modal.calculix COMMAND test_modal_calculix)
endif()
set_tests_properties(modal.calculix PROPERTIES LABELS fast TIMEOUT 600 SKIP_RETURN_CODE 77
  ENVIRONMENT OPENBLAS_NUM_THREADS=1)
