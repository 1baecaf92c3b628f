shb_test(mhb contact fast shb_contact)
shb_test(mhb sweep fast shb_mhb)
target_sources(test_mhb_sweep PRIVATE mhb/three_degree.c)
shb_test(mhb receptance fast shb_mhb)
target_sources(test_mhb_receptance PRIVATE mhb/random_model.c)
shb_test(mhb residual fast shb_mhb)
target_sources(test_mhb_residual PRIVATE mhb/random_model.c)
shb_test(mhb response fast shb_response)

# The example of cases/bring_your_own; skipped where python3 has no h5py.
find_program(SHROUDHB_PYTHON NAMES python3 HINTS /usr/bin)
if(SHROUDHB_PYTHON AND TARGET shroudhb-mhb)
  add_executable(test_mhb_example mhb/test_example.c)
  target_link_libraries(test_mhb_example PRIVATE shb_response PkgConfig::CMOCKA m)
  add_test(NAME mhb.example COMMAND test_mhb_example ${SHROUDHB_PYTHON}
    ${PROJECT_SOURCE_DIR}/cases/bring_your_own $<TARGET_FILE:shroudhb-mhb>)
  set_tests_properties(mhb.example PROPERTIES LABELS fast TIMEOUT 120 SKIP_RETURN_CODE 77)
endif()
