shb_test(modal h5 fast shb_model)

shb_test(modal eigen slow tests_fem shb_modal)
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
