# The pages: links, widths, the case reference, and what they state.
set(PAGES docs)
shb_python_test(docs.links UNIT ${PAGES}/test_links.py ${PROJECT_SOURCE_DIR})
shb_shell_test(docs.case_reference UNIT ${PAGES}/test_reference.sh $<TARGET_FILE:shroudhb>
  ${PROJECT_SOURCE_DIR}/docs/user/case_reference.md)
shb_python_test(docs.sector UNIT ${PAGES}/test_sector.py $<TARGET_FILE:shroudhb>
  ${CMAKE_CURRENT_BINARY_DIR}/docs_sector)
shb_python_test(docs.first_case INTEGRATION ${PAGES}/test_first_case.py $<TARGET_FILE:shroudhb>
  ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/docs_first_case 15 80)
shb_python_test(docs.first_case_all NIGHTLY ${PAGES}/test_first_case.py $<TARGET_FILE:shroudhb>
  ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/docs_first_case_all)
