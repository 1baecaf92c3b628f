shb_test(cases units fast shb_case)
shb_test(cases keys fast shb_case)
foreach(noun case faults settings motion)
  shb_test(cases ${noun} fast shb_case)
  target_sources(test_cases_${noun} PRIVATE cases/scratch.c)
endforeach()

add_test(NAME cases.commands
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cases/test_commands.sh $<TARGET_FILE:shroudhb>)
set_tests_properties(cases.commands PROPERTIES LABELS fast TIMEOUT 120)
