# The pages: links, widths, the case reference, and what they state.
if(SHROUDHB_PYTHON)
  add_test(NAME docs.links
    COMMAND ${SHROUDHB_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/docs/test_links.py ${PROJECT_SOURCE_DIR})
endif()

add_test(NAME docs.case_reference
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/docs/test_reference.sh $<TARGET_FILE:shroudhb>
          ${PROJECT_SOURCE_DIR}/docs/user/case_reference.md)

if(SHROUDHB_PYTHON AND TARGET shroudhb-mhb)
  add_test(NAME docs.sector
    COMMAND ${SHROUDHB_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/docs/test_sector.py
            $<TARGET_FILE:shroudhb> ${CMAKE_CURRENT_BINARY_DIR}/docs_sector)
  set_tests_properties(docs.sector PROPERTIES SKIP_RETURN_CODE 77)
endif()

if(SHROUDHB_PYTHON AND TARGET shroudhb-post)
  add_test(NAME docs.first_case
    COMMAND ${SHROUDHB_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/docs/test_first_case.py
            $<TARGET_FILE:shroudhb> ${PROJECT_SOURCE_DIR}
            ${CMAKE_CURRENT_BINARY_DIR}/docs_first_case)
  set_tests_properties(docs.first_case PROPERTIES ENVIRONMENT OPENBLAS_NUM_THREADS=1)
endif()
